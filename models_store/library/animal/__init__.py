"""The procedural models of the class ``animal``."""
