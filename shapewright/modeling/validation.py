"""What must hold for a procedural model, beyond what its document says: replay, topology, symmetry, variations, effect.

Nothing is raised for a model that is not good: each thing that does not hold is a finding.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial import cKDTree

from shapewright.errors import ModelError
from shapewright.modeling.compiled import CompiledModel, compile_model
from shapewright.modeling.contexts import active_row, distinct_values
from shapewright.modeling.procedural_model import ProceduralModel
from shapewright.modeling.variation_checks import VARIATION_CHECKS, check_variations
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

CHECKS: Final = ("replay", "topology", "symmetry", *VARIATION_CHECKS, "effect")
"""Every check, in the order of the findings."""
SYMMETRY_TOLERANCE: Final = 1e-6
"""Share of the diagonal by which an image may miss."""
LEAST_EFFECT: Final = 0.005
"""Share of the diagonal by which a parameter must move some vertex, unless it makes a part come or go."""

_REPLAYED: Final = 4
_SYMMETRIC: Final = 32
_CONTEXTS: Final = 8


@dataclass(frozen=True)
class Finding:
    """Something that does not hold.

    Attributes:
        model: name of the model.
        check: one of CHECKS.
        where: the place: a parameter, a component, an edge; empty if it is the whole model.
        message: what is wrong, for people.
        values: of a variation that shows it, by parameter; empty for the base model or where no values matter.
    """

    model: str
    check: str
    where: str
    message: str
    values: Mapping[str, float]

    def __str__(self) -> str:
        return f"{self.check}: {self.where}: {self.message}" if self.where else f"{self.check}: {self.message}"


@np.errstate(over="ignore", invalid="ignore")  # what overflows is a finding
def validate_model(
    model: ProceduralModel,
    *,
    variations: int = 1000,
    rng: np.random.Generator | None = None,
    document: str | None = None,
    progress: Progress = NULL_PROGRESS,
) -> list[Finding]:
    """Check a model; an empty list means that all holds.

    Args:
        variations: random ones; the base model is checked too.
        rng: source of their values; seeded with 0 if not given.
        document: the text that the model was read from, if that must be the canonical one.
        progress: told what is being done; may cancel.
    """
    try:
        compiled = compile_model(model)
        compiled.surface_polygons()  # may be too large
    except ModelError as error:
        return [Finding(model.name, "topology", error.where or "", error.message, {})]
    rows = compiled.random_values(np.random.default_rng(0) if rng is None else rng, variations)
    values = np.vstack([compiled.base_values()[None], rows])

    def found(check: str, where: str, message: str, row: Float[np.ndarray, " P"] | None = None) -> Finding:
        names = (parameter.name for parameter in model.parameters)
        named = {} if row is None else dict(zip(names, row.tolist(), strict=True))
        return Finding(model.name, check, where, message, named)

    progress.report(0.0, "replay, topology, symmetry")
    findings = [found("replay", "", message) for message in replay_faults(compiled, values[:_REPLAYED], document)]
    findings += [found("topology", where, message) for where, message in topology_faults(compiled.control_faces)]
    findings += [
        found("symmetry", where, message, values[row] if row else None)
        for where, message, row in symmetry_faults(compiled, values[:_SYMMETRIC])
    ]
    faults = check_variations(compiled, values, PartialProgress(progress, 0.1, 0.9))
    findings += [found(f.check, f.where, f.message, values[f.row] if f.row else None) for f in faults]
    progress.report(0.9, "effect of parameters")
    if "finite" not in {finding.check for finding in findings}:
        findings += [found("effect", where, message) for where, message in effect_faults(compiled, values)]
    return findings


def replay_faults(compiled: CompiledModel, values: Float[np.ndarray, "B P"], document: str | None = None) -> list[str]:
    """Tell what a model loses when it is written and read again."""
    model = compiled.model
    text = model.to_json()
    faults = []
    if document is not None and document != text:
        faults.append("the document is not what the model writes")
    try:
        again = ProceduralModel.from_json(text)
        replayed = compile_model(again)
    except ModelError as error:
        return [*faults, f"the written document cannot be read again: {error}"]
    if again.to_json() != text:
        faults.append("written, read and written again it is another document")
    same_topology = (
        np.array_equal(replayed.control_vertex_ids, compiled.control_vertex_ids)
        and replayed.control_faces == compiled.control_faces
    )
    if not same_topology:
        faults.append("read again it has another topology")
    elif replayed.n_parameters != compiled.n_parameters:
        faults.append("read again it has other parameters")
    elif not np.array_equal(replayed.control_points(values), compiled.control_points(values), equal_nan=True):
        faults.append("read again it gives other instances")
    return faults


def topology_faults(faces: Sequence[Sequence[int]]) -> list[tuple[str, str]]:
    """Tell which edges of polygons belong to more than two, or are run through twice in one direction."""
    directed = Counter((a, b) for loop in faces for a, b in zip(loop, [*loop[1:], loop[0]], strict=True))
    undirected = Counter((min(edge), max(edge)) for edge in directed.elements())
    faults = [(f"edge {a}-{b}", f"{n} faces meet there") for (a, b), n in sorted(undirected.items()) if n > 2]
    crowded = {place for place, _ in faults}
    for (a, b), n in sorted(directed.items()):
        place = f"edge {min(a, b)}-{max(a, b)}"
        if n > 1 and place not in crowded:
            faults.append((place, "its two faces are wound against each other"))
    return faults


def symmetry_faults(compiled: CompiledModel, values: Float[np.ndarray, "B P"]) -> list[tuple[str, str, int]]:
    """Tell which declared maps do not leave the control mesh as it is: the map, what is off, the row."""
    symmetry = compiled.model.symmetry
    apart = np.isin(compiled.control_components, [component.id for component in symmetry.apart])
    parts = compiled.surface_parts(0)
    present = np.hstack([compiled.parts_present(values), np.ones((len(values), 1), dtype=bool)])
    points = compiled.control_points(values)
    faults = []
    for name, matrix in symmetry.maps().items():
        worst, worst_row, worst_component = 0.0, 0, 0
        for row in range(len(values)):
            chosen = present[row][parts] & ~apart
            own = points[row][chosen]
            if not np.isfinite(own).all() or len(own) == 0:
                continue
            off = np.asarray(cKDTree(own).query(own @ matrix.T)[0]) / (_diagonal(own) or 1.0)
            if off.max() > worst:
                worst, worst_row = float(off.max()), row
                worst_component = int(compiled.control_components[chosen][off.argmax()])
        if worst > SYMMETRY_TOLERANCE:
            message = f"component c{worst_component} is off by {worst:.2g} of the diagonal{_in_row(worst_row)}"
            faults.append((name, message, worst_row))
    return faults


def effect_faults(compiled: CompiledModel, values: Float[np.ndarray, "B P"]) -> list[tuple[str, str]]:
    """Tell which parameters change nothing that can be seen, and which parts never come or never go."""
    faults = []
    active = compiled.space.active(values)
    for column, parameter in enumerate(compiled.model.parameters):
        first = active_row(compiled.space, column)
        if first is None:
            faults.append((parameter.name, "it is never active"))
            continue
        contexts = [first, *values[active[:, column]][: _CONTEXTS - 1]]
        greatest = 0.0
        for row in contexts:
            greatest = max(greatest, _effect(compiled, distinct_values(compiled.space, column, row)))
            if greatest > LEAST_EFFECT:
                break
        else:
            faults.append((parameter.name, f"it moves no vertex by more than {greatest:.2g} of the diagonal"))
    present = compiled.parts_present(values)
    for number, part in enumerate(compiled.model.parts):
        if not present[:, number].any():
            faults.append((part.name, "the part is in no variation"))
        elif present[:, number].all() and len(values) > 1:
            faults.append((part.name, "the part is in every variation, so it is not optional"))
    return faults


def _effect(compiled: CompiledModel, rows: Float[np.ndarray, "B P"]) -> float:
    """Largest movement of a vertex between rows, in diagonals; 1 if a part comes or goes."""
    present = compiled.parts_present(rows)
    if not (present == present[0]).all():
        return 1.0
    kept = _kept(compiled, present[0])
    first = compiled.surface_points(rows[:1])[0, kept]
    moved = max(
        float(np.linalg.norm(chunk[:, kept] - first, axis=2).max()) for _, chunk in compiled.surface_chunks(rows)
    )
    return moved / (_diagonal(first) or 1.0)


def _kept(compiled: CompiledModel, present: Bool[np.ndarray, " N"]) -> Bool[np.ndarray, " V"]:
    return np.asarray(np.append(present, True)[compiled.surface_parts()])


def _diagonal(points: Float[np.ndarray, "V 3"]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _in_row(row: int) -> str:
    return f" in variation {row - 1}" if row else " in the base model"
