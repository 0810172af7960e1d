"""The regions of a model, named for people: its optional parts, and what its other components are."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, count

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.modeling.compiled import SUBDIVISION_STEPS, CompiledModel, changes_of
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.procedural_model import ProceduralModel
from shapewright.modeling.program import SCRATCH, Program

_MEASURE = re.compile(
    "angle|arch|bend|breadth|bulge|chord|curve|depth|diameter|drop|edge|extent|gap|height|inset|length|lift|place|point|"
    "radius|rake|rise|shift|size|slope|span|splay|spread|sweep|taper|thickness|tilt|turn|width",
    re.IGNORECASE,
)
"""Words that end a label like "Leg length" and say what is measured, not of what."""
_MOST_NAMES = 3


@dataclass(frozen=True, eq=False)
class Regions:
    """Which region each component of a model belongs to.

    A region is an optional part or several that have one name before a colon ("Rotor: blades", "Rotor: disc"), or the
    components that one base made (the four legs). Make it once a model with :func:`find_regions`.

    Attributes:
        names: of the regions, each once: names of parts, words from the labels of the parameters that change little
            else ("Leg"), or "component 3".
        of_component: the region of each component.
    """

    names: tuple[str, ...]
    of_component: Int[np.ndarray, " C"]

    def of_instance(
        self, compiled: CompiledModel, values: Float[np.ndarray, " P"], steps: int = SUBDIVISION_STEPS
    ) -> Int[np.ndarray, " V"]:
        """Return the region of each vertex of ``compiled.instance(values, steps)``.

        Raises:
            ParameterError: not P values, or NaN.
            ModelError: ``steps`` is out of range.
        """
        of_vertex = self.of_component[compiled.control_components]
        for step in range(1, steps + 1):
            polygons = compiled.surface_polygons(step)
            refined = np.empty(polygons.n_vertices, dtype=np.int64)
            quads = np.array(polygons.loops)  # each begins at a vertex of the level before
            refined[quads] = of_vertex[quads[:, :1]]
            of_vertex = refined
        present: Bool[np.ndarray, " N"] = np.append(compiled.parts_present(values[None])[0], True)  # no part: -1
        return np.asarray(of_vertex[present[compiled.surface_parts(steps)]])


def find_regions(model: ProceduralModel) -> Regions:
    """Return the regions of a valid model, its parts first."""
    mesh = ControlMesh()
    made_by: list[int] = []  # the operation of each component
    changes = changes_of(model)
    changed: list[frozenset[int]] = []  # the components that each operation moves
    for index, operation in enumerate(model.operations):
        step = operation.apply(mesh)
        made_by += [index] * (mesh.n_components - len(made_by))
        program = Program()
        step.write(program, changes.get(index, ()))
        moved = {int(row) for instruction in program.instructions for row in instruction.targets if row < SCRATCH}
        changed.append(frozenset(mesh.component_of(vertex) for vertex in moved))
    part_of = {component.id: part.name.split(":")[0] for part in model.parts for component in part.components}
    kinds: list[str | int] = [part_of.get(c, made_by[c]) for c in range(mesh.n_components)]
    in_order = list(dict.fromkeys([*part_of.values(), *(kind for kind in kinds if isinstance(kind, int))]))
    of_component = [in_order.index(kind) for kind in kinds]
    labels = _labels(model, changed, of_component)
    names: list[str] = []
    for number, kind in enumerate(in_order):
        name = kind if isinstance(kind, str) else _common_name(labels.get(number, []))
        names.append(_unlike(name or f"component {of_component.index(number)}", names))
    return Regions(tuple(names), np.array(of_component, dtype=np.int64))


def _labels(
    model: ProceduralModel, changed: Sequence[frozenset[int]], of_component: Sequence[int]
) -> dict[int, list[str]]:
    """Return, by region, the labels of the parameters that change it, of those that change the fewest other regions."""
    n_regions = len(set(of_component))
    fewest: dict[int, int] = {}
    labels: dict[int, list[str]] = {}
    for parameter in model.parameters:
        components = frozenset().union(*(changed[target.operation] for target in parameter.targets))
        regions = {of_component[component] for component in components}
        if len(regions) > max(1, n_regions // 2):
            continue  # it says nothing of any one region, like "Overall thickness"
        for region in regions:
            if len(regions) < fewest.get(region, len(of_component) + 1):
                fewest[region], labels[region] = len(regions), []
            if len(regions) == fewest[region]:
                labels[region].append(parameter.label)
    return labels


def _common_name(labels: Sequence[str]) -> str | None:
    """Return what the labels measure something of: "Leg" for "Leg length" and "Leg width (relative to thickness)".

    Where no one thing has half of the labels, the most common ones are listed: "Stem, bowl, foot".
    """
    named: Counter[str] = Counter()
    for label in labels:
        words = re.split(r"[(,]", label)[0].split()
        measures = next((i for i, word in enumerate(words) if _MEASURE.fullmatch(word)), None)
        if measures:
            named[" ".join(words[:measures])] += 1
    ranked = named.most_common(_MOST_NAMES)
    if not ranked or 2 * ranked[0][1] >= named.total():
        return ranked[0][0] if ranked else None
    return ", ".join([ranked[0][0], *(name[0].lower() + name[1:] for name, _ in ranked[1:])])


def _unlike(name: str, others: Sequence[str]) -> str:
    """Return the name, numbered if it is taken: "Leg", "Leg 2"."""
    numbered = (f"{name} {number}" for number in count(2))
    return next(candidate for candidate in chain([name], numbered) if candidate not in others)
