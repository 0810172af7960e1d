"""Names that the writer and the reader of a classifier's file share."""

FORMAT = "shapewright-classifier"
FORMAT_VERSION = 2
METADATA_KEY = "shapewright"
IMAGES, FEATURES, PROBABILITIES, OPEN_PROBABILITIES = "images", "features", "probabilities", "open_probabilities"
