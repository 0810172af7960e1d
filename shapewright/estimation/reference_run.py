"""The layers of the reference estimator for one model (paper section 3.3, Figure 4)."""

from collections.abc import Callable

import numpy as np

from shapewright.estimation import layers
from shapewright.estimation.hill_climbing import Candidate
from shapewright.estimation.record import Record
from shapewright.estimation.result import StageName
from shapewright.estimation.steady_progress import SteadyProgress, phases
from shapewright.progress import Progress

REFERENCE_STAGES: tuple[StageName, ...] = ("panorama", "surface", "surface+zbuffer", "zbuffer")
"""The four optimizations of Figure 4 in their order."""

_WEIGHTS = {  # shares of the time that were seen
    "layer 1": 3.0,
    "layer 2, alignment": 15.0,
    "layer 2": 25.0,
    "layer 3 after layer 2": 21.0,
    "layer 3 after layer 1": 21.0,
}


def refine(record: Record, start: Candidate, progress: Progress, steady: SteadyProgress) -> None:
    """Work through the layers from the nearest random instance; whatever is found goes into the record at once.

    The readings that the paper leaves open:

    - The initial normalization brings the query and the instance of layer 1 into the shared coordinate system
      once; afterwards the pose alone moves the instance. Normalizing every instance anew would let each
      change of one length rescale everything else.
    - The limits of the scale are shares of the scale that this normalization gave.
    - A climb that is realigned begins at the realigned start, and each candidate's realignment at the pose of
      the incumbent.
    - If layer 2 changed nothing, the second start of layer 3 equals the first and is not run again.

    Args:
        record: of this estimator and the model.
        start: the nearest random instance.
        progress: told what is going on.
        steady: what ``progress`` is a part of; its last report is repeated within long loops.

    Raises:
        Cancelled: the progress cancelled.
        MeshError: an instance has no extent.
    """
    comparison = record.comparison
    phase = phases(progress, _WEIGHTS)

    def keep(stage: StageName) -> Callable[[Candidate], None]:
        return lambda candidate: record.put(stage, candidate.values, candidate.pose)

    first = layers.climb_panorama(comparison, start, phase["layer 1"], keep("panorama"))
    original_scale = comparison.initial_pose(comparison.instance(first.values)).scale
    aligned = layers.align_in_24_ways(comparison, first, phase["layer 2, alignment"], steady, keep("panorama"))
    record.finish("panorama")

    def climb(distance: layers.DistanceOf, name: str, start: Candidate, stage: StageName, part: str) -> Candidate:
        best = layers.climb_realigned(
            comparison, distance, name, start, original_scale, phase[part], steady, keep(stage)
        )
        record.finish(stage)
        return best

    surface, zbuffer = "surface distance", "z-buffer distance"
    second = climb(comparison.surface, surface, aligned, "surface", "layer 2")
    third = climb(comparison.zbuffer, zbuffer, second, "surface+zbuffer", "layer 3 after layer 2")
    if second.pose is aligned.pose and np.array_equal(second.values, aligned.values):
        record.put("zbuffer", third.values, third.pose)
        record.finish("zbuffer")
    else:
        climb(comparison.zbuffer, zbuffer, aligned, "zbuffer", "layer 3 after layer 1")
