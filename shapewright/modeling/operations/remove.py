"""Remove faces, edges or vertices."""

from dataclasses import dataclass
from typing import ClassVar

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh, Loop
from shapewright.modeling.elements import Element
from shapewright.modeling.fields import ELEMENTS, field
from shapewright.modeling.operations.operation import NO_MOVE, Operation, Step


@dataclass(frozen=True)
class Remove(Operation):
    """Elements go, in the order given.

    A face leaves a hole. An edge leaves one face where two were (the one with the smaller id stays). A vertex with
    two edges leaves a straight edge, with a new id, that is sharp if both were; any other inner vertex leaves one
    face where its faces were.
    """

    kind: ClassVar[str] = "remove"

    elements: tuple[Element, ...] = field(ELEMENTS)

    def apply(self, mesh: ControlMesh) -> Step:
        """Remove the elements."""
        if not self.elements:
            raise ModelError("nothing is selected")
        for element in self.elements:
            if element.kind == "face":
                mesh.remove_face(element.id)
            elif element.kind == "edge":
                _merge_faces(mesh, element.id)
            elif element.kind == "vertex":
                _remove_vertex(mesh, element.id)
            else:
                _remove_component(mesh, element)
        if not mesh.faces:
            raise ModelError("nothing is left of the mesh")
        return NO_MOVE


def _remove_component(mesh: ControlMesh, component: Element) -> None:
    faces = mesh.faces_of_component(component.id)
    if not faces:
        raise ModelError(f"component {component} has no faces left")
    for face_id in faces:
        mesh.remove_face(face_id)


def _merge_faces(mesh: ControlMesh, edge_id: int) -> None:
    faces = mesh.faces_of_edge(edge_id)
    if len(faces) != 2:
        raise ModelError(f"edge e{edge_id} is a border; remove its face instead")
    start, end = mesh.edge(edge_id)
    first, second = (_open_at(mesh.face(face_id), start, end) for face_id in faces)
    # Each part walks from one end of the edge to the other; joined they are the outline of both faces.
    merged = first[:-1] + second[:-1]
    if first[0] != second[-1] or len(set(merged)) != len(merged):
        raise ModelError(f"the faces at edge e{edge_id} meet elsewhere too, or are wound against each other")
    mesh.replace_faces(faces[1:], [], keep=(faces[0], merged))


def _open_at(loop: Loop, start: int, end: int) -> Loop:
    """Turn a loop so that the edge (start, end) closes it."""
    index = loop.index(start)
    if loop[(index + 1) % len(loop)] == end:
        index = (index + 1) % len(loop)
    return loop[index:] + loop[:index]


def _remove_vertex(mesh: ControlMesh, vertex_id: int) -> None:
    edges = mesh.edges_of_vertex(vertex_id)
    faces = mesh.faces_of_vertex(vertex_id)
    if len(edges) == 2:
        sharp = mesh.sharp_edges.issuperset(edges)
        start, end = (next(v for v in mesh.edge(e) if v != vertex_id) for e in edges)
        loops = {f: tuple(v for v in mesh.face(f) if v != vertex_id) for f in faces}
        mesh.replace_loops(loops)
        if sharp:
            mesh.sharp_edges.add(mesh.edge_between(start, end))
        return
    if len(edges) != len(faces):
        raise ModelError(f"v{vertex_id} lies on a border; remove its faces instead")
    # Walk around the vertex: each face contributes its outline without the vertex.
    parts = {}
    for face_id in faces:
        loop = mesh.face(face_id)
        index = loop.index(vertex_id)
        part = loop[index + 1 :] + loop[:index]
        parts[part[0]] = part
    start = min(parts)
    merged: list[int] = []
    at = start
    for _ in faces:
        if at not in parts:
            raise ModelError(f"the faces around v{vertex_id} are wound against each other")
        merged += parts[at][:-1]
        at = parts[at][-1]
    if at != start or len(set(merged)) != len(merged):
        raise ModelError(f"the faces around v{vertex_id} meet elsewhere too")
    mesh.replace_faces(faces[1:], [], keep=(faces[0], tuple(merged)))
