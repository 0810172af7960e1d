"""Other answers that fit about as well as the best one: poses, options, models."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.estimation.generator import ModelInfo
from shapewright.estimation.result import Alternative, Distances, ParameterEstimate
from shapewright.estimation.turns import find_turn
from shapewright.modeling.symmetry import NO_SYMMETRY, Symmetry

RELATIVE_MARGIN: Final = 0.1
"""An answer whose z-buffer distance is this share above the best one's fits about as well."""
ABSOLUTE_MARGIN: Final = 0.02
"""The same, as a difference, for small distances."""
SAME_POSE_DEG: Final = 20.0
"""Poses that differ by less, up to symmetry, are one."""
MOST_ALTERNATIVES: Final = 8


@dataclass(frozen=True, eq=False)
class Contender:
    """A finished fit that may be the answer or an alternative to it.

    Attributes:
        model: whose parameters they are.
        values: x.
        parameters: the same with names and options.
        pose: model space to the query's own file coordinates.
        distances: of the fit.
        symmetry: what the model declares.
    """

    model: ModelInfo
    values: Float[np.ndarray, " P"]
    parameters: tuple[ParameterEstimate, ...]
    pose: Pose
    distances: Distances
    symmetry: Symmetry = NO_SYMMETRY

    @property
    def options(self) -> dict[str, str]:
        """The chosen options by the label of their parameter; inactive ones are left out."""
        return {p.label: p.option for p in self.parameters if p.option is not None and p.active}


def list_alternatives(best: Contender, others: Sequence[Contender]) -> tuple[Alternative, ...]:
    """Return what fits about as well as the best answer and is something else, nearest first.

    Something else is another model (the nearest of its fits), another option, or a pose that differs by more than its
    symmetry allows. Fits that differ in measures alone are one answer.

    Args:
        best: the answer.
        others: any other fits of the query; the answer may be among them.
    """
    margin = max(RELATIVE_MARGIN * best.distances.zbuffer, ABSOLUTE_MARGIN)
    near = [other for other in others if other.distances.zbuffer <= best.distances.zbuffer + margin]
    kept: list[Contender] = []
    for other in sorted(near, key=lambda contender: contender.distances.zbuffer):
        if not any(_are_one(other, listed, best) for listed in (best, *kept)):
            kept.append(other)
    return tuple(_alternative(best, contender) for contender in kept[:MOST_ALTERNATIVES])


def _are_one(contender: Contender, listed: Contender, best: Contender) -> bool:
    if contender.model.digest != listed.model.digest:
        return False
    if contender.model.digest != best.model.digest:
        return True  # of another model, one fit is enough
    apart_deg, _ = find_turn(listed.pose.rotation, contender.pose.rotation, contender.symmetry)
    return apart_deg < SAME_POSE_DEG and contender.options == listed.options


def _alternative(best: Contender, other: Contender) -> Alternative:
    if other.model.digest != best.model.digest:
        return _named("model", other, f"model {other.model.name}")
    differences = _option_differences(best.options, other.options)
    apart_deg, turn = find_turn(best.pose.rotation, other.pose.rotation, other.symmetry)
    turned = [str(turn)] if apart_deg >= SAME_POSE_DEG else []
    return _named("option" if differences else "pose", other, "; ".join([*differences, *turned]))


def _named(kind: Literal["pose", "option", "model"], contender: Contender, label: str) -> Alternative:
    return Alternative(
        kind=kind,
        model=contender.model,
        values=contender.values,
        parameters=contender.parameters,
        pose=contender.pose,
        distances=contender.distances,
        label=label,
    )


def _option_differences(best: dict[str, str], other: dict[str, str]) -> list[str]:
    """Return "Rotor: disc instead of four blades" for each difference.

    An option that only one side has follows from another one as a rule, and is told if there is no other.
    """
    changed = [
        f"{label}: {option} instead of {best[label]}"
        for label, option in other.items()
        if label in best and best[label] != option
    ]
    added = [f"{label}: {option}" for label, option in other.items() if label not in best]
    missing = [f"no {label}" for label in best if label not in other]
    return changed or added or missing
