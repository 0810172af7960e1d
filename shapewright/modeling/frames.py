"""Local frames of elements, evaluated for a batch of positions.

PAPER-NOTES, section 3: the frame of a face has its normal as z, its first edge projected into the plane as u, and
v = z x u. A vertex or an edge takes the mean normal of the faces around it and u from its first edge.

Positions inside the kernel are ``(V, B, 3)``: one row a vertex, so that gathering vertices copies whole rows and a
subdivision step is one product with a sparse matrix.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element, Target, image_matrix

Positions = Float[np.ndarray, "V B 3"]
Points = Float[np.ndarray, "N B 3"]
Vectors = Float[np.ndarray, "B 3"]
Frames = Float[np.ndarray, "B 3 3"]

_TINY = 1e-12


@dataclass(frozen=True)
class FrameSource:
    """What an element's frame is made of, taken from the topology at the time of an operation."""

    loops: tuple[Loop, ...]
    first_edge: tuple[int, int]

    def evaluate(self, positions: Positions) -> Frames:
        """Return the frames, (B, 3, 3), with u, v and z as columns.

        Where an instance has no normal (a collapsed face) z falls back to the world's z, and u to any direction
        across it, so that frames are always orthonormal and finite.
        """
        normal = _unit(sum((_unit(newell_normal(positions[list(loop)]), 2) for loop in self.loops), np.zeros(3)), 2)
        along = positions[self.first_edge[1]] - positions[self.first_edge[0]]
        u = along - _dot(along, normal) * normal
        flat = _dot(u, u) <= _TINY * np.maximum(_dot(along, along), _TINY)
        u = _unit(np.where(flat, _across(normal), u), 0)
        return np.stack([u, np.cross(normal, u), normal], axis=-1)


@dataclass(frozen=True)
class WorldFrame:
    """The axes of the model."""

    def evaluate(self, positions: Positions) -> Frames:
        """Return one identity for each instance of the batch."""
        return np.broadcast_to(np.eye(3), (positions.shape[1], 3, 3))


@dataclass(frozen=True)
class ImageFrame:
    """The image of another frame under a mirror or a turn (left-handed for a mirror)."""

    source: FrameSource | WorldFrame
    matrix: Float[np.ndarray, "3 3"]

    def evaluate(self, positions: Positions) -> Frames:
        """Return the images of the source's frames."""
        return np.matmul(self.matrix, self.source.evaluate(positions))


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
    mesh.vertices_of([element])
    return WorldFrame()


def frames_of_targets(mesh: ControlMesh, targets: tuple[Target, ...]) -> list[FrameSource | WorldFrame | ImageFrame]:
    """Return the frame of each target; images are images of the first target's frame.

    Raises:
        ModelError: an element does not exist.
    """
    sources = [_plain_frame(mesh, target) for target in targets]
    return [
        ImageFrame(sources[0], image_matrix(target.image)) if target.image else source
        for source, target in zip(sources, targets, strict=True)
    ]


def _plain_frame(mesh: ControlMesh, target: Target) -> FrameSource | WorldFrame:
    if target.frame == "world" or (target.frame == "own" and not target.elements):
        return WorldFrame()
    return frame_of_element(mesh, target.elements[0] if target.frame == "own" else target.frame)


def newell_normal(points: Points) -> Vectors:
    """Return twice the area vector of a polygon that need not be flat (M. Newell's method)."""
    following = np.concatenate([points[1:], points[:1]])
    centre = points[0]
    return np.cross(points - centre, following - centre).sum(axis=0)


def _dot(first: Vectors, second: Vectors) -> Float[np.ndarray, "B 1"]:
    return np.einsum("bi,bi->b", first, second)[:, None]


def _unit(vectors: Vectors, fallback_axis: int) -> Vectors:
    length = np.sqrt(_dot(vectors, vectors))
    fallback = np.eye(3)[fallback_axis]
    return np.where(length > _TINY, vectors / np.maximum(length, _TINY), fallback)


def _across(normal: Vectors) -> Vectors:
    """Return a direction that is surely not along the normal, made perpendicular to it."""
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    return axis - _dot(axis, normal) * normal
