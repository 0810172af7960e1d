"""Broken variations: what scanners and careless exports do, so that a classifier learns shapes in spite of it (ours).

These are not the corruptions that evaluations measure with: they work differently, and at strengths drawn at random.
"""

from typing import Final

BREAK_NAMES: Final = ("noise", "holes", "one_sided", "rounded", "sparse", "blocks", "specks")
"""Ways to break a variation, see :data:`shapewright.training.broken.breaking.BREAKS`."""
MOST_BROKEN: Final = 0.7
"""The largest share of variations that can be broken; the whole ones are the exemplars."""

__all__ = ["BREAK_NAMES", "MOST_BROKEN"]
