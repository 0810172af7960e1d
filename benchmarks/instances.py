"""Instances a second of shipped models, on one core, as JSON.

``control_per_s`` and ``surface_per_s`` are for one batch (control mesh; after two subdivisions), ``single_ms`` is one
control mesh alone; settling the values is included. The baseline of every ratio is the plain NumPy evaluation that the
tests compare with (``tests/literal_evaluation.py``), which prepares nothing, at the same values in the same run: a
ratio means more than a figure on a shared machine. Times are processor time, the least of several runs.
"""

import argparse
import json
import os
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[variable] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import numpy as np  # noqa: E402 - the number of threads is read when numpy loads
from literal_evaluation import literal_control_points  # noqa: E402

from models_store.library.shipped import list_shipped, load_shipped  # noqa: E402
from shapewright.modeling import compile_model  # noqa: E402

SMALL_BATCH = 64


def best_seconds(work: Callable[[], object], repeats: int, times: int = 1) -> float:
    """Return the shortest of several runs of some calls, for one call: the one least disturbed by others."""
    seconds = []
    for _ in range(repeats):
        start = time.process_time()
        for _ in range(times):
            work()
        seconds.append((time.process_time() - start) / times)
    return min(seconds)


def measure(name: str, batch: int, repeats: int) -> dict[str, float]:
    """Measure one model."""
    model = load_shipped(name)
    compile_s = best_seconds(lambda: compile_model(model), repeats)
    compiled = compile_model(model)
    values = compiled.random_values(np.random.default_rng(0), batch)
    some, one = values[:SMALL_BATCH], values[:1]
    compiled.surface_points(one)

    def all_surfaces() -> None:
        for _ in compiled.surface_chunks(values):
            pass

    control_per_s = batch / best_seconds(lambda: compiled.control_points(values), repeats)
    small_per_s = len(some) / best_seconds(lambda: compiled.control_points(some), repeats, 10)
    surface_per_s = batch / best_seconds(all_surfaces, repeats)
    single_s = best_seconds(lambda: compiled.control_points(one), repeats, 100)
    literal_per_s = batch / best_seconds(lambda: literal_control_points(model, values), 2)
    literal_single_s = best_seconds(lambda: literal_control_points(model, one), 3)
    return {
        "operations": len(model.operations),
        "parameters": compiled.n_parameters,
        "control_vertices": len(compiled.control_vertex_ids),
        "surface_vertices": compiled.surface_polygons().n_vertices,
        "compile_ms": round(1000 * compile_s, 1),
        "control_per_s": round(control_per_s),
        f"control_per_s_batch_of_{SMALL_BATCH}": round(small_per_s),
        "surface_per_s": round(surface_per_s),
        "single_ms": round(1000 * single_s, 4),
        "control_ratio_to_numpy": round(control_per_s / literal_per_s, 1),
        "single_ratio_to_numpy": round(literal_single_s / single_s, 1),
    }


def main() -> None:
    """Print the figures of the models."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--batch", type=int, default=1024)
    parser.add_argument("--repeats", type=int, default=7)
    named = ["glass_with_stem", "helicopter_attack"]
    parser.add_argument("--models", nargs="+", metavar="NAME", default=named, help=f"default: {' '.join(named)}")
    parser.add_argument("--all", action="store_true", help="every shipped model")
    arguments = parser.parse_args()
    names = list(list_shipped()) if arguments.all else arguments.models
    models = {name: measure(name, arguments.batch, arguments.repeats) for name in names}
    peak_mib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"batch": arguments.batch, "models": models, "peak_memory_mib": round(peak_mib)}, indent=2))


if __name__ == "__main__":
    main()
