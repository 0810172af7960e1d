"""The surface distance (section 3.3, layer 2) and the Poisson-disk points that it measures on the query.

It is the mean, over the points of both sets together, of the distance to the nearest point of the *other set*:
2000 Poisson-disk points of the query and all vertices of the generated mesh. The paper's threshold 0.04 belongs
to this, in coordinates normalised to [-1, 1].
"""

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from shapewright.distances.elimination_kernel import eliminate
from shapewright.errors import MeshError
from shapewright.mesh import TriangleMesh

QUERY_POINTS = 2000
"""Poisson-disk points on the query."""
CANDIDATES_PER_POINT = 5
"""Random points on the surface for each one that is kept; more give little and cost in proportion."""
_MOST_PAIRS = 2_000_000


def poisson_disk_points(
    mesh: TriangleMesh, count: int = QUERY_POINTS, *, rng: np.random.Generator
) -> Float[np.ndarray, "N 3"]:
    """Spread points evenly over a surface: exactly ``count`` of them, no two very near to each other.

    The paper takes Corsini et al. 2012; this is the later weighted sample elimination (Yuksel 2015), which keeps
    the same property, hits the count exactly and needs no topology: area-weighted candidates, of which the most
    crowded goes until ``count`` are left. Distances are straight through space, so sheets that coincide share
    their points, and soup, holes or winding do not matter.

    Raises:
        MeshError: ``count`` is not positive, or the surface has no area.
    """
    if count < 1:
        raise MeshError(f"expected a positive number of points, got {count}", where="count")
    candidates = uniform_points(mesh, CANDIDATES_PER_POINT * count, rng=rng)
    # the largest radius with which `count` disks could fill the area (hexagonal packing)
    radius = float(np.sqrt(mesh.area / (2.0 * np.sqrt(3.0) * count)))
    return candidates[_eliminate(candidates, count, radius)]


def uniform_points(mesh: TriangleMesh, count: int, *, rng: np.random.Generator) -> Float[np.ndarray, "N 3"]:
    """Independent random points on a surface, every piece of area alike.

    Raises:
        MeshError: the surface has no area.
    """
    sums = np.cumsum(mesh.face_areas)
    if not sums[-1] > 0:
        raise MeshError("the surface has no area", where="faces")
    chosen = np.searchsorted(sums, rng.random(count) * sums[-1], side="right")
    corners = mesh.vertices[mesh.faces[np.minimum(chosen, len(sums) - 1)]]
    root, part = np.sqrt(rng.random(count)), rng.random(count)
    weights = np.stack([1.0 - root, root * (1.0 - part), root * part], axis=1)
    return np.asarray(np.einsum("nk,nkd->nd", weights, corners))


def _eliminate(points: Float[np.ndarray, "M 3"], count: int, radius: float) -> Int[np.ndarray, " N"]:
    """Indices of the ``count`` points that are left when the most crowded one is taken away again and again."""
    tree = cKDTree(points)
    reach = 2.0 * radius
    # about 20 neighbours each; where many sheets coincide the area promises more room than there is
    while tree.count_neighbors(tree, reach) > _MOST_PAIRS:
        reach *= 0.7
    pairs = tree.query_pairs(reach, output_type="ndarray")
    nearest_counted = 0.65 * (0.5 * reach) * (1.0 - (count / len(points)) ** 1.5)
    distances = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    crowding = (1.0 - np.maximum(distances, nearest_counted) / reach) ** 8
    first, second = np.concatenate([pairs, pairs[:, ::-1]]).T
    order = np.argsort(first, kind="stable")
    neighbours, shares = second[order], np.tile(crowding, 2)[order]
    starts = np.searchsorted(first[order], np.arange(len(points) + 1))
    weights = np.bincount(first, weights=np.tile(crowding, 2), minlength=len(points))
    return np.flatnonzero(eliminate(weights, starts, neighbours, shares, count))


class SurfaceDistance:
    """The surface distance to one query, whose search tree is built once; call it with a generated mesh's vertices.

    Args:
        query_points: points on the query, as from :func:`poisson_disk_points`.
        workers: threads of a search; one is best while several estimations share a machine.

    Raises:
        MeshError: no points, or NaN.
    """

    def __init__(self, query_points: Float[np.ndarray, "N 3"], *, workers: int = 1) -> None:
        self.query_points = _checked(query_points, "query_points")
        self.workers = workers
        self._tree = cKDTree(self.query_points)

    def __call__(self, model_vertices: Float[np.ndarray, "V 3"]) -> float:
        """Mean distance to the nearest point of the other set, over the points of both sets.

        Raises:
            MeshError: no vertices, or NaN.
        """
        vertices = _checked(model_vertices, "model_vertices")
        to_query = np.asarray(self._tree.query(vertices, workers=self.workers)[0])
        # built for a single round of searches, so a tree that is cheap to build wins
        tree = cKDTree(vertices, balanced_tree=False, compact_nodes=False)
        to_model = np.asarray(tree.query(self.query_points, workers=self.workers)[0])
        return float((to_query.sum() + to_model.sum()) / (len(to_query) + len(to_model)))


def surface_distance(points_a: Float[np.ndarray, "N 3"], points_b: Float[np.ndarray, "V 3"]) -> float:
    """Surface distance of two sets of points; symmetric. For many sets against one see :class:`SurfaceDistance`."""
    return SurfaceDistance(points_a)(points_b)


def _checked(points: Float[np.ndarray, "N 3"], where: str) -> Float[np.ndarray, "N 3"]:
    points = np.ascontiguousarray(points, dtype=np.float64)
    if len(points) == 0:
        raise MeshError("there are no points", where=where)
    if not np.isfinite(points).all():
        raise MeshError("a coordinate is NaN or infinite", where=where)
    return points
