"""Colors of residuals: perceptually uniform, and told apart by people with any color vision."""

from typing import Final

import numpy as np
from jaxtyping import Float

TOLERANCES_SHOWN: Final = 4.0
"""The last color is reached at so many times the tolerance, and stands for everything beyond."""

_VIRIDIS: Final = np.array(
    [
        (68, 1, 84),
        (71, 45, 123),
        (59, 82, 139),
        (44, 114, 142),
        (33, 145, 140),
        (40, 174, 128),
        (94, 201, 98),
        (173, 220, 48),
        (253, 231, 37),
    ]
)


def residual_colors(distances: Float[np.ndarray, " N"], tolerance: float) -> Float[np.ndarray, "N 3"]:
    """Return red, green, blue in 0..1: viridis from yellow (no distance) to dark violet (four tolerances or more).

    A good fit is bright, so that its shading shows its shape.
    """
    shares = 1.0 - np.clip(distances / (TOLERANCES_SHOWN * tolerance), 0.0, 1.0)
    anchors = np.linspace(0.0, 1.0, len(_VIRIDIS))
    return np.stack([np.interp(shares, anchors, channel / 255.0) for channel in _VIRIDIS.T], axis=1)
