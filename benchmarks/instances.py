"""Instances a second of every shipped model, on one core, as JSON.

``control_per_s`` and ``surface_per_s`` are for one batch (control mesh; after two subdivisions). The baseline is the
same work one instance at a time, measured in the same run: a ratio means more than a figure on a shared machine.
"""

import argparse
import json
import os
import resource
import time
from collections.abc import Callable

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np  # noqa: E402 - the number of threads is read when numpy loads

from models_store.library.shipped import list_shipped, load_shipped  # noqa: E402
from shapewright.modeling import compile_model  # noqa: E402


def best_seconds(work: Callable[[], object], repeats: int) -> float:
    """Return the shortest of several runs: the one least disturbed by others."""
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def measure(name: str, batch: int, repeats: int) -> dict[str, float]:
    """Measure one model."""
    start = time.perf_counter()
    compiled = compile_model(load_shipped(name))
    compiled.surface_polygons()
    compile_s = time.perf_counter() - start
    values = compiled.random_values(np.random.default_rng(0), batch)
    few = values[: max(1, batch // 20)]

    def all_surfaces() -> None:
        for _ in compiled.surface_chunks(values):
            pass

    control_s = best_seconds(lambda: compiled.control_points(values), repeats)
    surface_s = best_seconds(all_surfaces, repeats)
    control_each_s = best_seconds(lambda: [compiled.control_points(row[None]) for row in few], repeats) / len(few)
    surface_each_s = best_seconds(lambda: [compiled.surface_points(row[None]) for row in few], repeats) / len(few)
    return {
        "operations": len(compiled.model.operations),
        "parameters": compiled.n_parameters,
        "control_faces": len(compiled.control_faces),
        "surface_vertices": compiled.surface_polygons().n_vertices,
        "compile_s": round(compile_s, 4),
        "control_per_s": round(batch / control_s),
        "surface_per_s": round(batch / surface_s),
        "control_ratio_to_one_by_one": round(control_each_s * batch / control_s, 1),
        "surface_ratio_to_one_by_one": round(surface_each_s * batch / surface_s, 1),
    }


def main() -> None:
    """Print the figures of all models."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--batch", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--models", nargs="+", metavar="NAME", default=list(list_shipped()), help="default: all")
    arguments = parser.parse_args()
    models = {name: measure(name, arguments.batch, arguments.repeats) for name in arguments.models}
    peak_mib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"batch": arguments.batch, "models": models, "peak_memory_mib": round(peak_mib)}, indent=2))


if __name__ == "__main__":
    main()
