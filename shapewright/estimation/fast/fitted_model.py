"""A model prepared for fitting: its surface as sparse matrices, its free parameters and its options."""

from functools import cached_property
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.estimation.fast.sparse_rows import SparseRows
from shapewright.estimation.sampling_kernels import sample_surface
from shapewright.modeling.compiled import CompiledModel

COARSE, FINE = 1, 2
"""Subdivision steps of the surface: while searching, and at the end."""
_FEW_TRIANGLES: Final = 2500


class FittedModel:
    """A compiled model as the search sees it.

    Attributes:
        compiled: the model.
        widths: (P,) width of each parameter's range, never zero.
        is_option: (P,) whether a parameter is a choice.
        options: the values of each choice, empty for a measure.
    """

    def __init__(self, compiled: CompiledModel) -> None:
        self.compiled = compiled
        self.widths: Float[np.ndarray, " P"] = np.maximum(compiled.maximum - compiled.minimum, 1e-9)
        self.options = tuple(tuple(x for x, _ in p.named_options()) for p in compiled.model.parameters)
        self.is_option: Bool[np.ndarray, " P"] = np.array([bool(options) for options in self.options], dtype=bool)

    @cached_property
    def surfaces(self) -> dict[int, SparseRows]:
        """What makes the surface's vertices of control points, by subdivision steps."""
        return {steps: SparseRows.of(self.compiled.surface_matrix(steps)) for steps in (COARSE, FINE)}

    @cached_property
    def triangles(self) -> dict[int, Int[np.ndarray, "F 3"]]:
        """Triangles of the surface, by subdivision steps."""
        return {steps: np.ascontiguousarray(self.compiled.surface_triangles(steps)) for steps in (COARSE, FINE)}

    @cached_property
    def outline(self) -> SparseRows:
        """What makes the vertices of the surface that is drawn while searching.

        They are those of the coarse surface, at the places that the fine one gives them. Where the fine surface has
        few triangles it is drawn itself: the chords of a coarse mesh stay far inside a round shape.
        """
        fine = self.surfaces[FINE]
        return fine if self._draws_fine else fine.first(len(self.surfaces[COARSE]))

    @property
    def outline_triangles(self) -> Int[np.ndarray, "F 3"]:
        """Triangles of that surface."""
        return self.triangles[FINE if self._draws_fine else COARSE]

    @property
    def _draws_fine(self) -> bool:
        return len(self.triangles[FINE]) <= _FEW_TRIANGLES

    def settle(self, values: Float[np.ndarray, " P"]) -> Float[np.ndarray, " P"]:
        """Return one row settled."""
        settled: Float[np.ndarray, " P"] = self.compiled.space.settle(values[None])[0]
        return settled

    def control_points(self, values: Float[np.ndarray, " P"]) -> Float[np.ndarray, "V 3"]:
        """Return the control mesh of one row."""
        points: Float[np.ndarray, "V 3"] = self.compiled.control_points(values[None])[0]
        return points

    def free_columns(
        self, values: Float[np.ndarray, " P"]
    ) -> tuple[Int[np.ndarray, " D"], Float[np.ndarray, " P"], Float[np.ndarray, " P"]]:
        """Return the active measures that have room, and the ends of all ranges, given the other values."""
        lowest, highest = (bounds[0] for bounds in self.compiled.space.ranges(values[None]))
        active = self.compiled.space.active(values[None])[0]
        free = active & ~self.is_option & (highest - lowest > 1e-9 * self.widths)
        return np.flatnonzero(free), lowest, highest

    def samples(
        self, control: Float[np.ndarray, "V 3"], count: int, steps: int, first_share: float
    ) -> tuple[SparseRows, Float[np.ndarray, "N 3"]] | None:
        """Spread samples evenly over an instance.

        Returns:
            What makes the N samples of control points, and the normals (N, 3) of this instance; ``None`` if the
            instance has no area.
        """
        surface, triangles = self.surfaces[steps], self.triangles[steps]
        chosen, weights, normals = sample_surface(surface.points(control), triangles, count, first_share)
        if len(chosen) == 0:
            return None
        return surface.combined(chosen, weights, triangles), normals
