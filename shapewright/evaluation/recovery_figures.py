"""Figures of synthetic queries: how much of the truth comes out right, and whether intervals keep their promise.

See :mod:`shapewright.evaluation.recovery` for what counts and when a pose is right.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np

from shapewright.evaluation.estimated import Estimated
from shapewright.evaluation.recovery import CLOSE, RecoveredParameter, Recovery, recover

HARDEST: Final = 0.25
"""Share of the queries that count as the hardest: those with the largest z-buffer distances."""


def recoveries(estimated: Iterable[Estimated]) -> list[Recovery]:
    """Compare every synthetic query with its truth."""
    return [recover(one.truth, one.answer) for one in estimated if one.truth is not None]


def recovery_figures(
    estimated: Sequence[Estimated], found: Sequence[Recovery], *, model_known: bool = False
) -> dict[str, Any]:
    """Sum up all synthetic queries, ready for JSON; a share of nothing is ``None``.

    Args:
        estimated: the queries.
        found: how each compares with its truth.
        model_known: whether only the true model was tried; ``model_right`` says nothing then, and is ``None``.
    """
    parameters = [parameter for one in found for parameter in one.parameters]
    right = [one for one in found if one.model_right]
    return {
        **_shares(parameters),
        "within_5_percent_ratios": _share(ratio for one in found for ratio in one.ratios_right),
        "ratios": sum(len(one.ratios_right) for one in found),
        "options_right": _share(option.right for one in found for option in one.options),
        "options_all_right": _share(one.options_all_right for one in right),
        "model_right": None if model_known else _share(one.model_right for one in found),
        "pose_right": _share(bool(one.pose_right) for one in right),
        "pose_right_or_offered": _share(bool(one.pose_offered) for one in right),
        "interval_coverage_hardest_quarter": _coverage(_of_the_hardest(estimated, found)),
        "parameters": len(parameters),
        "parameters_active": sum(one.active_parameters for one in found),
        "per_parameter": _per_parameter(found),
    }


def _shares(parameters: Sequence[RecoveredParameter]) -> dict[str, Any]:
    """Figures that are given for all parameters and for each one."""
    judged = [parameter for parameter in parameters if parameter.status is not None]
    determined = [parameter for parameter in judged if parameter.status == "determined"]
    return {
        "within_5_percent": _share(parameter.error <= CLOSE for parameter in parameters),
        "within_5_percent_determined": _share(parameter.error <= CLOSE for parameter in determined),
        "determined_share": _share(parameter.status == "determined" for parameter in judged),
        "determined_up_to_scale_share": _share(parameter.status == "determined_up_to_scale" for parameter in judged),
        "interval_coverage": _coverage(parameters),
        "interval_width_median": _median(p.half_width for p in parameters if p.half_width is not None),
    }


def _per_parameter(found: Sequence[Recovery]) -> dict[str, dict[str, dict[str, Any]]]:
    """The same by model and parameter, with the median error as a share of the range."""
    groups: dict[str, dict[str, list[RecoveredParameter]]] = {}
    options: dict[str, dict[str, list[bool]]] = {}
    for one in found:
        for parameter in one.parameters:
            groups.setdefault(one.model, {}).setdefault(parameter.name, []).append(parameter)
        for option in one.options:
            options.setdefault(one.model, {}).setdefault(option.name, []).append(option.right)
    figures: dict[str, dict[str, dict[str, Any]]] = {}
    for model in sorted({*groups, *options}):
        figures[model] = {
            name: {"n": len(members), "error_median": _median(p.error for p in members), **_shares(members)}
            for name, members in sorted(groups.get(model, {}).items())
        }
        for name, rights in sorted(options.get(model, {}).items()):
            figures[model][name] = {"n": len(rights), "right": _share(rights)}
    return figures


def _of_the_hardest(estimated: Sequence[Estimated], found: Sequence[Recovery]) -> list[RecoveredParameter]:
    order = np.argsort([-one.answer.distances.zbuffer for one in estimated], kind="stable")
    hardest = order[: int(np.ceil(HARDEST * len(order)))]
    return [parameter for i in hardest for parameter in found[i].parameters]


def _coverage(parameters: Iterable[RecoveredParameter]) -> float | None:
    return _share(parameter.covered for parameter in parameters if parameter.covered is not None)


def _share(tests: Iterable[bool]) -> float | None:
    outcomes = list(tests)
    return sum(outcomes) / len(outcomes) if outcomes else None


def _median(values: Iterable[float]) -> float | None:
    found = list(values)
    return float(np.median(found)) if found else None
