"""Which layer's result is the answer (end of section 3.3), and which model's."""

from collections.abc import Sequence

from shapewright.estimation.result import Estimation, FailedThreshold, Stage, Verdict
from shapewright.estimation.settings import EstimationSettings


def best_zbuffer_stage(stages: Sequence[Stage]) -> Stage | None:
    """The best of the results of layer 3, None if there is none."""
    return min((s for s in stages if s.layer == 3), key=lambda s: s.distances.zbuffer, default=None)


def choose(stages: Sequence[Stage], settings: EstimationSettings) -> Stage:
    """The stage whose result is adequate.

    The better result of layer 3 if its z-buffer distance is below the threshold, else that of layer 2 if its
    surface distance is, else that of layer 1. After a cancellation layers may be missing: they cannot be
    chosen.

    Raises:
        ValueError: there is no stage of layer 1 to fall back to.
    """
    by_layer = {stage.layer: stage for stage in stages}
    if 1 not in by_layer:
        raise ValueError("no result of layer 1")
    third = best_zbuffer_stage(stages)
    if third is not None and third.distances.zbuffer < settings.zbuffer_threshold:
        return third
    if 2 in by_layer and by_layer[2].distances.surface < settings.surface_threshold:
        return by_layer[2]
    return by_layer[1]


def judge(stages: Sequence[Stage], answer: Stage, settings: EstimationSettings) -> Verdict:
    """Say which thresholds kept the results of higher layers from being the answer.

    A layer that was not reached has missed none.
    """
    failed = []
    third = best_zbuffer_stage(stages)
    if answer.layer < 3 and third is not None:
        failed.append(FailedThreshold("zbuffer", third.distances.zbuffer, settings.zbuffer_threshold))
    second = next((stage for stage in stages if stage.layer == 2), None)
    if answer.layer < 2 and second is not None:
        failed.append(FailedThreshold("surface", second.distances.surface, settings.surface_threshold))
    return Verdict(answer.layer, tuple(failed))


def order(estimation: Estimation) -> tuple[int, float]:
    """Sorts estimations of one query with different models, the best first (ours).

    An adequate result of a higher layer goes before one of a lower layer; within a layer the distance counts that made
    it adequate.
    """
    distances = estimation.distances
    decisive = {1: distances.panorama, 2: distances.surface, 3: distances.zbuffer}
    return -estimation.layer, decisive[estimation.layer]
