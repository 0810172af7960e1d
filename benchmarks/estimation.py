"""Processor seconds and distances of the fast estimator against the reference, on the same queries.

Run ``.venv/bin/python benchmarks/estimation.py``; one JSON document goes to stdout. The queries are synthetic: random
instances of shipped models in any pose, with a surface that is cut anew; the models that are tried are all of the
class, or with ``--model-known`` the true one. ``--mesh FILE --models NAME ...`` estimates a file instead.

Both estimators get the same seed and the same banks of random instances, which are built before the clock starts.
Kernels are compiled by an estimation that is not counted. ``--reference none`` leaves the reference out, which takes
minutes a query with the paper's settings.
"""

import argparse
import json
import os
import platform
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np

from models_store.library.shipped import list_classes, load_shipped
from shapewright.distances.alignment import AlignmentSettings
from shapewright.estimation import EstimationSettings, PanoramaBank, Query, build_bank_for, estimate
from shapewright.estimation.generator import InstanceGenerator
from shapewright.evaluation.synthetic import Truth, draw_query
from shapewright.mesh.file import load_mesh
from shapewright.modeling import CompiledModel, compile_model
from shapewright.progress import NULL_PROGRESS, CallbackProgress, Progress

DEFAULT_MODELS = ("table", "glass_with_stem_goblet", "sword_dagger")
NO_WORSE = 1e-3
REFERENCES = {"paper": EstimationSettings(estimator="reference"), "quick": EstimationSettings.quick()}


@dataclass(frozen=True)
class Asked:
    """A query, the models that are tried, and what it was made of."""

    name: str
    query: Query
    models: Sequence[CompiledModel]
    truth: Truth | None


class PhaseClock:
    """Seconds from the first report of each phase to the next one's; messages begin with the phase's name."""

    def __init__(self) -> None:
        self._begins: dict[str, float] = {}

    def __call__(self, fraction: float, message: str) -> None:
        """Take a report."""
        self._begins.setdefault(message.rpartition(":")[0] or message, perf_counter())

    def seconds(self) -> dict[str, float]:
        """Return the seconds of each phase up to now."""
        names, times = list(self._begins), [*self._begins.values(), perf_counter()]
        return {name: round(times[k + 1] - times[k], 3) for k, name in enumerate(names)}


class Banks:
    """Random instances, built once for a model and the settings that they depend on."""

    def __init__(self) -> None:
        self._kept: dict[tuple[str, int, int, int], PanoramaBank] = {}

    def of(self, generator: InstanceGenerator, settings: EstimationSettings) -> PanoramaBank:
        """Return a bank that these settings scan."""
        key = (generator.model.digest, settings.samples, settings.seed, settings.subdivision_steps)
        if key not in self._kept:
            self._kept[key] = build_bank_for(generator, settings)
        return self._kept[key]


def measured(asked: Asked, settings: EstimationSettings, banks: Banks) -> dict[str, Any]:
    """Estimate one query and return its figures."""
    if settings.estimator == "reference":
        for model in asked.models:
            banks.of(model, settings)

    def bank(generator: InstanceGenerator, progress: Progress) -> PanoramaBank:
        return banks.of(generator, settings)

    clock = PhaseClock()
    began, processor_began = perf_counter(), process_time()
    found = estimate(asked.query, asked.models, settings, progress=CallbackProgress(clock), banks=bank)
    figures: dict[str, Any] = {
        "seconds": round(perf_counter() - began, 3),
        "processor_seconds": round(process_time() - processor_began, 3),
        "model": found.model.name,
        "layer": found.layer,
        **found.distances.to_dict(),
        "seconds_by_phase": clock.seconds(),
    }
    if asked.truth is not None and found.model.name == asked.truth.compiled.model.name:
        compiled, active = asked.truth.compiled, asked.truth.active
        off = np.abs(found.values - asked.truth.values) / (compiled.maximum - compiled.minimum)
        figures["mean_error_of_range"] = float(off[active].mean()) if active.any() else 0.0
    return figures


def ratios(rows: Sequence[Mapping[str, Any]], reference: str) -> dict[str, Any] | None:
    """Compare the fast estimator with a reference, query by query."""
    pairs = [(row["fast"], row[reference]) for row in rows if "fast" in row and reference in row]
    if not pairs:
        return None
    seconds = [slow["processor_seconds"] / max(fast["processor_seconds"], 1e-3) for fast, slow in pairs]
    distances = [fast["zbuffer"] / max(slow["zbuffer"], 1e-6) for fast, slow in pairs]
    return {
        "queries": len(pairs),
        "times_fewer_processor_seconds_median": float(np.median(seconds)),
        "times_fewer_processor_seconds_least": min(seconds),
        "zbuffer_ratio_median": float(np.median(distances)),
        "zbuffer_ratio_largest": max(distances),
        "zbuffer_no_worse": sum(fast["zbuffer"] <= slow["zbuffer"] + NO_WORSE for fast, slow in pairs),
    }


def queries(options: argparse.Namespace) -> list[Asked]:
    if options.mesh is not None:
        models = [compile_model(load_shipped(name)) for name in options.models]
        return [Asked(options.mesh.name, Query(load_mesh(options.mesh)), models, None)]
    asked = []
    for number, name in enumerate([name for name in options.models for _ in range(options.queries)]):
        model = load_shipped(name)
        tried = [name] if options.model_known else list_classes()[model.class_name]
        models = {one: compile_model(load_shipped(one)) for one in tried}
        drawn = draw_query(models[name], options.seed, number)
        asked.append(Asked(f"{name}-{number}", Query(drawn.mesh), list(models.values()), drawn.truth))
    return asked


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", nargs="+", default=list(DEFAULT_MODELS), help="shipped models")
    parser.add_argument("--queries", type=int, default=2, help="synthetic queries of each model")
    parser.add_argument("--mesh", type=Path, help="estimate this file with the models instead")
    parser.add_argument("--model-known", action="store_true", help="try the true model alone")
    parser.add_argument("--reference", choices=["none", *REFERENCES], nargs="+", default=["quick"])
    parser.add_argument("--no-fast", action="store_true", help="leave the fast estimator out")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    chosen = {name: replace(REFERENCES[name], seed=options.seed) for name in options.reference if name != "none"}
    if not options.no_fast:
        chosen = {"fast": EstimationSettings.from_dict({"estimator": "fast", "seed": options.seed}), **chosen}
    asked = queries(options)
    banks = Banks()
    for settings in chosen.values():
        warm(settings)
    rows = []
    for one in asked:
        rows.append({"query": one.name, **{name: measured(one, settings, banks) for name, settings in chosen.items()}})
        print(f"{len(rows)} of {len(asked)} queries", file=sys.stderr, flush=True)
    document = {
        "machine": {"cpus": os.cpu_count(), "machine": platform.machine(), "load": os.getloadavg()[0]},
        "seed": options.seed,
        "settings": {name: settings.to_dict() for name, settings in chosen.items()},
        "queries": rows,
        "against_reference": {name: ratios(rows, name) for name in chosen if name != "fast"},
    }
    json.dump(document, sys.stdout, indent=2)
    print()


def warm(settings: EstimationSettings) -> None:
    """Compile or load the kernels: estimate a stool with its own base, as coarsely as can be."""
    stool = compile_model(load_shipped("stool"))
    coarse = replace(
        settings,
        samples=1,
        surface_points=50,
        image_size=16,
        subdivision_steps=0,
        step_sizes=(1.0,),
        alignment=AlignmentSettings(0.5, 0.7, 0.4),
    )
    estimate(stool.instance(stool.base_values()), stool, coarse, progress=NULL_PROGRESS)


if __name__ == "__main__":
    main()
