"""Names that the writer and the reader of a classifier's file share."""

FORMAT = "shapewright-classifier"
FORMAT_VERSION = 3
"""Raise it when files written before are read no longer, or would answer otherwise."""
METADATA_KEY = "shapewright"
