"""The procedural models of the class ``stool``."""
