"""The procedural models of the class ``table``."""
