"""The procedural models of the class ``tower``."""
