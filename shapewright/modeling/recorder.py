"""The recorder: a script models one object, and the operation list of the procedural model writes itself.

Every call carries out an operation on the object as it is at x = 1 and appends it to the list, so a script can ask
where things are (:meth:`Recorder.centre`, :meth:`Recorder.faces_towards`) and refer to what it made.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from shapewright.errors import ModelError
from shapewright.modeling.compiled import compile_model
from shapewright.modeling.component import Component
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.declarations import Declarations
from shapewright.modeling.elements import Element, Target, edge, face
from shapewright.modeling.executable import carry_out
from shapewright.modeling.frames import frame_of_element, write_frame
from shapewright.modeling.operations import (
    OPERATIONS,
    Base,
    Connect,
    Drag,
    Extrude,
    InsertVertex,
    MarkSharp,
    Operation,
    Remove,
    Rotate,
    RotationExtrude,
    Scale,
)
from shapewright.modeling.parameter import ParameterTarget
from shapewright.modeling.procedural_model import ProceduralModel
from shapewright.modeling.program import Program

Selection = Element | Target | Sequence[Element | Target]
Vector = tuple[float, float, float]
ORIGIN: Vector = (0.0, 0.0, 0.0)


class Recorder(Declarations):
    """Models an object and writes down how.

    Moving methods take a parameter's name for each of the operation's modes that it shall vary, as in
    ``recorder.extrude(top, 0.8, length="stem_length")``; parameters are declared (:class:`Declarations`) before or
    after. Every method raises ModelError for an element that does
    not exist or an impossible change.
    """

    def __init__(
        self, name: str, class_name: str, *, description: str = "", closed: bool = True, unit_m: float | None = None
    ) -> None:
        """Begin an empty object; see :class:`ProceduralModel` for the arguments."""
        super().__init__()
        self.name = name
        self.class_name = class_name
        self.description = description
        self.closed = closed
        self.unit_m = unit_m
        self.mesh = ControlMesh()
        self._positions: Float[np.ndarray, "V 3"] = np.zeros((0, 3))
        self._operations: list[Operation] = []
        self._targets: dict[str, list[ParameterTarget]] = {}

    # ------------------------------------------------------------------ bases

    def box(
        self, x: float, y: float, z: float, *, offset: Vector = ORIGIN, anchor: Element | Target | None = None
    ) -> Component:
        """Start a box at the origin of the model or of one anchor; see :meth:`base`."""
        return self.base("box", (x, y, z), offset=offset, anchors=anchor or ())[0]

    def prism(
        self,
        sides: int,
        diameter: float,
        height: float,
        *,
        offset: Vector = ORIGIN,
        anchor: Element | Target | None = None,
    ) -> Component:
        """Start a regular prism at the origin of the model or of one anchor; see :meth:`base`."""
        size = (diameter, diameter, height)
        return self.base("prism", size, sides=sides, offset=offset, anchors=anchor or ())[0]

    def base(
        self,
        shape: Literal["box", "prism", "ring", "sheet"],
        size: Vector,
        *,
        sides: int = 4,
        tube_sides: int = 4,
        offset: Vector = ORIGIN,
        anchors: Selection = (),
    ) -> list[Component]:
        """Start one component for each anchor (none: at the origin)."""
        known_faces = set(self.mesh.faces)
        first_component = self.mesh.n_components
        operation = Base(shape, size, sides, tube_sides, offset, _targets(anchors))
        self._do(operation, {})
        made = range(first_component, self.mesh.n_components)
        new_faces = sorted(set(self.mesh.faces) - known_faces)
        each = len(new_faces) // len(made)
        return [
            Component(Element("component", c), tuple(face(f) for f in new_faces[i * each : (i + 1) * each]))
            for i, c in enumerate(made)
        ]

    # ------------------------------------------------------------------ operations

    def extrude(self, faces: Selection, z: float = 0.0, rho: float = 0.0, phi_deg: float = 0.0, **varies: str) -> None:
        """Extrude each face by (rho, phi, z) in its frame; the faces keep their ids.

        ``varies`` names a parameter for a mode: ``length="stem_length"``.
        """
        self._do(Extrude(_targets(faces), z, rho, phi_deg), varies)

    def extrude_path(self, faces: Selection, points: Iterable[Vector], **varies: str) -> None:
        """Extrude along a sketched path: one extrusion for each point, given relative to the point before it.

        The points are (u, v, z) in the frame that the face has when its turn comes. Every step varies alike.
        """
        for u, v, z in points:
            self.extrude(faces, z, float(np.hypot(u, v)), float(np.degrees(np.arctan2(v, u))), **varies)

    def extrude_curve(
        self,
        element: Element,
        along: Element,
        steps: Iterable[tuple[float, float]],
        width: float = 1.0,
        /,
        **varies: str,
    ) -> None:
        """Sketch a curve from a face: for each (angle_deg, length) one rotation-extrude about the edge ``along``.

        After a step the curve goes on from the copy of that edge at the new place.
        """
        position = self.mesh.face(element.id).index
        start, end = (position(v) for v in self.mesh.edge(along.id))
        for angle_deg, length in steps:
            loop = self.mesh.face(element.id)
            turned = edge(self.mesh.edge_between(loop[start], loop[end]))
            self.rotation_extrude(element, turned, angle_deg, length, width, **varies)

    def rotation_extrude(
        self,
        element: Element,
        along: Element,
        angle_deg: float,
        length: float,
        width: float = 1.0,
        /,
        **varies: str,
    ) -> None:
        """Extrude a face and turn it about one of its edges; modes: length, width.

        Arguments are positional, because the modes have the same names.
        """
        self._do(RotationExtrude(element, along, angle_deg, length, width), varies)

    def insert_vertex(
        self, *edges: Element | tuple[Element, bool], lambda1: float = 0.5, **varies: str
    ) -> list[Element]:
        """Insert a vertex on each edge (with True: walked backwards); mode: position. Returns the vertices."""
        before = self.mesh.n_vertices
        directed = tuple(item if isinstance(item, tuple) else (item, False) for item in edges)
        self._do(InsertVertex(directed, lambda1), varies)
        return [Element("vertex", v) for v in range(before, self.mesh.n_vertices)]

    def drag(self, what: Selection, z: float = 0.0, rho: float = 0.0, phi_deg: float = 0.0, **varies: str) -> None:
        """Move targets by (rho, phi, z) in their frames; modes: length, angle, height, sideways."""
        self._do(Drag(_targets(what), z, rho, phi_deg), varies)

    def scale(
        self, what: Selection, sigma: float, axes: str = "uvz", *, pivot: Element | None = None, **varies: str
    ) -> None:
        """Scale targets about their centres or the pivot's; mode: size."""
        self._do(Scale(_targets(what), sigma, axes, pivot), varies)

    def rotate(
        self,
        what: Selection,
        alpha_deg: float,
        axis: str = "z",
        *,
        pivot: Element | None = None,
        **varies: str,
    ) -> None:
        """Turn targets about an axis of their frames; mode: angle."""
        self._do(Rotate(_targets(what), alpha_deg, axis, pivot), varies)

    def connect(self, first: Element, second: Element) -> None:
        """Connect two vertices of a face, two border edges, or two faces (then the least twisted way)."""
        shift = self._best_shift(first, second) if first.kind == second.kind == "face" else 0
        self._do(Connect(first, second, shift), {})

    def remove(self, *elements: Element) -> None:
        """Remove faces, edges or vertices."""
        self._do(Remove(elements), {})

    def mark_sharp(self, *elements: Element, sharp: bool = True) -> None:
        """Mark edges (of faces) as creases and vertices as corners, or smooth them."""
        self._do(MarkSharp(elements, sharp), {})

    # ------------------------------------------------------------------ looking

    def positions(self, element: Element) -> Float[np.ndarray, "N 3"]:
        """Return where the vertices of an element are now."""
        return self._positions[self.mesh.vertices_of([element])]

    def centre(self, element: Element) -> Float[np.ndarray, "3"]:
        """Return the mean of the vertices of an element."""
        centre: Float[np.ndarray, 3] = self.positions(element).mean(axis=0)
        return centre

    def normal(self, element: Element) -> Float[np.ndarray, "3"]:
        """Return the unit normal of a face."""
        self.mesh.face(element.id)
        return self.frame(element)[:, 2]

    def frame(self, element: Element) -> Float[np.ndarray, "3 3"]:
        """Return the local frame of an element with u, v and z as columns."""
        program = Program()
        write_frame(program, frame_of_element(self.mesh, element))
        return carry_out(program, self._positions)[-3:].T

    def edges_of(self, element: Element) -> list[Element]:
        """Return the edges of a face, in the order of its loop."""
        loop = self.mesh.face(element.id)
        return [edge(self.mesh.edge_between(a, b)) for a, b in zip(loop, (*loop[1:], loop[0]), strict=True)]

    def vertices_of(self, element: Element) -> list[Element]:
        """Return the vertices of an element."""
        return [Element("vertex", v) for v in self.mesh.vertices_of([element])]

    def faces_of(self, component: Component) -> list[Element]:
        """Return all faces that a component has now."""
        owner = component.whole.id
        return [face(f) for f, loop in sorted(self.mesh.faces.items()) if self.mesh.component_of(loop[0]) == owner]

    def new_sides(self, element: Element) -> list[Element]:
        """Return the faces around a face, in the order of its loop (after an extrusion: its new sides)."""
        return [
            face(other)
            for e in self.edges_of(element)
            for other in self.mesh.faces_of_edge(e.id)
            if other != element.id
        ]

    def faces_towards(self, component: Component, direction: Vector) -> list[Element]:
        """Return the component's faces whose normals point most along a direction, the best first."""
        along = np.array(direction) / np.linalg.norm(direction)
        return sorted(self.faces_of(component), key=lambda f: -float(self.normal(f) @ along))

    # ------------------------------------------------------------------ result

    def build(self) -> ProceduralModel:
        """Return the procedural model.

        Raises:
            ModelError: a parameter was used but not declared, or declared but not used; or the model is not valid.
        """
        undeclared = sorted(set(self._targets) - set(self._declared))
        if undeclared:
            raise ModelError(f"parameter {undeclared[0]!r} is used but not declared")
        parameters = []
        for declared in self._declared.values():
            targets = tuple(self._targets.get(declared.name, ()))
            if not targets and not declared.options:
                raise ModelError(f"parameter {declared.name!r} is declared but changes nothing")
            parameters.append(replace(declared, targets=targets))
        model = ProceduralModel(
            self.name,
            self.class_name,
            tuple(self._operations),
            tuple(parameters),
            self.description,
            self.closed,
            tuple(self._parts),
            self._symmetry,
            self.unit_m,
        )
        compile_model(model)
        return model

    # ------------------------------------------------------------------ inside

    def _do(self, operation: Operation, varies: dict[str, str]) -> None:
        for mode in varies:
            if mode not in operation.modes:
                known = ", ".join(operation.modes) or "none"
                raise ModelError(f"{operation.kind} has no mode {mode!r}; it has: {known}")
        index = len(self._operations)
        document = operation.to_document()
        # What is recorded is what a document says: checked, and numbers of any kind as they will be read.
        operation = OPERATIONS[document.pop("op")].from_document(document, f"operations[{index}]")
        try:
            step = operation.apply(self.mesh)
        except ModelError as error:
            self.mesh = _replayed(self._operations)  # a refused operation leaves everything as it was
            raise ModelError(error.message, where=f"operations[{index}] ({operation.kind})") from None
        grown = np.zeros((self.mesh.n_vertices, 3))
        grown[: len(self._positions)] = self._positions
        program = Program()
        step.write(program, ())
        self._positions = carry_out(program, grown)[: len(grown)]
        self._operations.append(operation)
        for mode, name in varies.items():
            self._targets.setdefault(name, []).append(ParameterTarget(index, mode))

    def _best_shift(self, first: Element, second: Element) -> int:
        outline = self._positions[list(self.mesh.face(first.id))]
        facing = self._positions[list(self.mesh.face(second.id))[::-1]]
        if len(outline) != len(facing):
            return 0
        lengths = [
            np.linalg.norm(outline - np.roll(facing, -shift, axis=0), axis=1).sum() for shift in range(len(outline))
        ]
        return int(np.argmin(lengths))


def _replayed(operations: Iterable[Operation]) -> ControlMesh:
    mesh = ControlMesh()
    for operation in operations:
        operation.apply(mesh)
    return mesh


def _targets(selection: Selection) -> tuple[Target, ...]:
    if isinstance(selection, Element | Target):
        selection = [selection]
    return tuple(item if isinstance(item, Target) else Target((item,)) for item in selection)
