"""The procedural models of the class ``helicopter``, and the modelling aids that only they use."""
