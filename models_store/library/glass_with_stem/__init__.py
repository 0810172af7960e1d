"""The procedural models of the class ``glass_with_stem``, and the modelling aids that only they use."""
