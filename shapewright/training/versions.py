"""Versions of everything that a trained classifier depends on beside models, settings and backbone."""

from typing import Final

LEARNING_VERSION: Final = 3
"""Raise it when the same features and descriptors give another classifier."""


def learning_versions() -> list[int]:
    """What a classifier that is kept has to have been made by, to be worth keeping."""
    from shapewright.classification.file_format import FORMAT_VERSION
    from shapewright.classification.readings import VERSION as READINGS_VERSION
    from shapewright.distances.descriptor_files import descriptor_version
    from shapewright.training import negatives
    from shapewright.training.broken.breaking import VERSION as BREAKS_VERSION
    from shapewright.training.chunks import PICTURES_VERSION
    from shapewright.training.sources import MESHES_VERSION

    return [
        FORMAT_VERSION,
        LEARNING_VERSION,
        PICTURES_VERSION,
        MESHES_VERSION,
        READINGS_VERSION,
        BREAKS_VERSION,
        negatives.VERSION,
        negatives.MIXED_VERSION,
        descriptor_version(),
    ]
