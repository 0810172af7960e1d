"""Compiled models, kept in memory while they are in use."""

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from shapewright.errors import MeshError, ModelError
from shapewright.mesh.glb import GlbWriter
from shapewright.modeling import CompiledModel, ProceduralModel, compile_model

_LARGEST: Final = np.finfo(np.float32).max
"""GLB files hold float32."""


class InstanceWriter:
    """Writes the instances of one model as GLB; may be used by several threads."""

    def __init__(self, model: ProceduralModel, max_corners: int) -> None:
        """Compile the model.

        Args:
            model: what to compile.
            max_corners: most face corners of a surface.

        Raises:
            ModelError: the model cannot be compiled.
        """
        self.compiled: CompiledModel = compile_model(model)
        self._corners = sum(map(len, self.compiled.control_faces))
        self._max_corners = max_corners

    def values(self, named: Mapping[str, float], seed: int | None) -> dict[str, float]:
        """The x of every parameter: given by name, else random if there is a seed, else 1; settled.

        Raises:
            ParameterError: an unknown name, a value out of its range, or no option.
        """
        if seed is None:
            row = self.compiled.values_from_mapping(named)
        else:
            row = self.compiled.random_values(np.random.default_rng(seed), 1, named)[0]
        return dict(zip(self.compiled.space.columns, row.tolist(), strict=True))

    def glb(self, values: Mapping[str, float], steps: int) -> bytes:
        """The instance of these values after ``steps`` subdivisions.

        Raises:
            ModelError: the surface would be too fine, or is not finite.
        """
        self._check_size(steps)
        try:
            instance = self.compiled.instance(np.array(list(values.values()), dtype=np.float64), steps)
        except MeshError:
            instance = None
        if instance is None or not np.abs(instance.vertices).max() <= _LARGEST:
            raise ModelError("with these values the surface is not finite", where="values")
        return GlbWriter(instance.faces).write(instance.vertices)

    def check_base_instance(self) -> None:
        """Generate the base model once.

        Raises:
            ModelError: it is too fine, not finite, or has no extent.
        """
        self._check_size(2)
        points = self.compiled.surface_points(self.compiled.base_values()[None], 2)[0]
        if not np.isfinite(points.astype(np.float32)).all():
            raise ModelError("the base model is not finite", where="operations")
        if not np.ptp(points, axis=0).max() > 0:
            raise ModelError("the base model has no extent", where="operations")

    def _check_size(self, steps: int) -> None:
        corners = self._corners * 4 ** max(steps - 1, 0)
        if corners > self._max_corners:
            raise ModelError(
                f"{steps} subdivisions make about {corners} face corners; {self._max_corners} are the most",
                where="subdivision_steps",
            )


class CompiledModels:
    """The generators that were used last, by model id."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._kept: OrderedDict[str, InstanceWriter] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, model_id: str, make: Callable[[], InstanceWriter]) -> InstanceWriter:
        """The generator of a model; ``make`` is called if it is not kept."""
        with self._lock:
            if model_id in self._kept:
                self._kept.move_to_end(model_id)
                return self._kept[model_id]
        generator = make()  # outside the lock: compiling a large model must not hold up the others
        self.keep(model_id, generator)
        return generator

    def keep(self, model_id: str, generator: InstanceWriter) -> None:
        """Keep a generator, in place of the one that was not used for longest."""
        with self._lock:
            self._kept[model_id] = generator
            self._kept.move_to_end(model_id)
            while len(self._kept) > self._size:
                self._kept.popitem(last=False)
