"""Speed of the distances between meshes: panorama descriptors, the panorama scan, the surface distance and
the z-buffer distance.

Run ``.venv/bin/python benchmarks/distances.py``; one JSON document goes to stdout. A further distance adds a
function that returns its figures, and its line in ``BENCHMARKS``.
"""

import json
import os
import platform
from collections.abc import Callable
from time import perf_counter

import numba
import numpy as np
import trimesh

from shapewright.distances.panorama import (
    DESCRIPTOR_SIZE,
    PanoramaDescriptor,
    panorama_descriptor,
    panorama_descriptors,
    panorama_distances,
)
from shapewright.distances.rasterize import depth_views
from shapewright.distances.surface import SurfaceDistance, poisson_disk_points, surface_distance
from shapewright.distances.zbuffer import ZBufferTarget, zbuffer_distance
from shapewright.mesh import TriangleMesh


def sample_batch(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Ball-like meshes of about 1500 triangles, each stretched and dented in its own way."""
    ball = trimesh.creation.uv_sphere(count=[20, 20])
    rng = np.random.default_rng(0)
    vertices = np.array(ball.vertices) * rng.uniform(0.3, 1.5, (count, 1, 3))
    vertices += 0.1 * np.sin(vertices[:, :, [1, 2, 0]] * rng.uniform(2, 6, (count, 1, 3)))
    return vertices, np.array(ball.faces, dtype=np.int64)


def seconds(work: Callable[[], object], repeats: int) -> float:
    """Median of several runs, after one that compiles and fills caches."""
    work()
    times = []
    for _ in range(repeats):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return float(np.median(times))


def panorama() -> dict[str, float]:
    count = 200
    vertices, triangles = sample_batch(count)
    threads = numba.get_num_threads()
    per_second = {}
    for used in sorted({1, threads}):
        numba.set_num_threads(used)
        per_second[used] = count / seconds(lambda: panorama_descriptors(vertices, triangles), 3)
    one_by_one = count / seconds(lambda: [panorama_descriptor(item, triangles) for item in vertices], 2)
    bank = np.random.default_rng(0).random((10_000, DESCRIPTOR_SIZE), dtype=np.float32)
    query = PanoramaDescriptor(bank[0])
    return {
        "triangles": len(triangles),
        "threads": threads,
        "descriptors_per_second_one_thread": per_second[1],
        "descriptors_per_second_all_threads": per_second[threads],
        "descriptors_per_second_one_by_one_all_threads": one_by_one,
        "batched_over_one_by_one": per_second[threads] / one_by_one,
        "scan_of_10000_ms": 1e3 * seconds(lambda: panorama_distances(query, bank), 5),
    }


def surface() -> dict[str, float]:
    vertices, triangles = sample_batch(2)
    query, other = (TriangleMesh(item, triangles).normalized().mesh for item in vertices)
    rng = np.random.default_rng(0)
    sampling = seconds(lambda: poisson_disk_points(query, rng=rng), 5)
    points = poisson_disk_points(query, rng=rng)
    distance = SurfaceDistance(points)
    kept = seconds(lambda: distance(other.vertices), 30)
    plain = seconds(lambda: surface_distance(points, other.vertices), 30)

    def brute() -> float:
        table = np.linalg.norm(points[:, None] - other.vertices, axis=2)
        return float(np.concatenate([table.min(axis=0), table.min(axis=1)]).mean())

    return {
        "query_points": len(points),
        "model_vertices": len(other.vertices),
        "sampling_ms": 1e3 * sampling,
        "distance_ms": 1e3 * kept,
        "with_new_query_tree_over_kept": plain / kept,
        "brute_force_over_kept": seconds(brute, 3) / kept,
    }


def zbuffer() -> dict[str, float]:
    ball = trimesh.creation.icosphere(subdivisions=4)
    triangles = np.array(ball.faces, dtype=np.int64)
    query = np.array(ball.vertices) * (1.0, 0.8, 0.6)
    other = query * 1.1 + (0.05, 0.0, -0.05)
    target = ZBufferTarget(query, triangles)
    fused = seconds(lambda: target.distance(other, triangles), 30)
    views = seconds(lambda: depth_views(other, triangles), 30)
    drawn = depth_views(other, triangles)
    plain = seconds(lambda: zbuffer_distance(target.views, drawn), 10)
    return {
        "triangles": len(triangles),
        "image_size": target.views.shape[1],
        "distance_ms": 1e3 * fused,
        "depth_views_ms": 1e3 * views,
        "drawn_and_compared_apart_over_fused": (views + plain) / fused,
    }


BENCHMARKS = {"panorama": panorama, "surface": surface, "zbuffer": zbuffer}


def main() -> None:
    figures = {name: benchmark() for name, benchmark in BENCHMARKS.items()}
    machine = {"cpus": os.cpu_count(), "machine": platform.machine(), "python": platform.python_version()}
    print(json.dumps({"machine": machine, **figures}, indent=2))


if __name__ == "__main__":
    main()
