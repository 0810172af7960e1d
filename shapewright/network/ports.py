"""Names of what goes into a graph and of what comes out."""

IMAGES, FEATURES, PROBABILITIES, OPEN_PROBABILITIES = "images", "features", "probabilities", "open_probabilities"
