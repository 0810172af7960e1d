"""The topology of a control mesh: polygons of any valence whose elements keep their ids for ever.

Positions are not kept here. Parameters move vertices and never change the topology, so the
topology is built once and positions are evaluated for a whole batch (:mod:`shapewright.modeling.compiled`).
"""

from collections.abc import Iterable, Mapping, Sequence

from shapewright.errors import ModelError
from shapewright.modeling.elements import Element

Loop = tuple[int, ...]

MAX_VERTICES = 200_000
MAX_CORNERS = 1024
MAX_WORK = 10_000_000
"""Bound on the work of one instance, in vertices gathered and moved (:meth:`ControlMesh.spend`)."""


class ControlMesh:
    """Vertices, edges, faces and components with ids in the order of their creation; ids are never used again.

    A face is a loop of vertex ids, counter-clockwise seen from outside. An edge is an ordered pair of vertex ids
    (the direction in which it was first walked) and belongs to one or two faces.
    """

    def __init__(self) -> None:
        self.n_vertices = 0
        """Number of vertices ever created; removed ones are counted, so that it is the length of position arrays."""
        self.faces: dict[int, Loop] = {}
        self.edges: dict[int, tuple[int, int]] = {}
        self.sharp_edges: set[int] = set()
        self.sharp_vertices: set[int] = set()
        self.n_components = 0
        self._next_face = 0
        self._next_edge = 0
        self._component_of: list[int] = []
        self._vertices_of_component: list[list[int]] = []
        self._walked: set[tuple[int, int]] = set()  # every (from, to) of every face
        self.work = 0
        """What :meth:`spend` has counted so far."""
        self._edge_ids: dict[tuple[int, int], int] = {}
        self._edge_faces: dict[int, list[int]] = {}
        self._vertex_edges: dict[int, list[int]] = {}

    # ------------------------------------------------------------------ queries

    def face(self, face_id: int) -> Loop:
        """Return the vertex loop of a face; raises ModelError if it is not there."""
        if face_id not in self.faces:
            raise ModelError(f"face f{face_id} does not exist here")
        return self.faces[face_id]

    def edge(self, edge_id: int) -> tuple[int, int]:
        """Return the two vertices of an edge; raises ModelError if it is not there."""
        if edge_id not in self.edges:
            raise ModelError(f"edge e{edge_id} does not exist here")
        return self.edges[edge_id]

    def edge_between(self, first: int, second: int) -> int:
        """Return the id of the edge between two vertices; raises ModelError if there is none."""
        edge_id = self._edge_ids.get(_key(first, second))
        if edge_id is None:
            raise ModelError(f"there is no edge between v{first} and v{second}")
        return edge_id

    def faces_of_edge(self, edge_id: int) -> tuple[int, ...]:
        """Return the one or two faces at an edge, in the order of their ids."""
        self.edge(edge_id)
        return tuple(sorted(self._edge_faces[edge_id]))

    def edges_of_vertex(self, vertex_id: int) -> tuple[int, ...]:
        """Return the edges at a vertex, in the order of their ids; raises ModelError if it is not there."""
        edges = self._vertex_edges.get(vertex_id)
        if not edges:
            raise ModelError(f"vertex v{vertex_id} does not exist here")
        return tuple(sorted(edges))

    def faces_of_vertex(self, vertex_id: int) -> tuple[int, ...]:
        """Return the faces at a vertex, in the order of their ids."""
        return tuple(sorted({f for e in self.edges_of_vertex(vertex_id) for f in self._edge_faces[e]}))

    def live_vertices(self) -> list[int]:
        """Return the ids of the vertices that belong to a face, in order."""
        return sorted({vertex for loop in self.faces.values() for vertex in loop})

    def vertices_of(self, elements: Iterable[Element]) -> list[int]:
        """Return the ids of all vertices of some elements, each once, in order of first appearance.

        Raises:
            ModelError: an element does not exist.
        """
        distinct = dict.fromkeys(elements)
        return list(dict.fromkeys(v for element in distinct for v in self._vertices_of_one(element)))

    def _vertices_of_one(self, element: Element) -> Sequence[int]:
        if element.kind == "face":
            return self.face(element.id)
        if element.kind == "edge":
            return self.edge(element.id)
        if element.kind == "vertex":
            self.edges_of_vertex(element.id)
            return (element.id,)
        return self.vertices_of_component(element.id)

    def check_component(self, component: int) -> None:
        """Raise ModelError if there was never such a component."""
        if component >= self.n_components:
            raise ModelError(f"component c{component} does not exist here")

    def vertices_of_component(self, component: int) -> list[int]:
        """Return the live vertices of a component, in order; raises ModelError if there is no such component."""
        self.check_component(component)
        return [v for v in self._vertices_of_component[component] if self._vertex_edges.get(v)]

    def faces_of_component(self, component: int) -> list[int]:
        """Return the faces whose first corner belongs to a component, in order; raises ModelError as above."""
        around = {f for v in self.vertices_of_component(component) for f in self.faces_of_vertex(v)}
        return sorted(f for f in around if self._component_of[self.faces[f][0]] == component)

    def is_closed(self) -> bool:
        """Tell whether every edge has two faces."""
        return all(len(faces) == 2 for faces in self._edge_faces.values())

    # ------------------------------------------------------------------ changes

    def spend(self, work: int) -> None:
        """Count work that an operation will do for every instance, about one unit for each vertex that it touches.

        Raises:
            ModelError: it is more than ``MAX_WORK``; a small document of a stranger can select everything very often.
        """
        self.work += work
        if self.work > MAX_WORK:
            raise ModelError(f"the operations up to here are too much work: more than {MAX_WORK} moves of vertices")

    def add_component(self) -> int:
        """Start a new component; return its id."""
        self._vertices_of_component.append([])
        self.n_components += 1
        return self.n_components - 1

    def add_vertex(self, component: int) -> int:
        """Add a vertex; it exists for queries as soon as a face uses it.

        Raises:
            ModelError: there are ``MAX_VERTICES`` of them; a stranger's document must not fill the memory.
        """
        if self.n_vertices >= MAX_VERTICES:
            raise ModelError(f"a control mesh of more than {MAX_VERTICES} vertices is refused")
        self._component_of.append(component)
        self._vertices_of_component[component].append(self.n_vertices)
        self.n_vertices += 1
        return self.n_vertices - 1

    def component_of(self, vertex_id: int) -> int:
        """Return the component that a vertex belongs to."""
        return self._component_of[vertex_id]

    def add_face(self, loop: Sequence[int]) -> int:
        """Add a face and the edges that it lacks; return its id.

        Raises:
            ModelError: fewer than three vertices or more than ``MAX_CORNERS``, one of them twice, an edge that has
                two faces already, or one that its other face walks in the same direction.
        """
        face_id = self._next_face
        self._next_face += 1
        self._link(face_id, tuple(loop))
        return face_id

    def replace_loops(self, loops: Mapping[int, Sequence[int]]) -> None:
        """Give faces other loops; they keep their ids. Edges that lose their last face vanish."""
        old = [self._unlink(face_id) for face_id in loops]
        for face_id, loop in loops.items():
            self._link(face_id, tuple(loop))
        for loop in old:
            self._drop_bare_edges(loop)

    def replace_faces(
        self,
        removed: Sequence[int],
        added: Sequence[Sequence[int]],
        keep: tuple[int, Sequence[int]] | None = None,
    ) -> list[int]:
        """Exchange faces in one go, so that edges which the new ones share with the old ones keep their ids.

        Args:
            removed: faces that go.
            added: loops of new faces.
            keep: a face that stays under its id, and its new loop.

        Returns:
            The ids of the new faces.
        """
        old = [self._unlink(face_id) for face_id in removed]
        if keep is not None:
            old.append(self._unlink(keep[0]))
            self._link(keep[0], tuple(keep[1]))
        new = [self.add_face(loop) for loop in added]
        for loop in old:
            self._drop_bare_edges(loop)
        return new

    def remove_face(self, face_id: int) -> None:
        """Remove a face; its edges stay where another face has them (a hole opens)."""
        self._drop_bare_edges(self._unlink(face_id))

    def lift_face(self, face_id: int) -> Loop:
        """Give a face new vertices and join its old outline to them with quads; return its new loop.

        The face keeps its id. The quads get ids in the order of the loop's edges.
        """
        old = self._unlink(face_id)
        new = tuple(self.add_vertex(self.component_of(vertex)) for vertex in old)
        self._link(face_id, new)
        for i in range(len(old)):
            after = (i + 1) % len(old)
            self.add_face((old[i], old[after], new[after], new[i]))
        return new

    def split_edge(self, edge_id: int) -> tuple[int, int]:
        """Put a vertex on an edge. The first half keeps the id, the second is new; both stay sharp if it was.

        Returns:
            The new vertex and the new edge.

        Raises:
            ModelError: the edge does not exist, or a face would get more than ``MAX_CORNERS``.
        """
        start, end = self.edge(edge_id)
        if any(len(self.faces[face_id]) >= MAX_CORNERS for face_id in self._edge_faces[edge_id]):
            raise ModelError(f"a face of more than {MAX_CORNERS} corners is refused")
        middle = self.add_vertex(self.component_of(start))
        del self._edge_ids[_key(start, end)]
        self._vertex_edges[end].remove(edge_id)
        self._name_edge(edge_id, start, middle)
        new_edge = self._next_edge
        self._next_edge += 1
        self._name_edge(new_edge, middle, end)
        self._edge_faces[new_edge] = list(self._edge_faces[edge_id])
        if edge_id in self.sharp_edges:
            self.sharp_edges.add(new_edge)
        for first, second in ((start, end), (end, start)):
            if (first, second) in self._walked:
                self._walked.remove((first, second))
                self._walked |= {(first, middle), (middle, second)}
        for face_id in self._edge_faces[edge_id]:
            self.faces[face_id] = _with_middle(self.faces[face_id], start, end, middle)
        return middle, new_edge

    def _link(self, face_id: int, loop: Loop) -> None:
        if len(loop) < 3:
            raise ModelError("a face needs at least three vertices")
        if len(loop) > MAX_CORNERS:
            raise ModelError(f"a face of more than {MAX_CORNERS} corners is refused")
        if len(set(loop)) != len(loop):
            raise ModelError("a face would use a vertex twice")
        pairs = list(zip(loop, (*loop[1:], loop[0]), strict=True))
        for first, second in pairs:
            if (first, second) in self._walked:
                existing = self._edge_ids[_key(first, second)]
                third = len(self._edge_faces[existing]) >= 2
                problem = "would get a third face" if third else "would join faces that are wound against each other"
                raise ModelError(f"edge e{existing} (v{first}, v{second}) {problem}")
        self.faces[face_id] = loop
        self._walked.update(pairs)
        for first, second in pairs:
            edge_id = self._edge_ids.get(_key(first, second))
            if edge_id is None:
                edge_id = self._next_edge
                self._next_edge += 1
                self._edge_faces[edge_id] = []
                self._name_edge(edge_id, first, second)
            self._edge_faces[edge_id].append(face_id)

    def _unlink(self, face_id: int) -> Loop:
        loop = self.face(face_id)
        for first, second in zip(loop, (*loop[1:], loop[0]), strict=True):
            self._edge_faces[self._edge_ids[_key(first, second)]].remove(face_id)
            self._walked.remove((first, second))
        del self.faces[face_id]
        return loop

    def _drop_bare_edges(self, loop: Loop) -> None:
        for first, second in zip(loop, (*loop[1:], loop[0]), strict=True):
            edge_id = self._edge_ids.get(_key(first, second))
            if edge_id is not None and not self._edge_faces[edge_id]:
                del self._edge_ids[_key(first, second)], self._edge_faces[edge_id], self.edges[edge_id]
                self.sharp_edges.discard(edge_id)
                self._vertex_edges[first].remove(edge_id)
                self._vertex_edges[second].remove(edge_id)

    def _name_edge(self, edge_id: int, start: int, end: int) -> None:
        self.edges[edge_id] = (start, end)
        self._edge_ids[_key(start, end)] = edge_id
        for vertex_id in (start, end):
            edges = self._vertex_edges.setdefault(vertex_id, [])
            if edge_id not in edges:
                edges.append(edge_id)


def _key(first: int, second: int) -> tuple[int, int]:
    return (first, second) if first < second else (second, first)


def _with_middle(loop: Loop, start: int, end: int, middle: int) -> Loop:
    """Insert ``middle`` between two neighbours of a loop, in whichever direction the loop walks them.

    The loop goes on starting where it did, as its first edge gives the face its frame.
    """
    index = loop.index(start)
    after = loop[(index + 1) % len(loop)] == end
    position = index + 1 if after else index or len(loop)
    return (*loop[:position], middle, *loop[position:])
