"""Compile what an estimation runs before the first query comes: ``python -m shapewright.estimation.fast.warm_up``.

Kernels are compiled when they are first called, which takes about a minute of one processor, and kept in numba's cache
(``NUMBA_CACHE_DIR``, or ``__pycache__`` beside the code) for processors of the same kind.
"""

from typing import Final

import numpy as np

from shapewright.estimation.estimating import estimate
from shapewright.estimation.settings import EstimationSettings
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, Recorder, compile_model, group, when

_SMALL: Final = EstimationSettings(image_size=32, surface_points=50)


def warm_up() -> None:
    """Estimate two small meshes: one that its model follows, and one that it does not."""
    model = _post()
    mesh = model.instance(model.values_from_mapping({"height": 1.3, "board": 1}))
    estimate(mesh, model, _SMALL)
    vertices = mesh.vertices.copy()
    vertices[:, 0] += np.sin(3.0 * vertices[:, 2])
    estimate(TriangleMesh(vertices, mesh.faces), model, _SMALL)


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
