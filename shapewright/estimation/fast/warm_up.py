"""Compile what an estimation runs before the first query comes: ``python -m shapewright.estimation.fast.warm_up``.

Kernels are compiled when they are first called, which takes about a minute of one processor, and kept in numba's cache
(``NUMBA_CACHE_DIR``, or ``__pycache__`` beside the code) for processors of the same kind. A later process loads each
kernel from there when it first calls it; ``load_kernels`` does so at once.
"""

from typing import Final

import numpy as np

from shapewright.estimation.fast.estimator import FastEstimator
from shapewright.estimation.query import Query
from shapewright.estimation.sampling_kernels import sample_surface
from shapewright.estimation.settings import EstimationSettings
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, Recorder, compile_model, group, when
from shapewright.progress import NULL_PROGRESS

_SMALL: Final = EstimationSettings(image_size=32, surface_points=50)


def warm_up() -> None:
    """Estimate two small meshes: one that its model follows, and one that it does not."""
    model = _post()
    mesh = _instance(model)
    _estimate(mesh, model)
    vertices = mesh.vertices.copy()
    vertices[:, 0] += np.sin(3.0 * vertices[:, 2])
    _estimate(TriangleMesh(vertices, mesh.faces), model)


def load_kernels() -> bool:
    """Load the compiled kernels into this process by estimating one small mesh, in about a second.

    Returns:
        Whether they are loaded. If the cache lacks the first kernel, the others are left for the first estimation to
        compile: nobody may ever need them.
    """
    sample_surface(np.eye(3), np.array([[0, 1, 2]]), 10, 0.5)
    if sample_surface.stats.cache_misses:
        return False
    model = _post()
    _estimate(_instance(model), model)
    return True


def _estimate(mesh: TriangleMesh, model: CompiledModel) -> None:
    FastEstimator().estimate(Query(mesh), [model], _SMALL, NULL_PROGRESS)


def _instance(model: CompiledModel) -> TriangleMesh:
    return model.instance(model.values_from_mapping({"height": 1.3, "board": 1}))


def _post() -> CompiledModel:
    """Return a post with a board that may be absent."""
    recorder = Recorder("post", "post")
    recorder.parameter("height", "Height", 0.5, 2.0)
    recorder.switch("board", "Board")
    post = recorder.box(0.5, 0.4, 2.0)
    board = recorder.box(0.2, 1.2, 0.5, offset=(0.2, 0.1, 0.6))
    recorder.scale(group(post.whole, frame="world"), 1.0, "z", size="height")
    recorder.part("board", [board], [when("board", 1)])
    return compile_model(recorder.build())


if __name__ == "__main__":
    warm_up()
