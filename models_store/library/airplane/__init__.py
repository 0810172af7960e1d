"""The procedural models of the class ``airplane``."""
