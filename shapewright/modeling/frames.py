"""Local frames of elements, evaluated for a batch of positions.

PAPER-NOTES, section 3: the frame of a face has its normal as z, its first edge projected into the plane as u, and
v = z x u. A vertex or an edge takes the mean normal of the faces around it and u from its first edge.

Positions inside the kernel are ``(V, 3, B)``: the batch lies innermost, so that every sum runs over contiguous
numbers, gathering vertices copies whole rows, and a subdivision step is one product with a sparse matrix. Rows are
gathered with ``take``, which begins sooner than indexing does: a single instance is mostly many small steps.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element, Target, image_matrix

Positions = Float[np.ndarray, "V 3 B"]
Vectors = Float[np.ndarray, "T 3 B"]
Frames = Float[np.ndarray, "T 3 3 B"]

_NOTHING, _UP = np.zeros(3), np.array([0.0, 0.0, 1.0])
_TINY = 1e-12
_FLAT = 1e-9

TARGET_WORK = 500
CORNER_WORK = 5
"""What a frame and each corner that it looks at cost, in units of :meth:`ControlMesh.spend` (measured)."""


@dataclass(frozen=True)
class FrameSource:
    """What an element's frame is made of, taken from the topology at the time of an operation."""

    loops: tuple[Loop, ...]
    first_edge: tuple[int, int]


@dataclass(frozen=True)
class WorldFrame:
    """The axes of the model."""


class TargetFrames:
    """The frames of the T targets of one operation, evaluated together.

    Targets with an image take the image of the first target's frame (left-handed for a mirror).

    Attributes:
        count: T.
        along_axes: whether all of them are axes of the model, or mirrored ones.
    """

    def __init__(
        self, sources: list[FrameSource | WorldFrame], images: list[Float[np.ndarray, "3 3"] | None] | None = None
    ) -> None:
        images = images or [None] * len(sources)
        self.count = len(sources)
        self._imaged = [i for i, image in enumerate(images) if image is not None]
        self._matrices = np.array([image for image in images if image is not None]).reshape(-1, 3, 3)
        self._fixed: Float[np.ndarray, "T 3 3"] | None = None
        if all(isinstance(s, WorldFrame) or (i > 0 and images[i] is not None) for i, s in enumerate(sources)):
            self._fixed = np.array([np.eye(3) if image is None else image for image in images])
        self.along_axes = self._fixed is not None and bool((np.abs(self._fixed) == np.eye(3)).all())
        own = [(i, s) for i, s in enumerate(sources) if isinstance(s, FrameSource) and images[i] is None]
        self._own = [i for i, _ in own]
        loops = [loop for _, source in own for loop in source.loops]
        self._corners = np.array([v for loop in loops for v in loop], dtype=np.int64)
        self._following = np.array([v for loop in loops for v in (*loop[1:], loop[0])], dtype=np.int64)
        self._centres = np.array([loop[0] for loop in loops for _ in loop], dtype=np.int64)
        self._loop_starts = _starts([len(loop) for loop in loops])
        self._source_starts = _starts([len(source.loops) for _, source in own])
        self._first_edges = np.array([source.first_edge for _, source in own], dtype=np.int64).reshape(-1, 2)

    def evaluate(self, positions: Positions) -> Frames:
        """Return the frames, (T, 3, 3, B), with u, v and z as columns.

        Where an instance has no normal (a collapsed face) z falls back to the world's z, and u to any direction
        across it, so that frames are always orthonormal and finite.
        """
        if self._fixed is not None:
            return np.broadcast_to(self._fixed[..., None], (*self._fixed.shape, positions.shape[2]))
        frames = np.zeros((self.count, 3, 3, positions.shape[2]))
        frames[:, (0, 1, 2), (0, 1, 2)] = 1.0
        if self._own:
            frames[self._own] = self._own_frames(positions)
        if self._imaged:
            frames[self._imaged] = np.einsum("tij,jkb->tikb", self._matrices, frames[0])
        return frames

    def vertices(self) -> set[int]:
        """Return the vertices that the frames are taken from."""
        looked_at = (self._corners, self._following, self._centres, self._first_edges)
        return {int(v) for vertices in looked_at for v in vertices.flat}

    def _own_frames(self, positions: Positions) -> Frames:
        centres = positions.take(self._centres, axis=0)
        spokes = positions.take(self._corners, axis=0) - centres
        following = positions.take(self._following, axis=0) - centres
        normals = np.add.reduceat(cross(spokes, following), self._loop_starts, axis=0)
        extents = np.maximum.reduceat(_dot(spokes, spokes), self._loop_starts, axis=0)
        # Relative to the face's size, so that a model may be as small as it likes; a collapsed face has no say.
        smallest: Float[np.ndarray, "T 1 B"] | float = np.maximum(_FLAT * extents, _TINY * _TINY)
        if len(self._source_starts) < len(self._loop_starts):
            normals = np.add.reduceat(_unit(normals, _NOTHING, smallest), self._source_starts, axis=0)
            smallest = _TINY
        normal = _unit(normals, _UP, smallest)
        along = positions.take(self._first_edges[:, 1], axis=0) - positions.take(self._first_edges[:, 0], axis=0)
        u = along - _dot(along, normal) * normal
        square, floor = _dot(u, u), _TINY * np.maximum(_dot(along, along), _TINY * _TINY)
        if (square <= floor).any():
            u = np.where(square <= floor, _across(normal), u)
        u = u / np.sqrt(_dot(u, u))
        frames = np.empty((*u.shape[:2], 3, u.shape[2]))
        frames[:, :, 0], frames[:, :, 1], frames[:, :, 2] = u, cross(normal, u), normal
        return frames


def frame_of_element(mesh: ControlMesh, element: Element) -> FrameSource | WorldFrame:
    """Return where the frame of an element comes from; a component has the world's axes.

    Raises:
        ModelError: the element does not exist.
    """
    if element.kind == "face":
        loop = mesh.face(element.id)
        return FrameSource((loop,), (loop[0], loop[1]))
    if element.kind == "edge":
        faces = mesh.faces_of_edge(element.id)
        return FrameSource(tuple(mesh.face(f) for f in faces), mesh.edge(element.id))
    if element.kind == "vertex":
        first, second = mesh.edge(mesh.edges_of_vertex(element.id)[0])
        other = second if first == element.id else first
        faces = mesh.faces_of_vertex(element.id)
        return FrameSource(tuple(mesh.face(f) for f in faces), (element.id, other))
    mesh.check_component(element.id)
    return WorldFrame()


def frames_of_targets(mesh: ControlMesh, targets: tuple[Target, ...]) -> TargetFrames:
    """Return the frames of the targets; images are images of the first target's frame.

    Raises:
        ModelError: an element does not exist, or the frames are too much work.
    """
    sources = []
    for target in targets:
        source = _plain_frame(mesh, target)
        corners = sum(map(len, source.loops)) if isinstance(source, FrameSource) else 0
        mesh.spend(TARGET_WORK + CORNER_WORK * corners)
        sources.append(source)
    return TargetFrames(sources, [image_matrix(target.image) if target.image else None for target in targets])


def _plain_frame(mesh: ControlMesh, target: Target) -> FrameSource | WorldFrame:
    if target.frame == "world" or (target.frame == "own" and not target.elements):
        return WorldFrame()
    return frame_of_element(mesh, target.elements[0] if target.frame == "own" else target.frame)


class Centres:
    """The means of T lists of vertices, evaluated together."""

    def __init__(self, lists: list[list[int]]) -> None:
        self._vertices = np.array([v for vertices in lists for v in vertices], dtype=np.int64)
        self._starts = _starts([len(vertices) for vertices in lists])
        self._counts = np.array([len(vertices) for vertices in lists], dtype=np.float64)[:, None, None]

    def vertices(self) -> set[int]:
        """Return the vertices of all lists."""
        return set(self._vertices.tolist())

    def evaluate(self, positions: Positions) -> Vectors:
        """Return the means, (T, 3, B)."""
        return np.add.reduceat(positions.take(self._vertices, axis=0), self._starts, axis=0) / self._counts


def cross(first: Vectors, second: Vectors) -> Vectors:
    """Return the cross products of rows of vectors."""
    ax, ay, az = first[:, 0], first[:, 1], first[:, 2]
    bx, by, bz = second[:, 0], second[:, 1], second[:, 2]
    product = np.empty_like(first)
    product[:, 0], product[:, 1], product[:, 2] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    return product


def _starts(lengths: list[int]) -> Int[np.ndarray, " N"]:
    return np.cumsum([0, *lengths[:-1]]) if lengths else np.zeros(0, dtype=np.int64)


def _dot(first: Vectors, second: Vectors) -> Float[np.ndarray, "T 1 B"]:
    return np.einsum("tib,tib->tb", first, second)[:, None]


def _unit(vectors: Vectors, fallback: Float[np.ndarray, "3"], smallest: Float[np.ndarray, "T 1 B"] | float) -> Vectors:
    length = np.sqrt(_dot(vectors, vectors))
    short = length <= smallest
    if not short.any():
        return vectors / length
    return np.where(short, fallback[:, None], vectors / np.where(short, 1.0, length))


def _across(normal: Vectors) -> Vectors:
    """Return a direction that is surely not along the normal, made perpendicular to it."""
    axis = np.moveaxis(np.eye(3)[np.argmin(np.abs(normal), axis=1)], -1, 1)
    return axis - _dot(axis, normal) * normal
