"""Base polyhedra: what a component starts from."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Target, image_matrix
from shapewright.modeling.fields import TARGETS, VECTOR, choice, field, integer
from shapewright.modeling.frames import TargetFrames, frames_of_targets
from shapewright.modeling.opcodes import PLACE
from shapewright.modeling.operations.operation import Operation, Step
from shapewright.modeling.operations.selection import refuse_pivots
from shapewright.modeling.program import Changes, Program

MAX_SIDES = 256


@dataclass(frozen=True)
class Base(Operation):
    """A new component: box, prism, ring or sheet, once for each anchor.

    The shape stands on the plane z = 0 of its frame, centred in x and y; a ring lies around the origin. ``size`` is
    its extent along x, y and z before subdivision (a ring: outer diameters, tube diameter; a sheet has no z).
    The order of ids is: bottom ring of vertices, top ring; bottom face, top face, sides.

    Attributes:
        shape: box (4 sides), prism (``sides``), ring (``sides`` x ``tube_sides``) or sheet (one open polygon of
            four corners).
        offset: where the shape is put in the frame of its anchor.
        anchors: no anchor means the origin of the model. An anchor's elements give the place (the mean of their
            vertices at this moment), its frame the orientation; an image makes a symmetric copy.
    """

    kind: ClassVar[str] = "base"

    shape: str = field(choice("box", "prism", "ring", "sheet"))
    size: tuple[float, float, float] = field(VECTOR)
    sides: int = field(integer(3, MAX_SIDES), 4)
    tube_sides: int = field(integer(3, MAX_SIDES), 4)
    offset: tuple[float, float, float] = field(VECTOR, (0.0, 0.0, 0.0))
    anchors: tuple[Target, ...] = field(TARGETS, ())

    def __post_init__(self) -> None:
        needed = 2 if self.shape == "sheet" else 3
        if min(self.size[:needed]) <= 0.0:
            raise ModelError("every extent of a base must be above 0")
        if self.shape == "ring" and self.size[2] * 2 >= min(self.size[:2]):
            raise ModelError("the tube of a ring must be thinner than half its diameter")
        refuse_pivots(self.kind, self.anchors)

    def apply(self, mesh: ControlMesh) -> Step:
        """Add one component for each anchor."""
        anchors = self.anchors or (Target((), "world"),)
        frames = frames_of_targets(mesh, anchors)
        origins = [mesh.vertices_of(anchor.elements) for anchor in anchors]
        mesh.spend(sum(map(len, origins)))
        points, loops = self._shape()
        first_vertex = mesh.n_vertices
        for anchor in anchors:
            component = mesh.add_component()
            ids = [mesh.add_vertex(component) for _ in points]
            mirrored = np.linalg.det(image_matrix(anchor.image)) < 0
            for loop in loops:
                corner_ids = [ids[corner] for corner in loop]
                mesh.add_face(corner_ids[:1] + corner_ids[:0:-1] if mirrored else corner_ids)
        return _Placed(points + np.array(self.offset), first_vertex, frames, tuple(origins))

    def _shape(self) -> tuple[Float[np.ndarray, "N 3"], list[Loop]]:
        x, y, z = self.size
        if self.shape == "box":
            corners = np.array([[-x, -y], [x, -y], [x, y], [-x, y]]) / 2
            return _prism(corners, z)
        if self.shape == "prism":
            angle = np.arange(self.sides) * (2 * np.pi / self.sides)
            return _prism(np.stack([x / 2 * np.cos(angle), y / 2 * np.sin(angle)], axis=1), z)
        if self.shape == "sheet":
            corners = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]]) / 2
            return corners, [(0, 1, 2, 3)]
        return _ring(self.size, self.sides, self.tube_sides)


@dataclass(frozen=True, eq=False)
class _Placed:
    """Copies of the points, one for each frame, around the mean of its origin's vertices, if it has any."""

    points: Float[np.ndarray, "N 3"]
    first_vertex: int
    frames: TargetFrames
    origins: tuple[list[int], ...]

    def write(self, program: Program, changes: Changes) -> None:
        n_points = len(self.points)
        numbers = (program.keep(self.points.ravel().tolist()),)
        centres = [program.mean(origin) if origin else () for origin in self.origins]
        for i, (frame, centre) in enumerate(zip(self.frames.write(program), centres, strict=True)):
            first = self.first_vertex + i * n_points
            program.add(PLACE, (*frame, *centre), range(first, first + n_points), numbers, fresh=True)


def _prism(corners: Float[np.ndarray, "N 2"], height: float) -> tuple[Float[np.ndarray, "M 3"], list[Loop]]:
    n = len(corners)
    bottom = np.column_stack([corners, np.zeros(n)])
    top = np.column_stack([corners, np.full(n, height)])
    sides: list[Loop] = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    bottom_loop: Loop = (0, *range(n - 1, 0, -1))
    return np.concatenate([bottom, top]), [bottom_loop, tuple(range(n, 2 * n)), *sides]


def _ring(size: tuple[float, float, float], sides: int, tube_sides: int) -> tuple[Float[np.ndarray, "M 3"], list[Loop]]:
    tube = size[2] / 2
    around = np.arange(sides) * (2 * np.pi / sides)
    across = (np.arange(tube_sides) + 0.5) * (2 * np.pi / tube_sides)
    radius = 1 / np.cos(np.pi / tube_sides) * tube if tube_sides == 4 else tube
    out, up = radius * np.cos(across), radius * np.sin(across)
    x = np.cos(around)[:, None] * (size[0] / 2 - tube + out)
    y = np.sin(around)[:, None] * (size[1] / 2 - tube + out)
    points = np.stack([x, y, np.broadcast_to(up, x.shape)], axis=-1).reshape(-1, 3)
    loops: list[Loop] = []
    for i in range(sides):
        here, there = i * tube_sides, (i + 1) % sides * tube_sides
        loops += [
            (here + j, there + j, there + (j + 1) % tube_sides, here + (j + 1) % tube_sides) for j in range(tube_sides)
        ]
    return points, loops
