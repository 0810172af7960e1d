"""The search of the fast estimator: from many starts to one polished answer, with the best so far at any moment."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np
from jaxtyping import Float

from shapewright.errors import EstimationError
from shapewright.estimation.fast.branches import other_choices, other_poses
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import COARSE, FINE, FittedModel
from shapewright.estimation.fast.least_squares import Effort, fit
from shapewright.estimation.fast.measure import fine_distance, outline_distance
from shapewright.estimation.fast.polish import Polish
from shapewright.estimation.fast.pool import Pool
from shapewright.estimation.fast.settling import Settled, Settling
from shapewright.estimation.fast.starts import find_starts, spread
from shapewright.estimation.fast.target import Target

Phase = Literal["start", "fit", "polish"]

INSTANCES: Final = 96
"""Random instances of one model that are scored; several models share half as many again, but each has at least a
sixth."""
STARTS, STARTS_OF_EACH = 40, 3
"""Candidates that least squares begin with: the best of all, and of each model."""
SIFTED, SIFTED_OF_EACH = 16, 1
"""Candidates that go on after a few rounds."""
PURSUED, PURSUED_OF_EACH = 6, 1
"""Candidates that go on after the first fit."""
APPROACHES, APPROACHES_OF_SEVERAL = 3, 2
"""Times that a search begins, with other instances each time, until the query is solved; fewer where there are several
models and none of them follows the query yet."""
BRANCHED: Final = 2
"""Candidates whose options are changed."""
SETTLED: Final = 2
"""Candidates that are fitted by surfaces, to see whether their models follow the query."""
POLISHED: Final = 2
"""Candidates that are polished."""

_SIFT: Final = Effort(
    rounds=2, points=250, steps=COARSE, neighbors=2, width=0.2, damping=1e-2, pull=1e-6, outline=250, outline_width=0.3
)
_FIRST: Final = Effort(
    rounds=5, points=300, steps=COARSE, neighbors=3, width=0.2, damping=1e-2, pull=1e-6, outline=300, outline_width=0.2
)
_GLANCE: Final = Effort(rounds=2, points=300, steps=COARSE, neighbors=3, width=0.05, outline=300)
_CLOSER: Final = Effort(rounds=8, points=600, steps=COARSE, neighbors=4, outline=600)
_DENSE: Final = Effort(rounds=8, points=1200, steps=FINE, neighbors=4, damping=1e-4, outline=1000, outline_width=0.05)
_BRANCHINGS: Final = 4
_CHILDREN: Final = 2
_GAIN: Final = 1e-4
_ROUNDS, _ROUND_GAIN = 15, 1e-3
_WORTH_POLISHING: Final = 1.25
"""Candidates whose z-buffer distance is larger than the best one's by this factor are not polished."""
_MUCH_FARTHER: Final = (1.5, 0.1)
"""Candidates whose z-buffer distance after the first fit is larger than the best one's by this factor, and this more,
are given up."""
_SURE: Final = 1e-3
"""Mean distance between surfaces, in half extents, below which a query is solved: its options stay as they are."""
_ALIKE: Final = 1.05
"""Z-buffer distances of two beginnings that differ by no more than this factor agree."""
_NEARER: Final = 0.9
"""Options are settled again if a fit by surfaces is nearer, by this factor, than what they were settled from before."""
_SOLVED: Final = 0.03
"""Z-buffer distance below which a fit by surfaces is not polished: pixels are not finer than that."""


@dataclass(frozen=True)
class Known:
    """What is known of the pose from model to normalized query space.

    Attributes:
        scale: of the pose; ``None`` if it is free.
        rotations: (R, 3, 3), the only ones to begin with; ``None`` for all.
        keeps_rotation: whether the rotation is exact.
    """

    scale: float | None = None
    rotations: Float[np.ndarray, "R 3 3"] | None = None
    keeps_rotation: bool = False


@dataclass(eq=False)
class Search:
    """One search over one query.

    Attributes:
        target: the query.
        models: what may rebuild it.
        known: of the pose of each model.
        report: told the share that is done and what is being done; may raise to stop.
        best: the best candidate so far of each phase and model (by its number).
        finished: phases that ran to their end.
        kept: candidates that were fitted with care, for alternatives.
        settled: the best fit by surfaces, if its model follows the query.
    """

    target: Target
    models: Sequence[FittedModel]
    known: Sequence[Known]
    report: Callable[[float, str], None]
    best: dict[tuple[Phase, int], Candidate] = field(default_factory=dict)
    finished: set[Phase] = field(default_factory=set)
    kept: list[Candidate] = field(default_factory=list)
    settled: Settled | None = None

    def run(self, rng: np.random.Generator) -> None:
        """Search; ``best`` is filled from the first moment on.

        Raises:
            EstimationError: no instance of the models has an area.
            Cancelled: ``report`` raised it.
        """
        self._message, self._fraction, self._rng = "first orientations", 0.0, rng
        self._nearest = np.inf
        with Pool(self._ask) as pool:
            self._pool = pool
            candidates = self._approached()
            if not candidates:
                raise EstimationError("no instance of the models has an area", where="models")
            begun, agrees = 1, False
            while not self._is_solved() and not agrees and begun < self._most_approaches():
                others = self._approached()
                agrees = _agrees(candidates, others)
                candidates = _sorted([*candidates, *others])
                begun += 1
            if self.settled is None:
                self._say(0.6, "options")
                leaders = spread(candidates, BRANCHED, 0, of_one_turn=1)
                self.kept += [one for one in candidates if one not in leaders]
                leaders = [self._branched(one, _CLOSER, outline_distance) for one in leaders]
                self._say(0.75, "dense fits")
                candidates = self._fitted(_sorted(leaders), _DENSE)
                candidates[0] = self._branched(candidates[0], _DENSE, fine_distance)
                self._settle(candidates[:1])
            self.finished.add("fit")
            if self.settled is None or self.settled.candidate.zbuffer > _SOLVED:
                self._say(0.85, "polish")
                if self.settled is not None:
                    candidates = [self.settled.candidate, *candidates]
                self._settle([self._polish(candidates[:POLISHED], candidates[POLISHED:])])
            self.finished.add("polish")

    # ------------------------------------------------------------------ phases

    def _approached(self) -> list[Candidate]:
        """Go from new random instances to close fits, the nearest first, and settle the nearest ones."""
        candidates = self._begin()
        if not candidates:
            return []
        self._say(0.15, "first fits")
        candidates = spread(self._fitted(candidates, _SIFT), SIFTED, SIFTED_OF_EACH)
        candidates = self._fitted(candidates, _FIRST)
        self._say(0.4, "closer fits")
        candidates = self._fitted(spread(_hopeful(candidates), PURSUED, PURSUED_OF_EACH), _CLOSER)
        self._say(0.5, "other poses")
        candidates = self._turned(candidates)
        self._say(0.55, "surfaces")
        self._settle(candidates[:SETTLED])
        return candidates

    def _most_approaches(self) -> int:
        if not any(len(model.compiled.base_values()) for model in self.models):
            return 1  # there are no other instances
        follows = self.settled is not None
        return APPROACHES if follows or len(self.models) == 1 else APPROACHES_OF_SEVERAL

    def _is_solved(self) -> bool:
        return self.settled is not None and self.settled.distance < _SURE

    def _begin(self) -> list[Candidate]:
        count = max(INSTANCES // 6, min(INSTANCES, 3 * INSTANCES // (2 * len(self.models))))
        rows = []
        for model in self.models:
            drawn = model.compiled.random_values(self._rng, count)
            if "start" not in self.finished:
                drawn[0] = model.settle(model.compiled.base_values())
            rows.append(drawn)
        tasks = list(zip(self.models, self.known, rows, strict=True))
        groups = self._pool.map(
            lambda task: find_starts(
                self.target,
                task[0],
                task[2],
                STARTS,
                known_rotations=task[1].rotations,
                known_scale=task[1].scale,
                keeps_rotation=task[1].keeps_rotation,
            ),
            tasks,
        )
        for group in groups:
            if group:
                self._keep("start", outline_distance(self.target, group[0]))
        everything = sorted((one for group in groups for one in group), key=lambda one: one.misfit)
        self.finished.add("start")
        return spread(everything, STARTS, STARTS_OF_EACH)

    def _fitted(self, candidates: Iterable[Candidate], effort: Effort) -> list[Candidate]:
        found = self._pool.map(lambda one: self._fit(one, effort), list(candidates))
        for one in found:
            self._keep("fit", one)
        return _sorted(found)

    def _fit(self, candidate: Candidate, effort: Effort) -> Candidate:
        known = self.known[self.models.index(candidate.model)]
        return fit(
            self.target,
            candidate,
            effort,
            keeps_scale=known.scale is not None,
            keeps_rotation=known.keeps_rotation,
            checkpoint=self._pool.check,
        )

    def _turned(self, candidates: list[Candidate]) -> list[Candidate]:
        """Try the poses that look like the best candidate's from afar."""
        if self.known[self.models.index(candidates[0].model)].rotations is not None:
            return candidates
        turned = self._fitted(other_poses(candidates[0], self.target), _FIRST)
        hopeful = [one for one in turned if one.zbuffer < 1.2 * candidates[0].zbuffer + 0.02]
        closer = self._fitted(hopeful, _CLOSER)
        self.kept += closer
        return _sorted([*candidates, *closer])

    def _settle(self, candidates: Sequence[Candidate]) -> None:
        """Settle the options by surfaces if the model of one of the candidates follows the query."""
        settling = Settling(self.target, self._fit, self._pool.map, self._rng)
        found = settling.fitted(candidates)
        for one in found:
            self._keep("fit", fine_distance(self.target, one.candidate))
        if not found or not found[0].follows:
            return
        nearest, self._nearest = self._nearest, min(self._nearest, found[0].distance)
        if self._is_solved():
            settled = settling.converged(found[0])
        elif found[0].distance < _NEARER * nearest:
            settled = settling.settle(found[0])
        else:
            settled = found[0]  # options were settled from a fit that was about as near
        if self.settled is None or settled.distance < self.settled.distance:
            self.settled = replace(settled, candidate=fine_distance(self.target, settled.candidate))
            self._keep("fit", self.settled.candidate)

    def _branched(
        self, candidate: Candidate, effort: Effort, measure: Callable[[Target, Candidate], Candidate]
    ) -> Candidate:
        """Change options for as long as another choice comes nearer; a change inherits all that it can."""
        candidate = measure(self.target, candidate)
        for _ in range(_BRANCHINGS):
            glances = _sorted(
                self._pool.map(lambda one: self._fit(one, _GLANCE), list(other_choices(candidate, self._rng)))
            )
            limit = 1.1 * candidate.zbuffer + 0.02
            hopeful = [one for one in glances if one.zbuffer < limit][:_CHILDREN]
            children = _sorted(self._pool.map(lambda one: measure(self.target, self._fit(one, effort)), hopeful))
            if not children or children[0].zbuffer >= candidate.zbuffer - _GAIN:
                self.kept += children
                return candidate
            self.kept.append(candidate)
            candidate = children[0]
            self._keep("fit", candidate)
        return candidate

    def _polish(self, candidates: Sequence[Candidate], others: Sequence[Candidate]) -> Candidate:
        limit = _WORTH_POLISHING * candidates[0].zbuffer
        polished = self._pool.map(self._polished, [one for one in candidates if one.zbuffer <= limit])
        self.kept += [*polished, *others]
        for one in polished:
            self._keep("polish", one)
        return _sorted(polished)[0]

    def _polished(self, candidate: Candidate) -> Candidate:
        known = self.known[self.models.index(candidate.model)]
        polish = Polish.begin(
            self.target,
            candidate,
            keeps_scale=known.scale is not None,
            keeps_rotation=known.keeps_rotation,
        )
        for _ in range(_ROUNDS):
            polish.round(self._pool.check)
            self._keep("polish", fine_distance(self.target, polish.best))
            if polish.gain < _ROUND_GAIN or polish.is_done:
                break
        return _sorted([fine_distance(self.target, polish.best), fine_distance(self.target, candidate)])[0]

    # ------------------------------------------------------------------ what is known so far

    def _keep(self, phase: Phase, candidate: Candidate) -> None:
        key = phase, self.models.index(candidate.model)
        best = self.best.get(key)
        if best is None or candidate.zbuffer < best.zbuffer:
            self.best[key] = candidate

    def _say(self, fraction: float, message: str) -> None:
        self._fraction, self._message = max(self._fraction, fraction), message
        self._ask()

    def _ask(self) -> None:
        distance = min((one.zbuffer for one in list(self.best.values())), default=None)
        known = "" if distance is None else f", z-buffer distance {distance:.4f}"
        self.report(self._fraction, self._message + known)


def _hopeful(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return those of some sorted candidates that are not much farther than the nearest one."""
    factor, more = _MUCH_FARTHER
    return [one for one in candidates if one.zbuffer <= factor * candidates[0].zbuffer + more]


def _agrees(candidates: Sequence[Candidate], others: Sequence[Candidate]) -> bool:
    """Whether two beginnings found fits of one model that are equally near: there is hardly a nearer one."""
    if not others or candidates[0].model is not others[0].model:
        return False
    distances = [candidates[0].zbuffer, others[0].zbuffer]
    return max(distances) <= _ALIKE * min(distances)


def _sorted(candidates: Iterable[Candidate]) -> list[Candidate]:
    return sorted(candidates, key=lambda one: one.zbuffer)
