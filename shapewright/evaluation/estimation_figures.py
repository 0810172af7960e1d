"""Figures of estimations that need no truth: layers, distances, seconds (paper section 4.3, Figure 9)."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from shapewright.estimation.result import StageName
from shapewright.evaluation.estimated import Estimated

GOOD: Final = 0.35
"""A z-buffer distance below this looks right, whatever the threshold of layer 3 says."""
EXACT: Final = 0.1
"""A z-buffer distance below this is what a query that the model can follow completely should reach."""
NO_WORSE: Final = 1e-3
"""A z-buffer distance that is larger by less than this is no worse: it is a few pixels."""
LAYERS: Final = (1, 2, 3)
QUANTILES: Final = (0.05, 0.25, 0.5, 0.75, 0.95)


def estimation_figures(estimated: Sequence[Estimated]) -> dict[str, Any]:
    """Sum up all queries, ready for JSON.

    ``layer_share`` tells which layer's result is the answer, ``distances_by_stage`` how the two distances are
    distributed after each stage, over all queries: quantiles and the mean.
    """
    return {
        **_summed(estimated),
        "seconds_p95": _quantile((one.answer.seconds for one in estimated), 0.95),
        "per_class": {name: _summed(members) for name, members in by_class(estimated).items()},
        "distances_by_stage": {
            stage: {name: _distribution(values) for name, values in distances.items()}
            for stage, distances in stage_distances(estimated).items()
        },
    }


def against(fast: Sequence[Estimated], reference: Sequence[Estimated]) -> dict[str, Any]:
    """Compare two estimators on the queries that both estimated, by name.

    ``zbuffer_no_worse`` is the share of queries whose z-buffer distance is at most that of the reference;
    ``processor_ratio_median`` tells how many times more processor seconds the reference took.
    """
    others = {one.name: one.answer for one in reference}
    pairs = [(one.answer, others[one.name]) for one in fast if one.name in others]
    worse = [a.distances.zbuffer > b.distances.zbuffer + NO_WORSE for a, b in pairs]
    ratios = [b.processor_seconds / max(a.processor_seconds, 1e-9) for a, b in pairs]
    return {
        "n": len(pairs),
        "zbuffer_no_worse": 1.0 - sum(worse) / len(worse) if worse else None,
        "processor_ratio_median": _quantile(ratios, 0.5) if ratios else None,
    }


def by_class(estimated: Iterable[Estimated]) -> dict[str, list[Estimated]]:
    """Return the queries of each class, in the order of names."""
    found: dict[str, list[Estimated]] = {}
    for one in estimated:
        found.setdefault(one.class_name, []).append(one)
    return dict(sorted(found.items()))


def stage_distances(estimated: Iterable[Estimated]) -> Mapping[StageName, Mapping[str, list[float]]]:
    """Return the surface and z-buffer distances after each stage that was run, in the order of the stages."""
    found: dict[StageName, dict[str, list[float]]] = {}
    for one in estimated:
        for stage in one.answer.stages:
            distances = found.setdefault(stage.name, {"surface": [], "zbuffer": []})
            distances["surface"].append(stage.distances.surface)
            distances["zbuffer"].append(stage.distances.zbuffer)
    return found


def _summed(estimated: Sequence[Estimated]) -> dict[str, Any]:
    layers = [one.answer.layer for one in estimated]
    zbuffer = np.array([one.answer.distances.zbuffer for one in estimated])
    return {
        "n": len(estimated),
        "layer_share": {str(layer): layers.count(layer) / len(layers) for layer in LAYERS},
        "zbuffer_median": _quantile(zbuffer, 0.5),
        "surface_median": _quantile((one.answer.distances.surface for one in estimated), 0.5),
        "under_0_35": float((zbuffer < GOOD).mean()),
        "under_0_1": float((zbuffer < EXACT).mean()),
        "seconds_median": _quantile((one.answer.seconds for one in estimated), 0.5),
        "processor_seconds_median": _quantile((one.answer.processor_seconds for one in estimated), 0.5),
    }


def _quantile(values: Iterable[float], share: float) -> float:
    return float(np.quantile(np.fromiter(values, dtype=np.float64), share))


def _distribution(values: Sequence[float]) -> dict[str, float]:
    found = {f"p{100 * share:02.0f}": _quantile(values, share) for share in QUANTILES}
    return {"n": len(values), "mean": float(np.mean(values)), **found}
