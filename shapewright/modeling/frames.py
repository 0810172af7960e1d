"""Local frames of elements: right-handed axes (u, v, z) at a centre.

z is the normal: of a face, or the mean of the normals of the faces at an edge or vertex. u runs along the first edge of
a face, along an edge, or along the first edge of a vertex, made perpendicular to z; v = z x u. The paper leaves this
open.

Where an instance has no normal (a collapsed face) z falls back to the world's z, and u to any direction across it, so
that frames are always orthonormal and finite. :mod:`shapewright.modeling.program_kernels` does the arithmetic.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.modeling import opcodes
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element, Target, image_matrix
from shapewright.modeling.program import Program

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


@dataclass(frozen=True, eq=False)
class TargetFrames:
    """The frames of the T targets of one operation.

    Targets with an image take the image of the first target's frame (left-handed for a mirror).

    Attributes:
        sources: of each target.
        images: of each target; ``None`` for one that has its own frame.
    """

    sources: tuple[FrameSource | WorldFrame, ...]
    images: tuple[Float[np.ndarray, "3 3"] | None, ...]

    @property
    def along_axes(self) -> bool:
        """Whether all of them are axes of the model, or mirrored ones."""
        own = (source for source, image in zip(self.sources, self.images, strict=True) if image is None)
        if isinstance(self.sources[0], FrameSource) or any(isinstance(source, FrameSource) for source in own):
            return False
        return all(image is None or bool((np.abs(image) == np.eye(3)).all()) for image in self.images)

    def write(self, program: Program) -> list[range]:
        """Write instructions that evaluate the frames; return the rows of u, v and z of each target."""
        known: dict[FrameSource | WorldFrame, range] = {}
        rows = []
        first = WorldFrame() if self.images[0] is not None else self.sources[0]
        for source, image in zip(self.sources, self.images, strict=True):
            one = source if image is None else first
            if one not in known:
                known[one] = write_frame(program, one)
            rows.append(known[one] if image is None else _write_image(program, known[one], image))
        return rows


def write_frame(program: Program, source: FrameSource | WorldFrame) -> range:
    """Write the instruction that evaluates a frame; return the rows of u, v and z."""
    if isinstance(source, WorldFrame):
        return program.constant_rows(np.eye(3))
    rows = program.scratch(3)
    corners = [vertex for loop in source.loops for vertex in loop]
    lengths = [len(loop) for loop in source.loops]
    program.add(opcodes.FRAME, (*source.first_edge, *corners), rows, (len(lengths), *lengths), fresh=True)
    return rows


def _write_image(program: Program, frame: range, matrix: Float[np.ndarray, "3 3"]) -> range:
    rows = program.scratch(3)
    program.add(opcodes.IMAGE, frame, rows, (program.keep(matrix.ravel().tolist()),), fresh=True)
    return rows


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
    images = tuple(image_matrix(target.image) if target.image else None for target in targets)
    return TargetFrames(tuple(sources), images)


def _plain_frame(mesh: ControlMesh, target: Target) -> FrameSource | WorldFrame:
    if target.frame == "world" or (target.frame == "own" and not target.elements):
        return WorldFrame()
    return frame_of_element(mesh, target.elements[0] if target.frame == "own" else target.frame)


def write_means(program: Program, lists: Sequence[Sequence[int]]) -> list[range]:
    """Write instructions that evaluate the means of lists of vertices; return the row of each."""
    known: dict[tuple[int, ...], range] = {}
    for vertices in lists:
        if tuple(vertices) not in known:
            known[tuple(vertices)] = program.mean(vertices)
    return [known[tuple(vertices)] for vertices in lists]
