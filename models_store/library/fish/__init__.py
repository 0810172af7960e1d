"""The procedural models of the class ``fish``, and the modelling aids that only they use."""
