"""Random procedural models for property tests: any operation, anywhere it is possible, with parameters."""

from dataclasses import dataclass

import hypothesis.strategies as st
import numpy as np

from shapewright.errors import ModelError
from shapewright.modeling import Condition, ProceduralModel, Recorder, mirrored, when
from shapewright.modeling.elements import Element, edge, face

ACTIONS = (
    "extrude",
    "rotation_extrude",
    "insert_vertex",
    "drag",
    "scale",
    "rotate",
    "cut",
    "bridge",
    "merge",
    "dissolve",
    "mark_sharp",
    "component",
    "switch",
)


@dataclass(frozen=True)
class Recipe:
    """How to model something; building is not part of drawing, as hypothesis forbids other randomness there."""

    sides: int
    actions: tuple[str, ...]
    seed: int

    def build(self) -> ProceduralModel:
        """Model it: closed, each operation varied by a parameter of its own where it can be.

        What comes after a switch depends on it: parameters are active and components are there while it is on. A
        parameter keeps below the one before it.
        """
        recorder = Recorder("random", "anything")
        recorder.base("prism", (2.0, 1.5, 1.0), sides=self.sides)
        rng = np.random.default_rng(self.seed)
        switched: tuple[Condition, ...] = ()
        limited_by = ""
        parts: list[tuple[list[int], tuple[Condition, ...]]] = []
        for number, action in enumerate(self.actions):
            name = f"p{number}"
            if action == "switch":
                recorder.switch(name, f"switch {number}", active_when=switched)
                switched = (*switched, when(name, 1))
                continue
            known = recorder.mesh.n_components
            try:
                mode = perform(recorder, action, rng, name)
            except ModelError:
                continue  # impossible there; the recorder is as it was
            made = list(range(known, recorder.mesh.n_components))
            if made and switched:
                parts.append((made, switched))
            if mode is not None:
                maximum = 1.0 if mode == "position" else 2.0
                recorder.parameter(name, f"parameter {number}", 0.5, maximum, active_when=switched)
                if limited_by:
                    recorder.limit(name, maximum=(limited_by, 0.5, 0.5))
                limited_by = name
        for number, (components, conditions) in enumerate(parts):
            whole = [Element("component", c) for c in components if _stands_alone(recorder, c)]
            if whole:
                recorder.part(f"part {number}", whole, conditions)
        return recorder.build()


def _stands_alone(recorder: Recorder, component: int) -> bool:
    """Tell whether a component is there and no later bridge joined it to another."""
    owners = [{recorder.mesh.component_of(v) for v in loop} for loop in recorder.mesh.faces.values()]
    return {component} in owners and not any(component in found and len(found) > 1 for found in owners)


def recipes() -> st.SearchStrategy[Recipe]:
    """Draw recipes of up to 12 actions."""
    actions = st.lists(st.sampled_from(ACTIONS), max_size=12).map(tuple)
    return st.builds(Recipe, st.integers(3, 6), actions, st.integers(0, 2**32 - 1))


def perform(recorder: Recorder, action: str, rng: np.random.Generator, name: str) -> str | None:
    """Do one action on elements picked at random; return the mode in which the parameter acts, if any."""
    faces = sorted(recorder.mesh.faces)
    edges = sorted(recorder.mesh.edges)
    some_face = face(int(rng.choice(faces)))
    some_edge = edge(int(rng.choice(edges)))
    amount = float(rng.uniform(0.2, 0.8))
    if action == "extrude":
        recorder.extrude(some_face, amount, 0.2, 75.0, length=name)
        return "length"
    if action == "rotation_extrude":
        along = recorder.edges_of(some_face)[0]
        recorder.rotation_extrude(some_face, along, 40.0, amount, length=name)
        return "length"
    if action == "insert_vertex":
        recorder.insert_vertex(some_edge, lambda1=0.4, position=name)
        return "position"
    if action == "drag":
        recorder.drag([some_edge], 0.1, amount, 200.0, length=name)
        return "length"
    if action == "scale":
        recorder.scale(some_face, 0.6 + amount, "uv", size=name)
        return "size"
    if action == "rotate":
        recorder.rotate([some_face], 30.0 * amount, angle=name)
        return "angle"
    if action == "cut":
        corners = recorder.vertices_of(some_face)
        recorder.connect(corners[0], corners[2 % len(corners)])
    elif action == "bridge":
        recorder.connect(some_face, face(int(rng.choice(faces))))
    elif action == "merge":
        recorder.remove(some_edge)
    elif action == "dissolve":
        recorder.remove(Element("vertex", int(rng.choice(recorder.mesh.live_vertices()))))
    elif action == "mark_sharp":
        recorder.mark_sharp(some_edge, recorder.vertices_of(some_face)[0])
    else:
        recorder.base("box", (0.5, 0.4, 0.3), anchors=[some_face, mirrored("x", some_face)])
    return None
