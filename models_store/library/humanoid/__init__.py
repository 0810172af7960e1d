"""The procedural models of the class ``humanoid``."""
