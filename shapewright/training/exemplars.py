"""Exemplars of what a classifier learned from."""

from dataclasses import replace
from typing import Final

import numpy as np
from jaxtyping import Float, Float32, Int

from shapewright.classification.exemplars import Exemplars
from shapewright.distances.panorama import PanoramaDescriptor, panorama_distances
from shapewright.training.dataset import Plan, evenly
from shapewright.training.settings import TrainingSettings

USUAL: Final = 0.9
"""Share of the variations whose distances count as usual."""


def exemplars_of(plan: Plan, descriptors: Float[np.ndarray, "A D"], settings: TrainingSettings) -> Exemplars:
    """Return the exemplars of a plan's classes: their whole variations.

    Args:
        plan: the sources, and how many meshes each one gave.
        descriptors: of all objects of the plan, see :func:`shapewright.training.dataset.load_descriptors`.
        settings: of the training.
    """
    known = [share for share in plan.shares if share.label < len(plan.class_names)]
    digests = tuple(share.source.digest for share in known)
    counts = [share.count for share in known]
    every = Exemplars(
        class_names=plan.class_names,
        digests=digests,
        seed=settings.seed,
        subdivision_steps=settings.subdivision_steps,
        classes=np.repeat([share.label for share in known], counts),
        models=np.repeat(np.arange(len(known)), counts),
        numbers=np.concatenate([np.arange(count) for count in counts]),
        descriptors=descriptors[: sum(counts)],
    )
    whole = every.taken(np.flatnonzero(~np.concatenate([share.broken(settings) for share in known])))
    return whole if settings.exemplars_per_class == 0 else representatives(whole, settings.exemplars_per_class)


def representatives(exemplars: Exemplars, per_class: int) -> Exemplars:
    """Keep the exemplars that represent the others best.

    Args:
        exemplars: all of them.
        per_class: how many are kept of each class, shared by its models; at least one of each model.
    """
    kept = []
    for number in range(len(exemplars.class_names)):
        models = np.unique(exemplars.models[exemplars.classes == number])
        for model, count in zip(models, evenly(per_class, len(models)), strict=True):
            rows = np.flatnonzero(exemplars.models == model)
            kept.append(rows[np.sort(central_rows(exemplars.descriptors[rows], max(count, 1)))])
    return exemplars.taken(np.concatenate(kept))


def joined_exemplars(base: Exemplars, new: Exemplars) -> Exemplars:
    """Return the exemplars of both; the classes and models of ``new`` come after those of ``base``.

    Both must have the same seed and number of subdivision steps.
    """
    return replace(
        base,
        class_names=(*base.class_names, *new.class_names),
        digests=(*base.digests, *new.digests),
        classes=np.concatenate([base.classes, new.classes + len(base.class_names)]),
        models=np.concatenate([base.models, new.models + len(base.digests)]),
        numbers=np.concatenate([base.numbers, new.numbers]),
        descriptors=np.concatenate([base.descriptors, new.descriptors]),
    )


def usual_distances_of(exemplars: Exemplars, *, otherwise: float) -> list[float]:
    """Return the distance of each class within which nine of ten of its exemplars find another one.

    An exemplar is compared with those of other models of its class, if there are any.

    Args:
        exemplars: of the classes.
        otherwise: the distance of a class that has a single exemplar.
    """
    own = np.empty(len(exemplars))
    for row in range(len(exemplars)):
        distances = exemplars.distances(PanoramaDescriptor(exemplars.descriptors[row]))
        distances[row] = np.inf  # this is itself
        nearest, _ = exemplars.nearest(distances, without_model=int(exemplars.models[row]))
        own[row] = nearest[exemplars.classes[row]]
    classes = [own[exemplars.classes == number] for number in range(len(exemplars.class_names))]
    return [float(np.quantile(one, USUAL)) if np.isfinite(one).all() else otherwise for one in classes]


def central_rows(descriptors: Float32[np.ndarray, "M D"], count: int) -> Int[np.ndarray, " K"]:
    """Choose rows one by one, each the one that brings all rows nearest to a chosen one in the sum of distances."""
    if count >= len(descriptors):
        return np.arange(len(descriptors))
    distances = np.stack([panorama_distances(PanoramaDescriptor(row), descriptors) for row in descriptors])
    nearest = np.full(len(descriptors), np.inf)
    chosen: list[int] = []
    for _ in range(count):
        sums = np.minimum(distances, nearest).sum(axis=1)
        sums[chosen] = np.inf
        chosen.append(int(np.argmin(sums)))
        nearest = np.minimum(nearest, distances[chosen[-1]])
    return np.array(chosen)
