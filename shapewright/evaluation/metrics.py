"""Figures out of measured distances."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from shapewright.evaluation.coverage import Coverage, Neighbour


@dataclass(frozen=True)
class ClassCoverage:
    """How the variations of one class cover its meshes.

    Attributes:
        n: meshes of the class.
        own_median: median distance to the nearest variation of the own class.
        own_mean: mean of the same.
        own_maximum: of the worst covered mesh.
        medians: median distance to the nearest variation, by compared class.
        nearest_other_class: the other class with the smallest median; ``None`` if no other is compared.
        share_nearest: share of the meshes that are nearer to their own class than to any other.
        models: how many of the meshes are nearest to which model of the class.
    """

    n: int
    own_median: float
    own_mean: float
    own_maximum: float
    medians: dict[str, float]
    nearest_other_class: str | None
    share_nearest: float
    models: dict[str, int]

    @property
    def nearest_other_median(self) -> float | None:
        """Median distance to the nearest other class."""
        return None if self.nearest_other_class is None else self.medians[self.nearest_other_class]

    @property
    def own_is_nearest(self) -> bool:
        """Whether the median to the own class is smaller than that to any other."""
        other = self.nearest_other_median
        return other is None or self.own_median < other

    def to_dict(self) -> dict[str, Any]:
        """Figures ready for JSON; the medians of all classes are the matrix's."""
        return {
            "n": self.n,
            "own_median": self.own_median,
            "own_mean": self.own_mean,
            "own_maximum": self.own_maximum,
            "nearest_other_class": self.nearest_other_class,
            "nearest_other_median": self.nearest_other_median,
            "own_is_nearest": self.own_is_nearest,
            "share_nearest": self.share_nearest,
            "models": self.models,
        }


def coverage_of_classes(coverage: Coverage) -> dict[str, ClassCoverage]:
    """Sum up a measured coverage for each class that has meshes, in the order of names."""
    models = [
        (request.compiled.model.name, request.compiled.model.class_name) for request in coverage.requests.values()
    ]
    summed = {}
    for class_name in sorted({query.item.class_name for query in coverage.queries}):
        rows = [found for _, found in meshes_of(coverage, class_name)]
        own = np.array([found[class_name].distance for found in rows])
        medians = {name: float(np.median([found[name].distance for found in rows])) for name in sorted(rows[0])}
        others = [name for name in medians if name != class_name]
        used = Counter(found[class_name].model for found in rows)
        summed[class_name] = ClassCoverage(
            n=len(rows),
            own_median=medians[class_name],
            own_mean=float(own.mean()),
            own_maximum=float(own.max()),
            medians=medians,
            nearest_other_class=min(others, key=lambda name: medians[name]) if others else None,
            share_nearest=float(np.mean([nearest_class(found) == class_name for found in rows])),
            models={name: used[name] for name, its_class in models if its_class == class_name},
        )
    return summed


def meshes_of(coverage: Coverage, class_name: str) -> Sequence[tuple[int, "dict[str, Neighbour]"]]:
    """Index and neighbours of the meshes of a class, the worst covered first."""
    found = [
        (index, dict(neighbours))
        for index, (query, neighbours) in enumerate(zip(coverage.queries, coverage.neighbours, strict=True))
        if query.item.class_name == class_name
    ]
    return sorted(found, key=lambda entry: -entry[1][class_name].distance)


def nearest_class(neighbours: "dict[str, Neighbour]", but: str | None = None) -> str:
    """The class whose variation is nearest, one class left out if asked for."""
    return min((name for name in neighbours if name != but), key=lambda name: neighbours[name].distance)
