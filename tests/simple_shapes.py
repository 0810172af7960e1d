"""Plain shapes and stand-ins for compiled procedural models, for tests of rendering and classification."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.mesh import TriangleMesh

BOX_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
BOX_FACES = np.concatenate([_QUADS[:, [0, 1, 2]], _QUADS[:, [0, 2, 3]]])


def box(size=(1.0, 1.0, 1.0), center=(0.0, 0.0, 0.0)) -> TriangleMesh:
    return TriangleMesh(BOX_CORNERS * np.asarray(size) + np.asarray(center), BOX_FACES)


def lathe(profile, sides: int = 48) -> TriangleMesh:
    """Turn a profile of (radius, height) about the y axis: an open sheet without thickness."""
    profile = np.asarray(profile, dtype=np.float64)
    angles = np.arange(sides) * 2 * np.pi / sides
    vertices = np.stack(
        [
            profile[:, 0, None] * np.cos(angles),
            np.broadcast_to(profile[:, 1, None], (len(profile), sides)),
            profile[:, 0, None] * np.sin(angles),
        ],
        axis=2,
    ).reshape(-1, 3)
    ring, side = np.meshgrid(np.arange(len(profile) - 1), np.arange(sides), indexing="ij")
    a, b = ring * sides + side, ring * sides + (side + 1) % sides
    faces = np.concatenate([np.stack([a, a + sides, b], -1), np.stack([b, a + sides, b + sides], -1)])
    return TriangleMesh(vertices, faces.reshape(-1, 3))


def goblet() -> TriangleMesh:
    return lathe([(0.9, -1.4), (0.85, -1.33), (0.1, -1.2), (0.08, 0.0), (0.3, 0.15), (0.85, 0.8), (0.8, 1.4)])


def stool() -> TriangleMesh:
    parts = [box((1.2, 0.1, 1.2), (0, 0.5, 0))]
    parts += [box((0.12, 1.0, 0.12), (0.5 * x, 0, 0.5 * z)) for x in (-1, 1) for z in (-1, 1)]
    return joined(parts)


def crossing_sheets() -> TriangleMesh:
    """Two rectangles without thickness through each other."""
    vertices = np.array([[-1, -0.6, 0], [1, -0.6, 0], [1, 0.6, 0], [-1, 0.6, 0]], dtype=float)
    sheet = TriangleMesh(vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    other = TriangleMesh(vertices[:, [2, 1, 0]] * 0.8, sheet.faces)
    return joined([sheet, other])


def joined(parts) -> TriangleMesh:
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    return TriangleMesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + offset for part, offset in zip(parts, offsets, strict=True)]),
    )


def flipped(mesh: TriangleMesh, share: float = 1.0, seed: int = 0) -> TriangleMesh:
    """The same surface with the winding of a random share of its faces turned round."""
    chosen = np.random.default_rng(seed).random(len(mesh.faces)) < share
    return TriangleMesh(mesh.vertices, np.where(chosen[:, None], mesh.faces[:, ::-1], mesh.faces))


@dataclass(frozen=True)
class NamedModel:
    name: str
    class_name: str
    digest: str


class BoxModel:
    """A compiled model made of boxes: one parameter scales each box along each axis (0.6 to 1.6)."""

    def __init__(self, name: str, parts) -> None:
        self.model = NamedModel(name, name, hashlib.sha256(name.encode()).hexdigest())
        self.parts = np.array(parts, dtype=np.float64)

    @property
    def minimum(self) -> Float[np.ndarray, " P"]:
        return np.full(3 * len(self.parts), 0.6)

    @property
    def maximum(self) -> Float[np.ndarray, " P"]:
        return np.full(3 * len(self.parts), 1.6)

    @property
    def space(self) -> "BoxModel":
        return self

    def settle(self, values: Float[np.ndarray, "B P"]) -> Float[np.ndarray, "B P"]:
        return np.clip(values, self.minimum, self.maximum)

    def surface_parts(self, steps: int = 2) -> Int[np.ndarray, " V"]:
        return np.full(8 * len(self.parts), -1)

    def parts_present(self, values: Float[np.ndarray, "B P"]) -> Bool[np.ndarray, "B N"]:
        return np.ones((len(values), 0), dtype=bool)

    def random_values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        return rng.uniform(0.6, 1.6, (count, 3 * len(self.parts)))

    def instances(self, values: Float[np.ndarray, "B P"], steps: int = 2) -> Iterator[TriangleMesh]:
        for points in self.surface_points(values, steps):
            yield TriangleMesh(points, self.surface_triangles(steps))

    def surface_points(self, values: Float[np.ndarray, "B P"], steps: int = 2) -> Float[np.ndarray, "B V 3"]:
        sizes = values.reshape(len(values), -1, 1, 3) * self.parts[None, :, None, 1]
        return (self.parts[None, :, None, 0] + sizes * BOX_CORNERS).reshape(len(values), -1, 3)

    def surface_triangles(self, steps: int = 2) -> Int[np.ndarray, "F 3"]:
        return np.concatenate([BOX_FACES + 8 * part for part in range(len(self.parts))])

    def instance(self, values: Float[np.ndarray, " P"], steps: int = 2) -> TriangleMesh:
        return TriangleMesh(self.surface_points(values[None])[0], self.surface_triangles())


def toy_classes() -> dict[str, list[BoxModel]]:
    """Three classes of boxes that a person tells apart at once."""
    legs = [((x * 0.6, 0, z * 0.4), (0.1, 1, 0.1)) for x in (-1, 1) for z in (-1, 1)]
    return {
        "bench": [BoxModel("bench", [((0, 0.5, 0), (1.4, 0.08, 1)), *legs])],
        "cross": [BoxModel("cross", [((0, 0.6, 0), (0.15, 2, 0.15)), ((0, 0.8, 0), (1, 0.15, 0.15))])],
        "block": [BoxModel("block", [((0, 0, 0), (1, 1, 1))])],
    }
