"""The factors that make 90 % intervals cover, fitted on synthetic queries and written as they ship.

Every query is an instance of known values, whole, with noise, with holes, decimated, or fitted with one option that is
wrong. The fit begins near the truth and ends as an answer of the fast estimator does: intervals hold for a given
structure, so the search for it has no part in them. A model's factor is drawn towards that of all models by as much as
its queries are few. Prints JSON: the factors, and by kind of query how many values of other queries they cover.
"""

import argparse
import json
import os
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np  # noqa: E402 - the number of threads is read when numpy loads
from scipy.spatial.transform import Rotation  # noqa: E402

from models_store.library.shipped import list_shipped, load_shipped  # noqa: E402
from shapewright.errors import ShapewrightError  # noqa: E402
from shapewright.estimation import EstimationSettings, Query  # noqa: E402
from shapewright.estimation.comparison import Comparison  # noqa: E402
from shapewright.estimation.determination.factors import IntervalFactors, conformal_factor, write_factors  # noqa: E402
from shapewright.estimation.fast.branches import other_choices  # noqa: E402
from shapewright.estimation.fast.candidate import Candidate  # noqa: E402
from shapewright.estimation.fast.fitted_model import FINE, FittedModel  # noqa: E402
from shapewright.estimation.fast.following import follow_surface  # noqa: E402
from shapewright.estimation.fast.judging import determine_fit  # noqa: E402
from shapewright.estimation.fast.least_squares import Effort, fit  # noqa: E402
from shapewright.estimation.fast.measure import fine_distance  # noqa: E402
from shapewright.estimation.fast.settling import Settling  # noqa: E402
from shapewright.estimation.fast.target import Target  # noqa: E402
from shapewright.estimation.prepared_query import PreparedQuery  # noqa: E402
from shapewright.evaluation.corruptions import CORRUPTIONS  # noqa: E402
from shapewright.evaluation.recovery import comparable  # noqa: E402
from shapewright.evaluation.synthetic import Truth, draw_query  # noqa: E402
from shapewright.in_processes import in_processes  # noqa: E402
from shapewright.modeling import CompiledModel, compile_model  # noqa: E402

KINDS: Final = ("clean", "noise", "clean", "holes", "clean", "decimated", "clean", "wrong option")
SEED: Final = 77_001
"""Differs from the seeds of evaluations, so that these measure what they have not seen."""
SHRINKAGE: Final = 4.0
"""Queries that the factor of all models counts for in the factor of one."""
_OFF, _TURNED_RAD, _SHIFTED, _GROWN = 0.1, 0.03, 0.02, 0.03
"""How far from the truth a fit begins: shares of the ranges, and of the pose (standard deviations)."""
_DENSE: Final = Effort(rounds=8, points=1200, steps=FINE, neighbors=4, damping=1e-4, outline=1000, outline_width=0.05)
_FITS: Final = 2


@dataclass(frozen=True)
class Task:
    """One query to draw and fit."""

    model: str
    number: int
    kind: str
    known_scale: bool


def scores(task: Task) -> list[float]:
    """Return by which factor each interval of one query would just hold the true value."""
    compiled = _compiled(task.model)
    drawn = draw_query(compiled, SEED, task.number, known_scale=task.known_scale)
    rng = np.random.default_rng([SEED, task.number, 3])
    corruption = CORRUPTIONS.get(task.kind)
    mesh = drawn.mesh if corruption is None else corruption(drawn.mesh, None, rng)
    settings = EstimationSettings()
    prepared = PreparedQuery(Query(mesh, units=drawn.units), settings)
    comparison = Comparison(prepared, compiled, settings)
    target = Target.of(prepared, settings)
    candidate = _near_truth(target, comparison, drawn.truth, task, rng)
    for _ in range(_FITS):
        candidate = fit(target, candidate, _DENSE, keeps_scale=task.known_scale)
    candidate = _ended(target, candidate, task.known_scale)
    found = determine_fit(target, candidate, scale_known=task.known_scale, factors=IntervalFactors(1.0))
    if found is None:
        return []
    counted = comparable(drawn.truth, candidate.values)
    columns = [column for column in found.columns if counted[column]]
    errors = np.abs(candidate.values - drawn.truth.values)[columns]
    return [float(score) for score in errors / found.half_widths[columns]]


def _ended(target: Target, candidate: Candidate, known_scale: bool) -> Candidate:
    """End a fit as a search does, but for the options, which stay."""
    settling = Settling(
        target,
        lambda one, effort: fit(target, one, effort, keeps_scale=known_scale),
        lambda work, candidates: [work(one) for one in candidates],
        np.random.default_rng(0),
    )
    settled = settling.fitted([candidate])[0]
    if settled.follows:
        return settling.converged(settled).candidate
    return follow_surface(target, fine_distance(target, candidate), keeps_scale=known_scale)


def _near_truth(
    target: Target, comparison: Comparison, truth: Truth, task: Task, rng: np.random.Generator
) -> Candidate:
    model = FittedModel(truth.compiled)
    pose = comparison.to_file.inverse().compose(truth.pose)
    off = np.where(model.is_option, 0.0, rng.uniform(-_OFF, _OFF, len(truth.values))) * model.widths
    turn = Rotation.from_rotvec(rng.normal(0.0, _TURNED_RAD, 3)).as_matrix()
    candidate = Candidate(
        model,
        model.settle(truth.values + off),
        turn @ pose.rotation,
        target.center + turn @ (pose.translation - target.center) + rng.normal(0.0, _SHIFTED, 3),
        pose.scale if task.known_scale else pose.scale * float(np.exp(rng.normal(0.0, _GROWN))),
    )
    wrong = list(other_choices(candidate, rng)) if task.kind == "wrong option" else []
    return wrong[int(rng.integers(len(wrong)))] if wrong else candidate


@lru_cache(maxsize=1)
def _compiled(name: str) -> CompiledModel:
    return compile_model(load_shipped(name))


def tasks(names: list[str], queries: int) -> Iterator[tuple[int, Task]]:
    """Yield the first query of every model, then the second; kinds and scales alternate."""
    for j in range(queries):
        for i, name in enumerate(names):
            known = (i + j // 2) % 2 == 0 and load_shipped(name).unit_m is not None
            number = j * len(names) + i
            yield number, Task(name, number, KINDS[(i + j) % len(KINDS)], known)


def read_scores(path: Path | None, waiting: dict[int, Task]) -> dict[int, tuple[Task, list[float]]]:
    """Return what an earlier run has written of the same queries."""
    if path is None or not path.exists():
        return {}
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    tasks_by_row = ((row, waiting.get(row["number"])) for row in rows)
    return {
        row["number"]: (task, row["scores"])
        for row, task in tasks_by_row
        if task is not None and asdict(task) == row["task"]
    }


def shrunken(names: list[str], by_query: dict[int, tuple[Task, list[float]]]) -> tuple[float, dict[str, float]]:
    """Return the factor of all models, and of each that has enough values."""
    everything = [score for _, found in by_query.values() for score in found]
    default = _factor(everything)
    factors = {}
    for name in names:
        mine = [found for task, found in by_query.values() if task.model == name and found]
        values = [score for found in mine for score in found]
        try:
            share = len(mine) / (len(mine) + SHRINKAGE)
            factors[name] = float(default ** (1.0 - share) * _factor(values) ** share)
        except ShapewrightError:
            continue  # too few values of its own: the default holds
    return default, factors


def _factor(values: list[float]) -> float:
    ones = np.ones(len(values))
    return max(conformal_factor(np.array(values), ones, ones), 1e-3)


def coverage(names: list[str], by_query: dict[int, tuple[Task, list[float]]]) -> dict[str, float]:
    """Return by kind of query the share that factors of the other half of the queries cover."""
    covered = defaultdict(list)
    for half in (0, 1):
        rest = {number: one for number, one in by_query.items() if number % 2 != half}
        default, factors = shrunken(names, rest)
        for number, (task, found) in by_query.items():
            if number % 2 == half:
                for kind in (task.kind, "all"):
                    covered[kind] += [score <= factors.get(task.model, default) for score in found]
    return {kind: round(float(np.mean(shares)), 3) for kind, shares in sorted(covered.items()) if shares}


def main() -> None:
    """Fit, print, and write if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--queries", type=int, default=4, help="of each model")
    parser.add_argument("--models", nargs="+", default=None, help="names; all that ship if left out")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--scores", type=Path, default=None, help="file of all scores, with which a later run goes on")
    parser.add_argument("-o", "--output", type=Path, default=None, help="file to write")
    options = parser.parse_args()
    names = sorted(options.models or list_shipped())
    waiting = dict(tasks(names, options.queries))
    by_query = read_scores(options.scores, waiting)
    left = [(number, task) for number, task in waiting.items() if number not in by_query]
    if options.jobs == 1:
        outcomes = ((number, scores(task)) for number, task in left)
    else:
        outcomes = in_processes(iter(left), scores, jobs=options.jobs, begin=_nothing, beat=_nothing)
    for number, found in outcomes:
        task = waiting[number]
        by_query[number] = (task, found)
        if options.scores is not None:
            with options.scores.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"number": number, "task": asdict(task), "scores": found}) + "\n")
        print(f"{len(by_query)} of {len(waiting)}", end="\r", file=sys.stderr)
    default, factors = shrunken(names, by_query)
    if options.output is not None:
        digests = {name: load_shipped(name).digest for name in factors}
        write_factors(options.output, default, {name: (digests[name], factor) for name, factor in factors.items()})
    figures = {"queries": len(by_query), "default": round(default, 4), "coverage": coverage(names, by_query)}
    print(json.dumps({**figures, "models": {name: round(factor, 4) for name, factor in factors.items()}}, indent=2))


def _nothing() -> None:
    """Children prepare nothing, and nobody is told between two queries."""


if __name__ == "__main__":
    main()
