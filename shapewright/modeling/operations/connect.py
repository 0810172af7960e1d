"""Connect two vertices, two border edges or two faces."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import ELEMENT, MAX_ELEMENTS, field, integer
from shapewright.modeling.operations.operation import NO_MOVE, Operation, Step


@dataclass(frozen=True)
class Connect(Operation):
    """Two elements of one kind are joined.

    Two vertices of a face: a new edge cuts the face in two; the part that holds the first vertex's successor keeps
    the id. Two border edges: a quad closes the gap. Two faces of the same valence: both go and a tube of quads joins
    their outlines (a handle, a ring).

    Attributes:
        first: a vertex, edge or face.
        second: another one of the same kind.
        shift: for faces, by how many corners the second outline is turned against the first, so that the tube is
            not twisted. The recorder finds it.
    """

    kind: ClassVar[str] = "connect"

    first: Element = field(ELEMENT)
    second: Element = field(ELEMENT)
    shift: int = field(integer(0, MAX_ELEMENTS), 0)

    def apply(self, mesh: ControlMesh) -> Step:
        """Join the two elements."""
        if self.first.kind != self.second.kind or self.first == self.second:
            raise ModelError(f"{self.first} and {self.second} are not two elements of one kind")
        if self.first.kind == "vertex":
            _cut_face(mesh, self.first.id, self.second.id)
        elif self.first.kind == "edge":
            _close_gap(mesh, self.first.id, self.second.id)
        elif self.first.kind == "face":
            _bridge(mesh, self.first.id, self.second.id, self.shift)
        else:
            raise ModelError("components cannot be connected; connect two of their faces")
        return NO_MOVE


def _cut_face(mesh: ControlMesh, first: int, second: int) -> None:
    shared = set(mesh.faces_of_vertex(first)) & set(mesh.faces_of_vertex(second))
    for face_id in sorted(shared):
        loop = mesh.face(face_id)
        start = loop.index(first)
        turned = loop[start:] + loop[:start]
        end = turned.index(second)
        if 2 <= end <= len(loop) - 2:
            mesh.replace_faces([], [(*turned[end:], first)], keep=(face_id, turned[: end + 1]))
            return
    raise ModelError(f"v{first} and v{second} are not opposite corners of one face")


def _close_gap(mesh: ControlMesh, first: int, second: int) -> None:
    a, b = _against_its_face(mesh, first)
    c, d = _against_its_face(mesh, second)
    if {a, b} & {c, d}:
        mesh.add_face((a, b, d) if b == c else (c, d, b))
        return
    mesh.add_face((a, b, c, d))


def _against_its_face(mesh: ControlMesh, edge_id: int) -> tuple[int, int]:
    """Return the ends of a border edge in the direction that a neighbouring face must walk it."""
    start, end = mesh.edge(edge_id)
    faces = mesh.faces_of_edge(edge_id)
    if len(faces) != 1:
        raise ModelError(f"edge e{edge_id} is no border: it has two faces")
    loop = mesh.face(faces[0])
    return (end, start) if loop[(loop.index(start) + 1) % len(loop)] == end else (start, end)


def _bridge(mesh: ControlMesh, first: int, second: int, shift: int) -> None:
    outline, other = mesh.face(first), mesh.face(second)
    if len(outline) != len(other):
        raise ModelError(f"f{first} has {len(outline)} corners and f{second} has {len(other)}: they cannot be bridged")
    if set(outline) & set(other):
        raise ModelError(f"f{first} and f{second} share a vertex")
    facing = other[::-1]
    n = len(outline)
    quads = [(outline[i], outline[(i + 1) % n], facing[(i + 1 + shift) % n], facing[(i + shift) % n]) for i in range(n)]
    mesh.replace_faces((first, second), quads)
