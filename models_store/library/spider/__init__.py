"""The procedural models of the class ``spider``, and the modelling aids that only they use."""
