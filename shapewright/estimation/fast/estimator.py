"""The fast estimator: the same layers, distances and verdict as the reference, and a better search (ours)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation.alternatives import Contender, list_alternatives
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.determination.factors import IntervalFactors
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FittedModel
from shapewright.estimation.fast.following import ROUGHLY, follow_surface
from shapewright.estimation.fast.judging import determine_fit
from shapewright.estimation.fast.measure import fine_distance
from shapewright.estimation.fast.search import Known, Phase, Search
from shapewright.estimation.fast.target import Target
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.query import Query
from shapewright.estimation.record import Record, parameter_estimates
from shapewright.estimation.residuals import measure_residuals
from shapewright.estimation.result import Alternative, Distances, Estimation, EstimationCancelled, ModelTried
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.steady_progress import SteadyProgress
from shapewright.modeling.compiled import CompiledModel
from shapewright.modeling.regions import find_regions
from shapewright.progress import Progress

FAST_STAGES: Final[tuple[Phase, ...]] = ("start", "fit", "polish")
_SEARCHING: Final = 0.95
_TURNS: Final = 36
"""Orientations about a known vertical that are tried."""


class FastEstimator:
    """Many starts, least squares over pose and parameters together, options as branches, a polish by z-buffer distance.

    Nothing is stored or learned before the first query of a model.
    """

    def estimate(
        self,
        query: Query,
        models: Sequence[InstanceGenerator],
        settings: EstimationSettings,
        progress: Progress,
    ) -> Estimation:
        """Find the best fit; see :class:`shapewright.estimation.estimator.Estimator`.

        Raises:
            EstimationError: a model is not a compiled procedural model.
        """
        compiled = [_compiled(model, f"models[{number}]") for number, model in enumerate(models)]
        steady = SteadyProgress(progress)
        work: _Work | None = None
        try:
            steady.report(0.0, "preparing the query")
            work = _Work(query, compiled, settings, steady.repeat)
            steady.report(0.02, "first orientations")
            work.search.report = lambda fraction, message: steady.report(_SEARCHING * fraction, message)
            work.search.run(np.random.default_rng(settings.seed))
            steady.report(_SEARCHING, "judging the fit")
            answer = work.judged(steady.repeat)
            steady.report(1.0, "estimated")
            return answer
        except Cancelled as cancelled:
            raise EstimationCancelled(None if work is None else work.answer(complete=False)) from cancelled


class _Work:
    """One query: its preparation, its search, and the answer that can be made of it at any moment."""

    def __init__(
        self,
        query: Query,
        compiled: Sequence[CompiledModel],
        settings: EstimationSettings,
        checkpoint: Callable[[], None],
    ) -> None:
        self._prepared = PreparedQuery(query, settings, checkpoint)
        self._comparisons = [Comparison(self._prepared, model, settings) for model in compiled]
        target = Target.of(self._prepared, settings, checkpoint)
        known = [_known(comparison) for comparison in self._comparisons]
        models = [FittedModel(model) for model in compiled]
        self.search = Search(target, models, known, lambda fraction, message: None)
        self._followed: dict[int, Candidate] = {}
        self._measured: dict[Candidate, Candidate] = {}
        self.search.best["start", 0] = self._first_guess()

    def _first_guess(self) -> Candidate:
        """Return the base instance of the first model, as the paper normalizes it: an answer at once."""
        comparison, model = self._comparisons[0], self.search.models[0]
        values = model.settle(model.compiled.base_values())
        pose = comparison.initial_pose(comparison.instance(values))
        guess = Candidate(model, values, pose.rotation, pose.translation, pose.scale)
        return fine_distance(self.search.target, guess)

    def answer(self, *, complete: bool) -> Estimation | None:
        """Answer with the best so far; ``None`` before there is any."""
        best = self._best_of_models()
        if not best:
            return None
        number, _ = best[0]
        record = self._record(number)
        estimation = record.estimation()
        assert estimation is not None
        determination = determine_fit(
            self.search.target,
            self._answering(number, estimation),
            scale_known=self._comparisons[number].known_scale is not None,
            factors=IntervalFactors.shipped(),
        )
        tried = [ModelTried(self._model(number).model, estimation.distances)]
        tried += [ModelTried(self._model(other).model, self._distances(candidate)) for other, candidate in best[1:]]
        unseen = set(range(len(self._comparisons))) - {other for other, _ in best}
        tried += [ModelTried(self._model(other).model) for other in sorted(unseen)]
        estimation = replace(estimation, tried=tuple(tried), complete=complete and estimation.complete)
        if determination is None:
            return estimation
        parameters = tuple(
            replace(parameter, status=status, interval=interval)
            for parameter, status, interval in zip(
                estimation.parameters, determination.statuses, determination.intervals, strict=True
            )
        )
        return replace(
            estimation,
            parameters=parameters,
            ratios=determination.ratios,
            combinations=determination.combinations,
        )

    def judged(self, checkpoint: Callable[[], None]) -> Estimation:
        """Answer with everything: the last fit, where the surfaces part, and what else would fit.

        Args:
            checkpoint: called between steps; may raise to stop.
        """
        self._follow()
        checkpoint()
        answer = self.answer(complete=True)
        assert answer is not None
        number = next(k for k, comparison in enumerate(self._comparisons) if comparison.generator.model is answer.model)
        model = self._model(number)
        regions = find_regions(model.model)
        residuals = measure_residuals(
            self._prepared.query.mesh,
            answer.mesh,
            region_names=regions.names,
            regions=regions.of_instance(model, answer.values),
            checkpoint=checkpoint,
        )
        assert answer.verdict is not None
        return replace(
            answer,
            verdict=replace(answer.verdict, residuals=residuals),
            alternatives=self._alternatives(number, answer),
        )

    # ------------------------------------------------------------------ parts of the answer

    def _follow(self) -> None:
        number, best = self._best_of_models()[0]
        settled = None if self.search.settled is None else self.search.settled.candidate
        if settled is not None and best.zbuffer > settled.zbuffer - ROUGHLY:
            self._followed[self.search.models.index(settled.model)] = settled
            return
        known = self.search.known[number]
        self._followed[number] = follow_surface(
            self.search.target, best, keeps_scale=known.scale is not None, keeps_rotation=known.keeps_rotation
        )

    def _best_of_models(self) -> list[tuple[int, Candidate]]:
        """Return the number and the best candidate of each model that has one, by the distance of the fine surface."""
        search = self.search
        found: dict[int, Candidate] = {}
        for (_, number), candidate in search.best.items():
            fine = self._fine(candidate)
            if number not in found or fine.zbuffer < found[number].zbuffer:
                found[number] = fine
        return sorted(found.items(), key=lambda item: (item[0] not in self._followed, item[1].zbuffer))

    def _fine(self, candidate: Candidate) -> Candidate:
        """Return the candidate with the distance of its fine surface, which is measured once."""
        if candidate not in self._measured:
            self._measured[candidate] = fine_distance(self.search.target, candidate)
        return self._measured[candidate]

    def _record(self, number: int) -> Record:
        """Return the stages of one model; a later one is no worse than those before it, by depth or by surface."""
        record = Record("fast", self._comparisons[number], FAST_STAGES)
        best: Candidate | None = None
        for stage in FAST_STAGES:
            candidate = self.search.best.get((stage, number))
            if candidate is not None:
                candidate = self._fine(candidate)
                if best is None or candidate.zbuffer < best.zbuffer:
                    best = candidate
            if best is not None and stage == FAST_STAGES[-1]:
                best = self._followed.get(number, best)
            if best is not None and (candidate is not None or stage in self.search.finished):
                record.put(stage, best.values, best.pose)
            if stage in self.search.finished:
                record.finish(stage)
        return record

    def _answering(self, number: int, estimation: Estimation) -> Candidate:
        pose = self._comparisons[number].to_file.inverse().compose(estimation.pose)
        model = self.search.models[number]
        return Candidate(model, estimation.values, pose.rotation, pose.translation, pose.scale)

    def _alternatives(self, number: int, answer: Estimation) -> tuple[Alternative, ...]:
        """List what fits about as well; only what is listed is measured by every distance."""
        symmetry = self._model(number).model.symmetry
        best = Contender(answer.model, answer.values, answer.parameters, answer.pose, answer.distances, symmetry)
        limit = 1.2 * self._best_of_models()[0][1].zbuffer + 0.03  # the last fit may have given depth up for surface
        near = [one for one in self.search.kept if one.zbuffer < limit]
        listed = list_alternatives(best, [self._contender(one) for one in near])
        by_values = {id(one.values): one for one in near}
        return tuple(replace(one, distances=self._distances(by_values[id(one.values)])) for one in listed)

    def _contender(self, candidate: Candidate) -> Contender:
        number = self.search.models.index(candidate.model)
        comparison, model = self._comparisons[number], self._model(number)
        zbuffer = self._fine(candidate).zbuffer
        return Contender(
            model.model,
            candidate.values,
            parameter_estimates(model, candidate.values, self._prepared.query),
            comparison.to_file.compose(candidate.pose),
            Distances(np.nan, np.nan, zbuffer, np.nan),
            model.model.symmetry,
        )

    def _distances(self, candidate: Candidate) -> Distances:
        comparison = self._comparisons[self.search.models.index(candidate.model)]
        return comparison.distances(comparison.instance(candidate.values), candidate.pose)

    def _model(self, number: int) -> CompiledModel:
        return self.search.models[number].compiled


def _compiled(model: InstanceGenerator, where: str) -> CompiledModel:
    if not isinstance(model, CompiledModel):
        kind = type(model).__name__
        raise EstimationError(f"expected a compiled procedural model for the fast estimator, got {kind}", where=where)
    return model


def _known(comparison: Comparison) -> Known:
    query = comparison.prepared.query
    if query.rotation is not None:
        return Known(comparison.known_scale, query.rotation[None], keeps_rotation=True)
    up = query.up_vector()
    return Known(comparison.known_scale, None if up is None else _rotations_about(up))


def _rotations_about(up: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "R 3 3"]:
    """Return rotations that take +z to a vector, evenly about it."""
    side = np.roll(np.abs(up), 1)
    upright = np.stack([side, np.cross(up, side), up], axis=1)
    angles_rad = np.arange(_TURNS) * (2.0 * np.pi / _TURNS)
    turns = np.zeros((_TURNS, 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles_rad)
    turns[:, 1, 0], turns[:, 0, 1] = np.sin(angles_rad), -np.sin(angles_rad)
    turns[:, 2, 2] = 1.0
    return upright @ turns
