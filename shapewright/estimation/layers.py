"""The steps of the three layers (paper section 3.3, Figure 4)."""

from collections.abc import Callable

import numpy as np

from shapewright.distances.alignment import Pose, realign
from shapewright.distances.panorama import PanoramaDescriptor, panorama_distances
from shapewright.estimation.bank import PanoramaBank
from shapewright.estimation.comparison import Comparison, Instance, PosedDistance
from shapewright.estimation.hill_climbing import Candidate, Evaluate, SearchSpace, hill_climb, without_pose
from shapewright.estimation.steady_progress import SteadyProgress
from shapewright.progress import Progress

Improved = Callable[[Candidate], None]
"""Told about every new incumbent, so that a cancelled estimation has its best so far."""

DistanceOf = Callable[[Instance], PosedDistance]
"""Prepares the distance of an instance, which then asks for its pose."""

_SCAN_ROWS = 1024


def nearest_in_bank(descriptor: PanoramaDescriptor, bank: PanoramaBank) -> Candidate:
    """Start of layer 1: the random instance with the smallest panorama distance to the query."""
    best, distance = 0, np.inf
    for start in range(0, len(bank), _SCAN_ROWS):
        distances = panorama_distances(descriptor, bank.descriptors[start : start + _SCAN_ROWS])
        row = int(np.argmin(distances))
        if distances[row] < distance:
            best, distance = start + row, float(distances[row])
    return Candidate(np.array(bank.values[best], dtype=np.float64), distance)


def climb_panorama(comparison: Comparison, start: Candidate, progress: Progress, improved: Improved) -> Candidate:
    """Rest of layer 1: hill climbing with the panorama distance, which knows no pose."""
    measured = without_pose(lambda values: comparison.panorama(comparison.instance(values)))
    return _climb(comparison, measured, start, progress, improved, "panorama distance")


def align_in_24_ways(
    comparison: Comparison, start: Candidate, progress: Progress, steady: SteadyProgress, improved: Improved
) -> Candidate:
    """Start of layer 2: the best alignment by surface distance out of those begun at each of the 24 rotations.

    Of these only those are tried that agree with what is known of the query.

    The result's distance is the surface distance. ``improved`` is told in the same terms.
    """
    instance = comparison.instance(start.values)
    surface = comparison.surface(instance)
    normal = comparison.initial_pose(instance)
    best: Candidate | None = None
    rotations = comparison.starting_rotations()
    for k, rotation in enumerate(rotations):
        known = "" if best is None else f", surface distance {best.distance:.4f}"
        progress.report(k / len(rotations), f"orientation {k + 1} of {len(rotations)}{known}")
        alignment = realign(
            surface.points,
            surface.at_points,
            Pose(rotation).compose(normal),
            comparison.alignment,
            checkpoint=steady.repeat,
        )
        if best is None or alignment.distance < best.distance:
            best = Candidate(start.values, alignment.distance, alignment.pose)
            improved(best)
    assert best is not None
    progress.report(1.0, f"aligned, surface distance {best.distance:.4f}")
    return best


def climb_realigned(
    comparison: Comparison,
    distance: DistanceOf,
    name: str,
    start: Candidate,
    original_scale: float,
    progress: Progress,
    steady: SteadyProgress,
    improved: Improved,
) -> Candidate:
    """Hill climbing with a distance that knows the pose, realigned after every change.

    With the surface distance it is the rest of layer 2, with the z-buffer distance one of the two climbs of layer 3.
    """
    evaluate = _realigned(comparison, distance, original_scale, steady)
    begin = evaluate(start.values, start)
    improved(begin)
    return _climb(comparison, evaluate, begin, progress, improved, name)


def _realigned(comparison: Comparison, distance: DistanceOf, original_scale: float, steady: SteadyProgress) -> Evaluate:
    """Measure an instance at the best pose that is found from the incumbent's; generated once for all poses."""

    def evaluate(values: np.ndarray, incumbent: Candidate) -> Candidate:
        instance = comparison.instance(values)
        measured = distance(instance)
        alignment = realign(
            measured.points,
            measured.at_points,
            incumbent.pose or comparison.initial_pose(instance),
            comparison.alignment,
            original_scale=original_scale,
            checkpoint=steady.repeat,
        )
        return Candidate(values, alignment.distance, alignment.pose)

    return evaluate


def _climb(
    comparison: Comparison,
    evaluate: Evaluate,
    start: Candidate,
    progress: Progress,
    improved: Improved,
    name: str,
) -> Candidate:
    generator = comparison.generator
    options = tuple(tuple(x for x, _ in parameter.named_options()) for parameter in generator.model.parameters)
    climb = hill_climb(
        evaluate,
        start,
        SearchSpace(generator.space.settle, options),
        comparison.settings.step_sizes,
        progress=progress,
        on_improvement=improved,
        name=name,
    )
    return climb.best
