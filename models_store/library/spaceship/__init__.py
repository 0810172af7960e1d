"""The procedural models of the class ``spaceship``."""
