"""Names that the writer and the reader of a classifier's file share."""

FORMAT = "shapewright-classifier"
FORMAT_VERSION = 1
METADATA_KEY = "shapewright"
IMAGES, FEATURES, PROBABILITIES = "images", "features", "probabilities"
