"""What a classifier learns from: which sources give how many meshes, and the stored features of all of them."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.classification.evidence import OTHER, UNKNOWN
from shapewright.errors import ClassifierError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.network.backbone import Backbone
from shapewright.training.array_store import ArrayStore
from shapewright.training.chunks import Chunk, chunks_of, descriptors_key, features_key
from shapewright.training.settings import TrainingSettings
from shapewright.training.sources import (
    AssemblySource,
    DistortedSource,
    MixedSource,
    ModelSource,
    Source,
)

OTHERS: Final = 8
"""Fewer models of no class share the objects as so many would: a model that comes or goes changes no other's."""
TRIALS_SHARE: Final = 0.01
"""Distorted objects of each class, and mixed ones of each two classes, as a share of the objects of no class."""


@dataclass(frozen=True)
class Share:
    """What one source gives.

    Args:
        source: where the meshes come from.
        label: class number; the number of classes for objects that are of none.
        count: meshes.
        described: whether panorama descriptors are wanted, too.
        learned: whether the last layer learns from them, or they only try it.
    """

    source: Source
    label: int
    count: int
    described: bool
    learned: bool = True

    @property
    def chunks(self) -> list[Chunk]:
        """The share as units of work."""
        return chunks_of(self.source, self.count)

    def broken(self, settings: TrainingSettings) -> Bool[np.ndarray, " M"]:
        """Which of the meshes are broken."""
        return np.concatenate([chunk.broken(settings) for chunk in self.chunks])


@dataclass(frozen=True)
class Plan:
    """All that a training draws.

    Args:
        class_names: in the order of their numbers.
        shares: by class, then objects of no class.
    """

    class_names: tuple[str, ...]
    shares: tuple[Share, ...]

    @property
    def chunks(self) -> list[tuple[Chunk, bool]]:
        """Every unit of work, and whether it wants descriptors."""
        return [(chunk, share.described) for share in self.shares for chunk in share.chunks]


def plan_learning(
    classes: Mapping[str, Sequence[InstanceGenerator]],
    negatives: Sequence[InstanceGenerator],
    settings: TrainingSettings,
) -> Plan:
    """Share out the meshes of each class among its models, and add objects of no class.

    Args:
        classes: compiled models of each class.
        negatives: compiled models of things that are none of the classes.
        settings: how many.

    What a class needs does not depend on the others, but for the objects that are mixed with its neighbour in the
    order of names: a class that comes or changes is all that has to be drawn.

    Raises:
        ClassifierError: fewer than two classes, a class without models, with more models than variations, or with a
            reserved name; a model that comes twice.
    """
    if len(classes) < 2:
        raise ClassifierError("a classifier tells at least two classes apart", where="classes")
    for name, generators in classes.items():
        if name in (UNKNOWN, OTHER):
            raise ClassifierError("this word stands for what is of no class", where=f"classes.{name}")
        if not generators:
            raise ClassifierError("the class has no models", where=f"classes.{name}")
        if len(generators) > settings.variations:
            raise ClassifierError("the class has more models than variations", where=f"classes.{name}")
    twice = [digest for digest, count in Counter(_digests([*classes.values(), negatives])).items() if count > 1]
    if twice:
        raise ClassifierError("a model comes twice", where=f"model {twice[0]}")
    described = settings.exemplars and settings.vary
    shares = [
        Share(ModelSource(generator, settings.vary), number, count, described)
        for number, generators in enumerate(classes.values())
        for generator, count in zip(generators, evenly(settings.variations, len(generators)), strict=True)
    ]
    none, amount = len(classes), settings.negatives
    if amount:
        others = list(negatives)[:amount]
        count = max(1, amount // max(len(others), OTHERS))
        shares += [Share(ModelSource(generator), none, count, described) for generator in others]
        shares.append(Share(AssemblySource(), none, amount, described))
        trials = max(1, round(amount * TRIALS_SHARE))
        shares += [Share(source, none, trials, described, learned=False) for source in _trial_sources(classes)]
    return Plan(tuple(classes), tuple(shares))


def _trial_sources(classes: Mapping[str, Sequence[InstanceGenerator]]) -> list[Source]:
    """Objects that are nearly of a class, in an order that does not depend on how the classes came."""
    known = [tuple(sorted(classes[name], key=lambda one: one.model.digest)) for name in sorted(classes)]
    return [*map(DistortedSource, known), *(MixedSource(first, second) for first, second in pairwise(known))]


def _digests(groups: Iterable[Sequence[InstanceGenerator]]) -> list[str]:
    return [generator.model.digest for generators in groups for generator in generators]


def evenly(total: int, parts: int) -> list[int]:
    """Whole numbers that differ by one at most and add up to ``total``."""
    return [total // parts + (index < total % parts) for index in range(parts)]


@dataclass(frozen=True, eq=False)
class FeatureSet:
    """Features of all learning pictures, the pictures of a mesh together.

    Args:
        features: one row a picture, as they are stored (half precision).
        views: pictures of each mesh.
        labels: class number of each mesh; ``class_count`` for objects of no class.
        sources: number of the share that each mesh belongs to.
        learned: whether the last layer learns from each mesh (before some are held out).
        held_out: whether each mesh is kept for early stopping and calibration.
        class_count: number of classes.
    """

    features: Float[np.ndarray, "N D"]
    views: int
    labels: Int[np.ndarray, " M"]
    sources: Int[np.ndarray, " M"]
    learned: Bool[np.ndarray, " M"]
    held_out: Bool[np.ndarray, " M"]
    class_count: int

    def rows(self, meshes: Bool[np.ndarray, " M"]) -> Int[np.ndarray, " K"]:
        """The rows of ``features`` that show these meshes."""
        return (np.flatnonzero(meshes)[:, None] * self.views + np.arange(self.views)).reshape(-1)

    def row_labels(self, rows: Int[np.ndarray, " K"]) -> Int[np.ndarray, " K"]:
        """The labels of rows of ``features``."""
        return self.labels[rows // self.views]


def load_features(plan: Plan, settings: TrainingSettings, backbone: Backbone, store: ArrayStore) -> FeatureSet:
    """Join the stored features of a plan and choose the held-out meshes, by the seed and for each class alone.

    Raises:
        ClassifierError: a chunk is not stored.
    """
    parts, labels, sources, learned = [], [], [], []
    for number, share in enumerate(plan.shares):
        parts += [_stored(store, features_key(chunk, settings, backbone)) for chunk in share.chunks]
        labels.append(np.full(share.count, share.label))
        sources.append(np.full(share.count, number))
        learned.append(np.full(share.count, share.learned))
    feature_count, views = parts[0].shape[2], parts[0].shape[1]
    features = np.empty((sum(len(part) for part in parts), views, feature_count), dtype=np.float16)
    start = 0
    for part in parts:
        features[start : start + len(part)] = part
        start += len(part)
    label, is_learned = np.concatenate(labels), np.concatenate(learned)
    return FeatureSet(
        features=features.reshape(-1, feature_count),
        views=views,
        labels=label,
        sources=np.concatenate(sources),
        learned=is_learned,
        held_out=_held_out(np.where(is_learned, label, -1), settings),
        class_count=len(plan.class_names),
    )


def _held_out(labels: Int[np.ndarray, " M"], settings: TrainingSettings) -> Bool[np.ndarray, " M"]:
    """Choose meshes of each label for itself; negative labels give none."""
    mask = np.zeros(len(labels), dtype=bool)
    for label in np.unique(labels[labels >= 0]):
        meshes = np.flatnonzero(labels == label)
        count = min(max(1, round(len(meshes) * settings.held_out)), len(meshes) - 1)
        mask[np.random.default_rng([settings.seed, int(label)]).choice(meshes, size=count, replace=False)] = True
    return mask


def load_descriptors(plan: Plan, settings: TrainingSettings, store: ArrayStore) -> Float[np.ndarray, "M D"]:
    """Join the stored panorama descriptors of a plan, one row an object.

    Raises:
        ClassifierError: a chunk is not stored.
    """
    chunks = [chunk for share in plan.shares for chunk in share.chunks]
    return np.concatenate([_stored(store, descriptors_key(chunk, settings)) for chunk in chunks])


def _stored(store: ArrayStore, key: str) -> np.ndarray:
    found = store.get(key)
    if found is None:
        raise ClassifierError("an array that the training needs is not stored", where=key)
    return found
