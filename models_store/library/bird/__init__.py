"""The procedural models of the class ``bird``, and the modelling aids that only they use."""
