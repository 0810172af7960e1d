"""Seconds of one estimation with the reference estimator, phase by phase, and how near it came.

Run ``.venv/bin/python benchmarks/estimation.py``; one JSON document goes to stdout. The query is a random instance
of the model itself, turned by one of the 24 rotations, scaled and shifted, unless ``--mesh`` names a file.
"""

import argparse
import json
import os
import platform
import sys
from pathlib import Path
from time import perf_counter

import numpy as np

from models_store.library.shipped import load_shipped
from shapewright.distances.alignment import Pose, rotations_24
from shapewright.estimation import EstimationSettings, estimate
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import load_mesh
from shapewright.modeling import CompiledModel, ProceduralModel, compile_model
from shapewright.progress import CallbackProgress


def synthetic_query(compiled: CompiledModel, seed: int) -> tuple[TriangleMesh, np.ndarray]:
    """An instance of known values in a pose that the 24 rotations reach."""
    rng = np.random.default_rng(seed)
    truth = compiled.random_values(rng, 1)[0]
    pose = Pose(rotations_24()[rng.integers(24)], rng.uniform(-5, 5, 3), float(rng.uniform(0.5, 20)))
    instance = compiled.instance(truth)
    return instance.transformed(pose.rotation, pose.translation, pose.scale), truth


class PhaseClock:
    """Seconds between the first report of each phase; the messages begin with the names of model and phase."""

    def __init__(self) -> None:
        self.begins: dict[str, float] = {}
        self.reports = 0

    def __call__(self, fraction: float, message: str) -> None:
        """Take a report."""
        self.reports += 1
        phase = message.split(": ")[1] if ": " in message else message
        self.begins.setdefault(phase, perf_counter())

    def seconds(self) -> dict[str, float]:
        """Seconds of each phase, up to now."""
        names, times = list(self.begins), [*self.begins.values(), perf_counter()]
        return {name: round(times[k + 1] - times[k], 3) for k, name in enumerate(names) if name != "estimated"}


def main() -> None:
    defaults = EstimationSettings()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", default="glass_with_stem", help="a shipped model, or a model.json")
    parser.add_argument("--mesh", type=Path, help="query; default: an instance of the model")
    parser.add_argument("--samples", type=int, default=defaults.samples)
    parser.add_argument("--surface-points", type=int, default=defaults.surface_points)
    parser.add_argument("--image-size", type=int, default=defaults.image_size)
    parser.add_argument("--steps", type=float, nargs="+", default=list(defaults.step_sizes))
    parser.add_argument("--quick", action="store_true", help="coarser settings; the options above do not count")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    path = Path(options.model)
    model = ProceduralModel.load(path) if path.suffix == ".json" else load_shipped(options.model)
    compiled = compile_model(model)
    truth = None
    if options.mesh is None:
        query, truth = synthetic_query(compiled, options.seed)
    else:
        query = load_mesh(options.mesh)
    settings = (
        EstimationSettings.quick(seed=options.seed)
        if options.quick
        else EstimationSettings(
            samples=options.samples,
            surface_points=options.surface_points,
            image_size=options.image_size,
            step_sizes=tuple(options.steps),
            seed=options.seed,
        )
    )
    warm = EstimationSettings(samples=1, surface_points=50, image_size=16, step_sizes=(1.0,))
    estimate(TriangleMesh(np.eye(3), np.array([[0, 1, 2]])), compiled, warm)  # kernels are compiled or loaded here
    clock = PhaseClock()
    start = perf_counter()
    estimation = estimate(query, compiled, settings, progress=CallbackProgress(clock))
    total = perf_counter() - start
    figures = {
        "machine": {"cpus": os.cpu_count(), "machine": platform.machine(), "load": os.getloadavg()[0]},
        "model": model.name,
        "parameters": compiled.n_parameters,
        "instance_vertices": len(estimation.mesh.vertices),
        "instance_triangles": len(estimation.mesh.faces),
        "query_triangles": len(query.faces),
        "settings": settings.to_dict(),
        "seconds": round(total, 3),
        "seconds_by_phase": clock.seconds(),
        "reports": clock.reports,
        "layer": estimation.layer,
        "distances": estimation.distances.to_dict(),
    }
    if truth is not None:
        ranges = compiled.maximum - compiled.minimum
        off = np.abs(estimation.values - truth) / ranges
        figures["largest_parameter_error_of_range"] = float(off.max(initial=0.0))
        figures["mean_parameter_error_of_range"] = float(off.mean()) if len(off) else 0.0
    json.dump(figures, sys.stdout, indent=2)
    print()


if __name__ == "__main__":
    main()
