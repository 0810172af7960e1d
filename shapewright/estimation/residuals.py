"""Where a fit and its query part: what the model cannot follow, and what it invents."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Float, Int

from shapewright.distances.even_places import even_places
from shapewright.errors import EstimationError
from shapewright.estimation.dust import without_dust
from shapewright.mesh import TriangleMesh

TOLERANCE = 0.04
"""Distance up to which one surface follows the other, in units in which the query reaches from -1 to 1; the paper's
threshold of the surface distance."""
SAMPLES = 6000
"""Points on each surface that shares of area, means and percentiles are taken from."""
_PIECE: Final = 10_000
_LEAST_PIECE: Final = 100
"""Points whose distances are searched for at once; few where a mesh is large, as some search much of it."""
_PIECE_WORK: Final = 200_000_000
"""Points times triangles of a piece, between those limits."""


@dataclass(frozen=True)
class PartResidual:
    """How far a part of the fitted model is from the query, in normalized units.

    Attributes:
        name: of the region of the model, see :class:`shapewright.modeling.regions.Regions`.
        share_of_area: share of the fit's area.
        mean: mean distance to the query.
        p95: distance that 95 % of the part's area stays below.
        invented_share: share of the part's area that is farther from the query than the tolerance.
    """

    name: str
    share_of_area: float
    mean: float
    p95: float
    invented_share: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {
            "name": self.name,
            "share_of_area": self.share_of_area,
            "mean": self.mean,
            "p95": self.p95,
            "invented_share": self.invented_share,
        }


@dataclass(frozen=True, eq=False)
class Residuals:
    """Exact distances between the surfaces of query and fit, in units in which the query reaches from -1 to 1.

    Surfaces inside the fit (where its components overlap) count like any other.

    Attributes:
        query_to_fit: of each vertex of the query.
        fit_to_query: of each vertex of the fit.
        mean: mean over both surfaces, by area, of the distance to the other.
        followed_share: share of the query's area that is within the tolerance of the fit.
        invented_share: share of the fit's area that is farther than the tolerance from the query.
        by_part: numbers of the fit by part of the model, in the model's order; parts that are not there are left out.
        tolerance: in the same units.
    """

    query_to_fit: Float[np.ndarray, " Vq"]
    fit_to_query: Float[np.ndarray, " Vm"]
    mean: float
    followed_share: float
    invented_share: float
    by_part: tuple[PartResidual, ...] = ()
    tolerance: float = TOLERANCE

    def to_dict(self) -> dict[str, Any]:
        """Numbers without the arrays, ready for JSON."""
        return {
            "tolerance": self.tolerance,
            "mean": self.mean,
            "followed_share": self.followed_share,
            "invented_share": self.invented_share,
            "by_part": [part.to_dict() for part in self.by_part],
        }


def measure_residuals(
    query: TriangleMesh,
    fit: TriangleMesh,
    *,
    region_names: Sequence[str] = (),
    regions: Int[np.ndarray, " Vm"] | None = None,
    tolerance: float = TOLERANCE,
    checkpoint: Callable[[], None] | None = None,
) -> Residuals:
    """Measure how far the surfaces of a query and its fit are from each other.

    Args:
        query: in any coordinates.
        fit: the fitted instance in the coordinates of the query.
        region_names: names of the parts of the model.
        regions: the part of each vertex of the fit, as an index into the names.
        tolerance: in normalized units.
        checkpoint: called between steps, of which the longest takes about a second for two million triangles; may
            raise to stop.

    Raises:
        EstimationError: the tolerance is not positive, or the regions do not fit the vertices or names.
        MeshError: one of the surfaces has no area, or the query no extent.
    """
    from shapewright.distances.triangles import TriangleDistance  # compiled kernels: only when needed

    if not tolerance > 0:
        raise EstimationError(f"expected a positive tolerance, got {tolerance}", where="tolerance")
    if regions is not None and len(regions) != len(fit.vertices):
        raise EstimationError(f"expected {len(fit.vertices)} regions, got {len(regions)}", where="regions")
    if regions is not None and (regions.min() < 0 or regions.max() >= len(region_names)):
        raise EstimationError(f"expected regions from 0 to {len(region_names) - 1}", where="regions")

    def go_on() -> None:
        if checkpoint is not None:
            checkpoint()

    def distances(mesh: TriangleMesh, *several: Float[np.ndarray, "_ 3"]) -> list[Float[np.ndarray, " _"]]:
        go_on()
        to = TriangleDistance(mesh)
        piece = max(_LEAST_PIECE, min(_PIECE, _PIECE_WORK // len(mesh.faces)))
        found = [np.empty(len(points)) for points in several]
        for points, out in zip(several, found, strict=True):
            for first in range(0, len(points), piece):
                go_on()
                out[first : first + piece] = to(points[first : first + piece])
        return found

    normal = without_dust(query).normalized()
    asked, posed = (mesh.transformed(np.eye(3), normal.translation, normal.scale) for mesh in (query, fit))
    go_on()
    query_points, _ = even_points(asked, SAMPLES)
    fit_points, faces = even_points(posed, SAMPLES)
    of_query, query_to_fit = distances(posed, query_points, asked.vertices)
    of_fit, at_fit = distances(asked, fit_points, posed.vertices)
    by_part: tuple[PartResidual, ...] = ()
    if regions is not None:
        of_face = regions[posed.faces[:, 0]]
        areas = np.bincount(of_face, posed.face_areas, len(region_names))
        by_part = tuple(
            _part(region_names[number], areas[number] / posed.area, own, tolerance)
            for number in np.flatnonzero(areas).tolist()
            if len(own := of_fit[of_face[faces] == number]) or len(own := at_fit[regions == number])
        )
    return Residuals(
        query_to_fit=query_to_fit,
        fit_to_query=at_fit,
        mean=float((of_query.mean() + of_fit.mean()) / 2),
        followed_share=float((of_query <= tolerance).mean()),
        invented_share=float((of_fit > tolerance).mean()),
        by_part=by_part,
        tolerance=float(tolerance),
    )


def even_points(mesh: TriangleMesh, count: int) -> tuple[Float[np.ndarray, "N 3"], Int[np.ndarray, " N"]]:
    """Return ``count`` points that stand for equal areas of a surface, and their faces; the same ones each time.

    Raises:
        MeshError: the surface has no area.
    """
    mesh.centroid  # noqa: B018 - refuses a surface without area
    faces, weights = even_places(mesh.face_areas, count)
    return np.asarray(np.einsum("nk,nkd->nd", weights, mesh.vertices[mesh.faces[faces]])), faces


def _part(name: str, share_of_area: float, distances: Float[np.ndarray, " N"], tolerance: float) -> PartResidual:
    return PartResidual(
        name=name,
        share_of_area=float(share_of_area),
        mean=float(distances.mean()),
        p95=float(np.quantile(distances, 0.95)),
        invented_share=float((distances > tolerance).mean()),
    )
