"""The procedural models of the class ``chair``."""
