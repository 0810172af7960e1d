"""The procedural models of the class ``gun``, and the modelling aids that only they use."""
