"""Where the queries of an evaluation come from: the meshes of a dataset, or synthetic ones; corrupted, if asked for."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from shapewright.errors import EvaluationError, MeshError
from shapewright.estimation.query import Query
from shapewright.evaluation.corruptions import Corruption
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each
from shapewright.evaluation.estimated import Case
from shapewright.evaluation.synthetic import draw_query
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel


@runtime_checkable
class Cases(Protocol):
    """Queries that can be gone through more than once; the same ones come each time."""

    def __len__(self) -> int:
        """Return how many there are, those that have to be skipped included."""

    def __call__(self, names: Collection[str] | None = None) -> Iterator[Case | Skipped]:
        """Read or draw the queries one after the other: all, or those of these names."""


@dataclass(frozen=True)
class Damage:
    """A corruption at one strength, the same for a query whenever it is read or drawn.

    Raises:
        EvaluationError: the corruption leaves no faces; an estimation needs them.
    """

    corruption: Corruption
    strength: float
    seed: int

    def __post_init__(self) -> None:
        if not self.corruption.has_faces:
            message = f"expected a corruption that leaves a mesh with faces, got {self.corruption.name!r}"
            raise EvaluationError(message, where="corruption")

    def __call__(self, mesh: TriangleMesh, number: int) -> TriangleMesh:
        """Corrupt the mesh of the query with this number."""
        damaged = self.corruption(mesh, self.strength, np.random.default_rng([self.seed, number, 2]))
        assert isinstance(damaged, TriangleMesh)  # it has faces
        return damaged


@dataclass(frozen=True)
class DatasetCases:
    """The meshes of a dataset, each with all models of its class.

    Attributes:
        items: the meshes.
        models: names of the models by class.
        damage: what is done to each mesh.
        jobs: meshes that are read at once.
    """

    items: Sequence[LabelledFile]
    models: Mapping[str, tuple[str, ...]]
    damage: Damage | None = None
    jobs: int = 1

    def __len__(self) -> int:
        return len(self.items)

    def __call__(self, names: Collection[str] | None = None) -> Iterator[Case | Skipped]:
        """Read the meshes, all or those of these files."""
        numbers = {item: number for number, item in enumerate(self.items) if names is None or item.file in names}
        for item, mesh in load_each(list(numbers), jobs=self.jobs):
            if isinstance(mesh, Skipped):
                yield mesh
                continue
            try:
                damaged = mesh if self.damage is None else self.damage(mesh, numbers[item])
            except MeshError as error:
                yield Skipped(item.file, error.message)
                continue
            yield Case(item.file, item.class_name, Query(damaged), self.models[item.class_name])


@dataclass(frozen=True)
class SyntheticCases:
    """Random instances of models.

    Attributes:
        chosen: the model of each query, as from :func:`shapewright.evaluation.synthetic.models_in_turn`.
        models: names of the models that are tried, by class; ``None`` tries the true one alone.
        seed: of all choices.
        known_scale: whether the queries say their unit.
        damage: what is done to each mesh.
    """

    chosen: Sequence[CompiledModel]
    models: Mapping[str, tuple[str, ...]] | None
    seed: int
    known_scale: bool = False
    damage: Damage | None = None

    def __len__(self) -> int:
        return len(self.chosen)

    def __call__(self, names: Collection[str] | None = None) -> Iterator[Case | Skipped]:
        """Draw the queries, all or those of these names."""
        for number, compiled in enumerate(self.chosen):
            model = compiled.model
            name = f"{model.name}-{number}"
            if names is not None and name not in names:
                continue
            drawn = draw_query(compiled, self.seed, number, known_scale=self.known_scale)
            try:
                mesh = drawn.mesh if self.damage is None else self.damage(drawn.mesh, number)
            except MeshError as error:
                yield Skipped(name, error.message)
                continue
            tried = (model.name,) if self.models is None else self.models[model.class_name]
            yield Case(name, model.class_name, Query(mesh, units=drawn.units), tried, drawn.truth)
