"""Breaking variations at random."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final

import numpy as np

from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training.broken.blocks import build_of_blocks
from shapewright.training.broken.holes import lose_patches
from shapewright.training.broken.noise import shake_surface
from shapewright.training.broken.one_sided import keep_visible
from shapewright.training.broken.rounded import round_vertices
from shapewright.training.broken.sparse import keep_few_points
from shapewright.training.broken.specks import add_specks

VERSION: Final = 4
"""Raise it when the same generator breaks a variation differently."""

OFTEN: Final[Mapping[str, int]] = MappingProxyType({"one_sided": 3, "rounded": 2})
"""Breaks that change an object most, and how many times as often as the others they are drawn."""
TWICE: Final = 1.0 / 3.0
"""Share of the broken variations that get a second break: a scan has more than one fault."""
_GOLDEN: Final = (5.0**0.5 - 1.0) / 2.0

Break = Callable[[TriangleMesh, np.random.Generator], TriangleMesh | PointCloud]
"""Takes a variation and the source of all choices, strength included; returns what is left of it."""
BreakMore = Callable[[TriangleMesh | PointCloud, np.random.Generator], PointCloud]
"""A break that can follow another one."""

BREAKS: Final[Mapping[str, Break]] = MappingProxyType(
    {
        "noise": shake_surface,
        "holes": lose_patches,
        "one_sided": keep_visible,
        "rounded": round_vertices,
        "sparse": keep_few_points,
        "blocks": build_of_blocks,
        "specks": add_specks,
    }
)
"""Every way to break a variation by its name."""
SECOND_BREAKS: Final[Mapping[str, BreakMore]] = MappingProxyType(
    {"noise": shake_surface, "holes": lose_patches, "specks": add_specks}
)
"""The breaks that can follow another one, by name."""


def is_broken(number: int, share: float) -> bool:
    """Tell whether the variation with this number of a series is broken.

    The broken ones are spread evenly, so that a short beginning of a series has its share of them. The first variation
    is whole.
    """
    return (number * _GOLDEN) % 1.0 >= 1.0 - share


def broken(mesh: TriangleMesh, breaks: Sequence[str], rng: np.random.Generator) -> TriangleMesh | PointCloud:
    """Break a variation in one random way, or in two.

    Args:
        mesh: the variation.
        breaks: names among :data:`BREAKS`; without any, the variation stays whole.
        rng: source of all choices.

    Raises:
        MeshError: the variation has no area.
    """
    if not breaks:
        return mesh
    choices = [name for name in breaks for _ in range(OFTEN.get(name, 1))]
    first = choices[int(rng.integers(len(choices)))]
    once = BREAKS[first](mesh, rng)
    second = [name for name in SECOND_BREAKS if name in breaks and name != first]
    if not second or rng.random() >= TWICE:
        return once
    return SECOND_BREAKS[second[int(rng.integers(len(second)))]](once, rng)
