"""The procedural models of the class ``bicycle``, and the modelling aids that only they use."""
