"""The procedural models of the class ``sword``, and the modelling aids that only they use."""
