"""The reference estimator: the paper, step by step (section 3.3, Figure 4)."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from shapewright.distances.alignment import Pose
from shapewright.errors import Cancelled
from shapewright.estimation import layers
from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.hill_climbing import Candidate
from shapewright.estimation.result import (
    STAGE_LAYERS,
    Estimation,
    EstimationCancelled,
    ParameterEstimate,
    Stage,
    StageName,
)
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.steady_progress import SteadyProgress, phases
from shapewright.estimation.verdict import choose
from shapewright.mesh import TriangleMesh
from shapewright.progress import Progress

SHOWN_SUBDIVISION_STEPS = 2
"""The fitted mesh is subdivided at least this often, even if coarser instances were compared."""

_BANK_WEIGHT = 15.0  # of the paper's 10 000 instances
_WEIGHTS = {  # shares of the time that were seen
    "layer 1": 3.0,
    "layer 2, alignment": 15.0,
    "layer 2": 25.0,
    "layer 3 after layer 2": 21.0,
    "layer 3 after layer 1": 21.0,
}


class ReferenceEstimator:
    """One run of the reference estimator over one query.

    The readings that the paper leaves open:

    - The initial normalisation brings the query and the instance of layer 1 into the shared coordinate system
      once; afterwards the pose alone moves the instance. Normalising every instance anew would let each
      change of one length rescale everything else.
    - The limits of the scale are shares of the scale that this normalisation gave.
    - A climb that is realigned begins at the realigned start, and each candidate's realignment at the pose of
      the incumbent.
    - If layer 2 changed nothing, the second start of layer 3 equals the first and is not run again.
    """

    def __init__(
        self,
        query: TriangleMesh,
        generator: InstanceGenerator,
        settings: EstimationSettings,
        progress: Progress,
    ) -> None:
        self._query = query
        self._generator = generator
        self._settings = settings
        self._steady = SteadyProgress(progress)
        self._found: dict[StageName, Candidate] = {}
        self._finished: set[StageName] = set()
        self._comparison: Comparison | None = None

    def run(self, bank: PanoramaBank | None) -> Estimation:
        """Work through the layers.

        Raises:
            EstimationCancelled: the progress cancelled; carries the best so far.
            EstimationError: the bank does not fit.
            MeshError: the query or an instance has no extent.
        """
        try:
            self._work(bank)
            return self._estimation()
        except Cancelled as cancelled:
            raise EstimationCancelled(self._estimation() if self._found else None) from cancelled

    def _work(self, bank: PanoramaBank | None) -> None:
        settings = self._settings
        bank_rng, points_rng = np.random.default_rng(settings.seed).spawn(2)
        bank_weight = _BANK_WEIGHT * settings.samples / 10_000 if bank is None else 0.0
        phase = phases(self._steady, {"bank": bank_weight, **_WEIGHTS})
        self._steady.report(0.0, "preparing the query")
        comparison = Comparison(self._query, self._generator, settings, points_rng)
        self._comparison = comparison
        if bank is None:
            bank = self._build_bank(comparison, bank_rng, phase["bank"])
        else:
            bank.check_fits(self._generator, settings.subdivision_steps)

        start = layers.nearest_in_bank(comparison.descriptor, bank)
        self._found["panorama"] = start
        first = layers.climb_panorama(comparison, start, phase["layer 1"], self._keep("panorama"))
        original_scale = comparison.initial_pose(comparison.instance(first.values).vertices).scale
        aligned = layers.align_in_24_ways(
            comparison, first, phase["layer 2, alignment"], self._steady, self._keep("panorama")
        )
        self._finished.add("panorama")

        def climb(
            distance: layers.PosedDistance, name: str, start: Candidate, stage: StageName, part: str
        ) -> Candidate:
            keep = self._keep(stage)
            best = layers.climb_realigned(
                comparison, distance, name, start, original_scale, phase[part], self._steady, keep
            )
            self._finished.add(stage)
            return best

        surface, zbuffer = "surface distance", "z-buffer distance"
        second = climb(comparison.surface, surface, aligned, "surface", "layer 2")
        third = climb(comparison.zbuffer, zbuffer, second, "surface+zbuffer", "layer 3 after layer 2")
        if second.pose is aligned.pose and np.array_equal(second.values, aligned.values):
            self._found["zbuffer"] = third
            self._finished.add("zbuffer")
        else:
            climb(comparison.zbuffer, zbuffer, aligned, "zbuffer", "layer 3 after layer 1")
        self._steady.report(1.0, "estimated")

    def _build_bank(self, comparison: Comparison, rng: np.random.Generator, progress: Progress) -> PanoramaBank:
        settings = self._settings
        try:
            return build_bank(
                self._generator, settings.samples, rng, progress, subdivision_steps=settings.subdivision_steps
            )
        except BankCancelled as cancelled:
            if cancelled.bank is not None:
                self._found["panorama"] = layers.nearest_in_bank(comparison.descriptor, cancelled.bank)
            raise

    def _keep(self, name: StageName) -> Callable[[Candidate], None]:
        def keep(candidate: Candidate) -> None:
            self._found[name] = candidate

        return keep

    def _estimation(self) -> Estimation:
        stages = tuple(self._stage(name) for name in STAGE_LAYERS if name in self._found)
        answer = choose(stages, self._settings)
        steps = max(self._settings.subdivision_steps, SHOWN_SUBDIVISION_STEPS)
        instance = self._generator.instance(answer.values, steps)
        mesh = TriangleMesh(answer.pose.apply(instance.vertices), instance.faces)
        return Estimation(
            layer=answer.layer,
            values=answer.values,
            parameters=self._parameters(answer.values),
            pose=answer.pose,
            distances=answer.distances,
            stages=stages,
            mesh=mesh,
            complete=len(self._finished) == len(STAGE_LAYERS),
        )

    def _parameters(self, values: Float[np.ndarray, " P"]) -> tuple[ParameterEstimate, ...]:
        space = self._generator.space
        lowest, highest = space.ranges(values[None])
        active = space.active(values[None])[0]
        return tuple(
            ParameterEstimate(
                name=parameter.name,
                label=parameter.label,
                unit=parameter.unit,
                value=float(values[i]),
                base_value=parameter.base_value,
                minimum=float(lowest[0, i]),
                maximum=float(highest[0, i]),
                active=bool(active[i]),
                option=dict(parameter.named_options()).get(float(values[i])),
            )
            for i, parameter in enumerate(self._generator.model.parameters)
        )

    def _stage(self, name: StageName) -> Stage:
        assert self._comparison is not None
        comparison = self._comparison
        candidate = self._found[name]
        instance = comparison.instance(candidate.values)
        pose: Pose = candidate.pose or comparison.initial_pose(instance.vertices)
        return Stage(
            name=name,
            values=candidate.values,
            pose=comparison.to_file.compose(pose),
            distances=comparison.distances(instance, pose),
            complete=name in self._finished,
        )
