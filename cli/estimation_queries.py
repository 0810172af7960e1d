"""What `shapewright evaluate estimation` estimates, and with which models: a dataset's meshes, or synthetic queries."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cli.sources import load_all_compiled
from models_store.library.shipped import list_classes
from shapewright.errors import EvaluationError

if TYPE_CHECKING:
    from shapewright.evaluation.estimation_cases import Cases, Damage
    from shapewright.modeling import CompiledModel


@dataclass(frozen=True)
class Queries:
    """What is estimated, with which models, and what it is called."""

    title: str
    cases: "Cases"
    models: "Mapping[str, CompiledModel]"


def dataset_queries(
    folder: Path, limit: int | None, classes: list[str] | None, damage: "Damage | None", jobs: int
) -> Queries:
    """Take the meshes of a dataset whose classes ship, each with all models of its class.

    Raises:
        EvaluationError: no such dataset, a class that does not ship, or no mesh of one that does.
    """
    from shapewright.evaluation.datasets import of_classes, read_dataset, spread
    from shapewright.evaluation.estimation_cases import DatasetCases

    items = of_classes(read_dataset(folder), _shipped(classes))
    if not items:
        raise EvaluationError("no mesh of the dataset has one of the classes that ship", where="--classes")
    items = spread(items, limit)
    by_class = {name: tuple(list_classes()[name]) for name in {item.class_name for item in items}}
    return Queries(folder.resolve().name, DatasetCases(items, by_class, damage, jobs), _compiled(by_class))


def synthetic_queries(
    count: int, classes: list[str] | None, damage: "Damage | None", seed: int, known_scale: bool, model_known: bool
) -> Queries:
    """Draw random instances of all shipped models in turn, or of those of some classes.

    Raises:
        EvaluationError: a class that does not ship.
    """
    from shapewright.evaluation.estimation_cases import SyntheticCases
    from shapewright.evaluation.synthetic import models_in_turn

    by_class = {name: tuple(list_classes()[name]) for name in _shipped(classes)}
    models = _compiled(by_class)
    chosen = models_in_turn(list(models.values()), count, seed)
    cases = SyntheticCases(chosen, None if model_known else by_class, seed, known_scale, damage)
    return Queries(f"{count} synthetic queries", cases, models)


def _shipped(classes: list[str] | None) -> list[str]:
    """Return the classes that are asked for, or all; raise EvaluationError for one that does not ship."""
    known = list_classes()
    for name in classes or []:
        if name not in known:
            raise EvaluationError(f"no model of class {name!r} ships (of these: {', '.join(known)})", where="--classes")
    return [name for name in known if classes is None or name in classes]


def _compiled(by_class: Mapping[str, Sequence[str]]) -> "dict[str, CompiledModel]":
    names = [name for members in by_class.values() for name in members]
    return {compiled.model.name: compiled for compiled in load_all_compiled(names)} if names else {}
