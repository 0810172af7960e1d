"""Learning classes from rendered variations and classifying meshes (paper section 3.2)."""
