"""Learning pictures of procedural models and their features, block by block (paper section 3.2).

Every block of :data:`BLOCK` variations has its own random stream, named by the seed, the model's digest and the
number of the block. So a class's features do not depend on the other classes, on their order, or on who computes
which block, and a longer series begins with the shorter one.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from shapewright.classification.features import FeatureExtractor
from shapewright.classification.settings import TrainingSettings
from shapewright.errors import ClassifierError
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering.images import render_images
from shapewright.rendering.views import random_views

BLOCK = 16
"""Variations that are evaluated, drawn and described together; bounds the memory."""


@runtime_checkable
class _Described(Protocol):
    @property
    def name(self) -> str: ...

    @property
    def digest(self) -> str: ...


@runtime_checkable
class InstanceGenerator(Protocol):
    """What learning needs of a compiled procedural model; :class:`shapewright.modeling.CompiledModel` is one."""

    @property
    def model(self) -> _Described:
        """The model: its name and the digest of its document."""
        ...

    def random_values(self, rng: np.random.Generator, count: int) -> Float[np.ndarray, "B P"]:
        """Parameter values drawn uniformly within their ranges, what is not active left at the base."""
        ...

    def instances(self, values: Float[np.ndarray, "B P"], steps: int = 2) -> Iterator[TriangleMesh]:
        """The subdivided surface of each row, without the parts that it lacks."""
        ...


@dataclass(frozen=True, eq=False)
class FeatureSet:
    """Features of all learning pictures.

    Args:
        features: one row a picture, the pictures of a variation together.
        labels: class number of each picture.
        variations: number of the variation each picture shows, counted through all classes.
        held_out: whether a picture's variation is held out.
    """

    features: Float[np.ndarray, "N D"]
    labels: Int[np.ndarray, " N"]
    variations: Int[np.ndarray, " N"]
    held_out: Bool[np.ndarray, " N"]


def variation_images(
    generator: InstanceGenerator, block: int, count: int, settings: TrainingSettings
) -> UInt8[np.ndarray, "N H W 3"]:
    """Pictures of the first ``count`` (at most :data:`BLOCK`) variations of a block.

    Returns:
        count * images_per_variation pictures, those of one variation together.

    Raises:
        RenderingError: no headless OpenGL.
    """
    digest = int.from_bytes(bytes.fromhex(generator.model.digest)[:8], "big")
    rng = np.random.default_rng([settings.seed, digest, block])
    values = generator.random_values(rng, BLOCK)[:count]
    views = settings.images_per_variation
    rotations, scales = random_views(rng, BLOCK * views, scale_range=settings.scale_range)
    return render_images(
        # one by one: a picture is normalised by the vertices that are there (paper section 3.2)
        list(generator.instances(values, settings.subdivision_steps)),
        None,
        rotations[: count * views],
        scales[: count * views],
        objects=np.repeat(np.arange(count), views),
        size=settings.image_size,
        style=settings.style,
        window=settings.window,
    )


def class_features(
    generators: Sequence[InstanceGenerator],
    settings: TrainingSettings,
    extractor: FeatureExtractor,
    progress: Progress = NULL_PROGRESS,
) -> Float[np.ndarray, "N D"]:
    """Features of one class's pictures; several models of a class share its variations evenly.

    Pictures live only as long as their block.

    Raises:
        RenderingError: no headless OpenGL.
        Cancelled: by ``progress``.
    """
    views = settings.images_per_variation
    out = np.empty((settings.variations * views, extractor.backbone.feature_count), dtype=np.float32)
    done = 0
    for generator, block, count in _blocks(generators, settings.variations):
        progress.report(done / settings.variations, f"{generator.model.name}: {done * views} pictures")
        images = variation_images(generator, block, count, settings)
        out[done * views : (done + count) * views] = extractor(images)
        done += count
    return out


def _blocks(generators: Sequence[InstanceGenerator], variations: int) -> Iterator[tuple[InstanceGenerator, int, int]]:
    shares = [len(part) for part in np.array_split(np.arange(variations), len(generators))]
    for generator, share in zip(generators, shares, strict=True):
        for block, start in enumerate(range(0, share, BLOCK)):
            yield generator, block, min(BLOCK, share - start)


def join_classes(classes: Sequence[Float[np.ndarray, "N D"]], settings: TrainingSettings) -> FeatureSet:
    """Join the features of all classes and choose the held-out variations, by the seed and for each class alone.

    Raises:
        ClassifierError: fewer than two classes.
    """
    if len(classes) < 2:
        raise ClassifierError("a classifier tells at least two classes apart", where="classes")
    views = settings.images_per_variation
    count = settings.variations
    kept_apart = min(max(1, round(count * settings.held_out)), count - 1)
    labels, variations, held_out = [], [], []
    for number in range(len(classes)):
        mask = np.zeros(count, dtype=bool)
        rng = np.random.default_rng([settings.seed, number])
        mask[rng.choice(count, size=kept_apart, replace=False)] = True
        labels.append(np.full(count * views, number))
        variations.append(np.repeat(np.arange(count) + number * count, views))
        held_out.append(np.repeat(mask, views))
    return FeatureSet(
        features=np.concatenate(classes),
        labels=np.concatenate(labels),
        variations=np.concatenate(variations),
        held_out=np.concatenate(held_out),
    )
