"""The procedural models of the class ``office_chair``, and the modelling aids that only they use."""
