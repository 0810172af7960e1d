"""The reference estimator: the paper, step by step (section 3.3, Figure 4), for one model or several."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from shapewright.errors import Cancelled
from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank_for
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.estimator import BankOf
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.hill_climbing import Candidate
from shapewright.estimation.layers import nearest_in_bank
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.query import Query
from shapewright.estimation.record import Record
from shapewright.estimation.reference_run import REFERENCE_STAGES, refine
from shapewright.estimation.result import Estimation, EstimationCancelled, ModelTried
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.steady_progress import SteadyProgress, Titled
from shapewright.estimation.verdict import order
from shapewright.progress import PartialProgress, Progress

_BANK_WEIGHT = 15.0  # of the paper's 10 000 instances
_REFINING_WEIGHT = 85.0


class ReferenceEstimator:
    """The paper has one model; of several the banks are scanned for the instance with the smallest panorama distance.

    The ``settings.refined_models`` nearest models go through all layers, and :func:`verdict.order` tells which result
    is better (ours).

    Args:
        banks: finds the bank of a model; without it each is built when its turn comes. None is kept after its scan, as
            a bank may be large.
    """

    def __init__(self, banks: BankOf | None = None) -> None:
        self._banks = banks

    def estimate(
        self,
        query: Query,
        models: Sequence[InstanceGenerator],
        settings: EstimationSettings,
        progress: Progress,
    ) -> Estimation:
        """Find the best fit; see :class:`shapewright.estimation.estimator.Estimator`."""
        work = _Work(models, settings, self._banks or _builder(settings))
        try:
            return work.run(query, SteadyProgress(progress))
        except Cancelled as cancelled:
            raise EstimationCancelled(work.best(complete=False)) from cancelled


@dataclass(eq=False)
class _Scanned:
    """A model after its scan, and what its refinement has found so far."""

    generator: InstanceGenerator
    nearest: Candidate
    record: Record | None = None


class _Work:
    """One query's way through the models."""

    def __init__(self, models: Sequence[InstanceGenerator], settings: EstimationSettings, banks: BankOf) -> None:
        self._models = models
        self._settings = settings
        self._banks = banks
        self._prepared: PreparedQuery | None = None
        self._scanned: list[_Scanned] = []

    def run(self, query: Query, steady: SteadyProgress) -> Estimation:
        """Scan all models, refine the nearest."""
        settings = self._settings
        steady.report(0.0, "preparing the query")
        prepared = self._prepared = PreparedQuery(query, settings)
        refined = min(settings.refined_models, len(self._models))
        banks_weight = _BANK_WEIGHT * len(self._models) * settings.samples / 10_000
        scan_share = banks_weight / (banks_weight + _REFINING_WEIGHT * refined)
        self._scan(prepared, PartialProgress(steady, 0.0, scan_share))
        self._scanned.sort(key=lambda one: one.nearest.distance)
        for number, one in enumerate(self._scanned[:refined]):
            start, end = (scan_share + (1.0 - scan_share) * k / refined for k in (number, number + 1))
            part = Titled(PartialProgress(steady, start, end), one.generator.model.name)
            one.record = self._begin(prepared, one)
            refine(one.record, one.nearest, part, steady)
        steady.report(1.0, "estimated")
        best = self.best(complete=True)
        assert best is not None
        return best

    def best(self, *, complete: bool) -> Estimation | None:
        """Answer with what is there: the best of the refined models, else the nearest instance of the scan."""
        if self._prepared is None or not self._scanned:
            return None
        by_distance = sorted(self._scanned, key=lambda one: one.nearest.distance)
        if all(one.record is None for one in by_distance):
            by_distance[0].record = self._begin(self._prepared, by_distance[0])
        found = [(one, one.record.estimation()) for one in by_distance if one.record is not None]
        answers = sorted(((one, answer) for one, answer in found if answer), key=lambda item: order(item[1]))
        best = answers[0][1]
        tried = [ModelTried(one.generator.model, answer.distances, one.nearest.distance) for one, answer in answers]
        tried += [
            ModelTried(one.generator.model, panorama=one.nearest.distance) for one in by_distance if one.record is None
        ]
        reached = {id(one.generator) for one in by_distance}
        tried += [ModelTried(generator.model) for generator in self._models if id(generator) not in reached]
        return replace(best, tried=tuple(tried), complete=complete and best.complete)

    def _scan(self, prepared: PreparedQuery, progress: Progress) -> None:
        count = len(self._models)
        for number, generator in enumerate(self._models):
            part = Titled(PartialProgress(progress, number / count, (number + 1) / count), generator.model.name)
            part.report(0.0, "random instances")
            try:
                self._add(prepared, generator, self._banks(generator, part))
            except BankCancelled as cancelled:
                if cancelled.bank is not None:
                    self._add(prepared, generator, cancelled.bank)
                raise

    def _add(self, prepared: PreparedQuery, generator: InstanceGenerator, bank: PanoramaBank) -> None:
        bank.check_fits(generator, self._settings.subdivision_steps)
        self._scanned.append(_Scanned(generator, nearest_in_bank(prepared.descriptor, bank)))

    def _begin(self, prepared: PreparedQuery, one: _Scanned) -> Record:
        record = Record("reference", Comparison(prepared, one.generator, self._settings), REFERENCE_STAGES)
        record.put("panorama", one.nearest.values)
        return record


def _builder(settings: EstimationSettings) -> BankOf:
    def build(generator: InstanceGenerator, progress: Progress) -> PanoramaBank:
        return build_bank_for(generator, settings, progress)

    return build
