"""The procedural models of the class ``ship``."""
