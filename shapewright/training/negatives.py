"""Shapes of objects that are of no class: what ``unknown`` is learned and tried on (ours; the paper does not ask).

Three kinds: *assemblies* of random primitives, instances *distorted* beyond recognition, and halves of two instances
*mixed*. Nothing here depends on a real mesh.
"""

from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined

VERSION: Final = 1
"""Raise it with every change of the shapes: what was stored of the old ones is then left alone."""
MIXED_VERSION: Final = 3
"""Of the mixed objects alone."""

_MAX_PARTS: Final = 9
_SIDES: Final = 16


def random_assembly(rng: np.random.Generator) -> TriangleMesh:
    """One to nine stretched primitives that touch each other; a part may be mirrored or repeated in a circle."""
    parts = [_primitive(rng)]
    for _ in range(int(rng.integers(0, _MAX_PARTS))):
        host = parts[int(rng.integers(len(parts)))]
        part = _primitive(rng, scale=float(rng.uniform(0.2, 1.0)))
        at = host.vertices[int(rng.integers(len(host.vertices)))]
        placed = TriangleMesh(part.vertices + at, part.faces)
        parts += _copies(placed, rng)
    return joined(parts)


def distorted(mesh: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """Stretched along random axes, twisted, bent and tapered, each of them strongly."""
    points = _centred(mesh.vertices) @ Rotation.random(rng=rng).as_matrix().T
    points = points * np.exp(rng.uniform(-1.1, 1.1, 3))
    points = _centred(points)
    for _ in range(int(rng.integers(1, 4))):
        points = _centred(points @ Rotation.random(rng=rng).as_matrix().T)
        x, y, z = points.T
        angle = rng.uniform(-2.5, 2.5) * z
        twisted = np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y, z], axis=1)
        tapered = twisted * np.stack([np.ones_like(z), 1.0 + rng.uniform(-0.9, 0.9) * z, np.ones_like(z)], axis=1)
        tapered[:, 0] += rng.uniform(-0.9, 0.9) * z * z
        points = tapered
    return TriangleMesh(points, mesh.faces)


def mixed(first: TriangleMesh, second: TriangleMesh, rng: np.random.Generator) -> TriangleMesh:
    """A half of each of two objects, put together at the cut."""
    halves = []
    for mesh, keep_above in ((first, True), (second, False)):
        points = _centred(mesh.vertices) @ Rotation.random(rng=rng).as_matrix().T
        height = points[mesh.faces].mean(axis=1)[:, 2]
        faces = mesh.faces[(height > np.median(height)) == keep_above]
        used, renumbered = np.unique(faces, return_inverse=True)
        kept = points[used]
        cut = kept[:, 2].min() if keep_above else kept[:, 2].max()
        halves.append(TriangleMesh(kept - np.array([*kept[:, :2].mean(axis=0), cut]), renumbered.reshape(-1, 3)))
    return joined(halves)


def _centred(points: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "V 3"]:
    low, high = points.min(axis=0), points.max(axis=0)
    return (points - (low + high) / 2) / max(float((high - low).max()) / 2, 1e-12)


def _copies(part: TriangleMesh, rng: np.random.Generator) -> list[TriangleMesh]:
    kind = rng.random()
    if kind < 0.4:
        return [part]
    if kind < 0.7:
        flipped = part.vertices.copy()
        flipped[:, int(rng.integers(3))] *= -1.0
        return [part, TriangleMesh(flipped, part.faces)]
    count = int(rng.integers(2, 7))
    axis = np.eye(3)[int(rng.integers(3))]
    turns = Rotation.from_rotvec(axis * (2 * np.pi / count) * np.arange(count)[:, None]).as_matrix()
    return [TriangleMesh(part.vertices @ turn.T, part.faces) for turn in turns]


def _primitive(rng: np.random.Generator, scale: float = 1.0) -> TriangleMesh:
    """A surface of revolution, a box, a ring or a sheet, stretched and turned."""
    kind = int(rng.integers(6))
    if kind == 0:
        corners = np.stack(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0], indexing="ij"), -1).reshape(-1, 3)
        quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
        mesh = TriangleMesh(corners, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]))
    elif kind == 1:
        mesh = TriangleMesh(
            np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
        )
    elif kind == 2:
        width = rng.uniform(0.08, 0.5)
        t = np.linspace(0, 2 * np.pi, 9)
        mesh = _revolved(1.0 + width * np.cos(t), width * np.sin(t))
    elif kind == 3:
        t = np.linspace(0.0, np.pi, 9)
        mesh = _revolved(np.sin(t), -np.cos(t))
    elif kind == 4:
        top = rng.uniform(0.0, 1.0)
        mesh = _revolved(np.array([0.0, 1.0, top, 0.0]), np.array([-1.0, -1.0, 1.0, 1.0]))
    else:
        count = int(rng.integers(3, 9))
        mesh = _revolved(rng.uniform(0.05, 1.0, count), np.linspace(-1.0, 1.0, count))
    stretch = scale * np.exp(rng.uniform(-1.8, 0.2, 3))
    turn = Rotation.random(rng=rng).as_matrix() if rng.random() < 0.4 else np.eye(3)[rng.permutation(3)]
    return TriangleMesh((mesh.vertices * stretch) @ turn.T, mesh.faces)


def _revolved(radius: Float[np.ndarray, " R"], height: Float[np.ndarray, " R"]) -> TriangleMesh:
    angle = np.arange(_SIDES) * (2 * np.pi / _SIDES)
    rings = [np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)), np.outer(height, np.ones(_SIDES))]
    ring, side = np.meshgrid(np.arange(len(radius) - 1), np.arange(_SIDES), indexing="ij")
    a, b = ring * _SIDES + side, ring * _SIDES + (side + 1) % _SIDES
    quads = np.stack([a, b, b + _SIDES, a + _SIDES], axis=-1).reshape(-1, 4)
    return TriangleMesh(np.stack(rings, axis=-1).reshape(-1, 3), np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]))
