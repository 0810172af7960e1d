"""Learning pictures of one source, chunk by chunk: drawn, described, and stored (paper section 3.2).

A chunk is the unit of work that any worker can take. Its meshes, views and scales come from a random stream of its
own, named by the seed, the source's digest and the chunk's number. So what a chunk holds does not depend on other
classes, on their order, or on who computes it, and a longer series begins with the shorter one.
"""

import hashlib
import json
import os
import sys
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from typing import Final

import numpy as np
from jaxtyping import Bool, Float16, Float32, UInt8

from shapewright.classification.pictures import draw
from shapewright.classification.readings import VERSION as READINGS_VERSION
from shapewright.classification.readings import plain_reading
from shapewright.classification.series import SERIES, series_generators
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.network.backbone import Backbone
from shapewright.network.features import FeatureExtractor
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering.views import random_views
from shapewright.training.array_store import ArrayStore
from shapewright.training.broken.breaking import VERSION as BREAKS_VERSION
from shapewright.training.broken.breaking import broken, is_broken
from shapewright.training.settings import TrainingSettings
from shapewright.training.sources import MESHES_VERSION, Source

BLOCK: Final = 8
"""Meshes that are drawn and described together; bounds the memory."""
DESCRIPTORS_VERSION: Final = 1
"""Raise it when the descriptor of the same object is another one."""
PICTURES_VERSION: Final = 3
"""Raise it when the renderer draws something else for the same settings."""
_DESCRIBING_THREADS: Final = 2
_NICENESS: Final = 10
"""Of the describing threads alone."""


@dataclass(frozen=True)
class Chunk:
    """The first ``count`` meshes of one series of a source.

    Args:
        source: gives the meshes.
        number: which series, from 0.
        count: at most :data:`shapewright.classification.series.SERIES`.
    """

    source: Source
    number: int
    count: int

    def meshes(self, settings: TrainingSettings) -> Iterator[TriangleMesh]:
        """The whole meshes, one after the other."""
        return self.source.meshes(self._generators(settings)[0], self.count, settings.subdivision_steps)

    def objects(self, settings: TrainingSettings) -> Iterator[TriangleMesh | PointCloud]:
        """The meshes as they are learned from, some of them broken, one after the other."""
        for number, (mesh, is_broken_one) in enumerate(zip(self.meshes(settings), self.broken(settings), strict=True)):
            rng = np.random.default_rng([settings.seed, int(self.source.digest[:16], 16), self.number, number])
            yield broken(mesh, settings.breaks, rng) if is_broken_one else mesh

    def broken(self, settings: TrainingSettings) -> Bool[np.ndarray, " M"]:
        """Which of the meshes are broken."""
        share = settings.broken if settings.breaks else 0.0
        return np.array([is_broken(number, share) for number in range(self.count)])

    def views(self, settings: TrainingSettings) -> tuple[np.ndarray, np.ndarray]:
        """Rotations (count, views, 3, 3) and scales (count, views) of the pictures."""
        per_mesh = settings.images_per_variation
        rng = self._generators(settings)[1]
        rotations, scales = random_views(rng, SERIES * per_mesh, scale_range=settings.scale_range)
        return rotations.reshape(SERIES, per_mesh, 3, 3)[: self.count], scales.reshape(SERIES, per_mesh)[: self.count]

    def _generators(self, settings: TrainingSettings) -> tuple[np.random.Generator, np.random.Generator]:
        return series_generators(settings.seed, self.source.digest, self.number)


def chunks_of(source: Source, count: int) -> list[Chunk]:
    """Cut ``count`` meshes of a source into chunks."""
    return [Chunk(source, number, min(SERIES, count - start)) for number, start in enumerate(range(0, count, SERIES))]


def features_key(chunk: Chunk, settings: TrainingSettings, backbone: Backbone) -> str:
    """Where the features of a chunk's pictures are stored: all that they depend on."""
    rendering = _digest(_PICTURE_SETTINGS, settings, PICTURES_VERSION)
    return f"features/{backbone.key}/{rendering}/{_series_name(chunk, settings)}"


def descriptors_key(chunk: Chunk, settings: TrainingSettings) -> str:
    """Where the panorama descriptors of a chunk's objects are stored."""
    from shapewright.distances.descriptor_files import descriptor_version

    objects = _digest(_OBJECT_SETTINGS, settings, READINGS_VERSION, DESCRIPTORS_VERSION)
    return f"panoramas/v{descriptor_version()}-{objects}/{_series_name(chunk, settings)}"


_OBJECT_SETTINGS: Final = ("subdivision_steps", "broken", "breaks")
_PICTURE_SETTINGS: Final = (
    *_OBJECT_SETTINGS,
    "images_per_variation",
    "image_size",
    "scale_range",
    "style",
    "framing",
    "window",
)


def _digest(names: Sequence[str], settings: TrainingSettings, *versions: int) -> str:
    """Return what tells settings apart of which something depends."""
    values = {name: settings.to_dict()[name] for name in names} | {"versions": [*versions, BREAKS_VERSION]}
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:12]


def _series_name(chunk: Chunk, settings: TrainingSettings) -> str:
    return f"{chunk.source.digest[:32]}/v{MESHES_VERSION}-{settings.seed}-{chunk.number}-{chunk.count}.npy"


def is_stored(chunk: Chunk, settings: TrainingSettings, backbone: Backbone, store: ArrayStore, described: bool) -> bool:
    """Whether nothing of a chunk is left to compute."""
    return store.get(features_key(chunk, settings, backbone)) is not None and not (
        described and store.get(descriptors_key(chunk, settings)) is None
    )


def store_chunk(
    chunk: Chunk,
    settings: TrainingSettings,
    extractor: FeatureExtractor,
    store: ArrayStore,
    *,
    described: bool,
    progress: Progress = NULL_PROGRESS,
) -> None:
    """Compute what the store lacks of a chunk: the features of its pictures, and panorama descriptors if wanted.

    Drawing and describing overlap: while one block is drawn, networks and descriptors work on the ones before.

    Raises:
        RenderingError: no headless OpenGL.
        Cancelled: by ``progress``; nothing of this chunk is kept.
    """
    feature_key, panorama_key = features_key(chunk, settings, extractor.backbone), descriptors_key(chunk, settings)
    needs_features = store.get(feature_key) is None
    needs_panoramas = described and store.get(panorama_key) is None
    if not (needs_features or needs_panoramas):
        return
    rotations, scales = chunk.views(settings)
    features: list[Float16[np.ndarray, "N D"]] = []
    panoramas: list[Float32[np.ndarray, "N D"]] = []
    objects = chunk.objects(settings)
    with _describing_pool() as pool:
        pending: deque[tuple[Future[np.ndarray] | None, Future[np.ndarray] | None]] = deque()

        def take() -> None:
            drawn, described_block = pending.popleft()
            if drawn is not None:
                features.append(drawn.result().astype(np.float16))
            if described_block is not None:
                panoramas.append(described_block.result())

        done = 0
        while block := list(islice(objects, BLOCK)):
            progress.report(done / chunk.count, f"{chunk.source.name}: {done} of {chunk.count}")
            at = slice(done, done + len(block))
            images = _pictures(block, rotations[at], scales[at], settings) if needs_features else None
            pending.append(
                (
                    None if images is None else pool.submit(extractor, images),
                    pool.submit(_panoramas, block, done) if needs_panoramas else None,
                )
            )
            done += len(block)
            if len(pending) > _DESCRIBING_THREADS:
                take()
        while pending:
            take()
    if needs_panoramas:
        store.put(panorama_key, np.concatenate(panoramas))
    if needs_features:
        store.put(feature_key, np.concatenate(features).reshape(chunk.count, settings.images_per_variation, -1))


def _step_back() -> None:
    """Let what people wait for go first: three busy threads are more than a training's share of two cores (Linux)."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)


@contextmanager
def _describing_pool() -> Iterator[ThreadPoolExecutor]:
    """Threads beside the one that draws; who breaks off waits for what they do, not for what waits for them."""
    with ThreadPoolExecutor(_DESCRIBING_THREADS, initializer=_step_back) as pool:
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _pictures(
    objects: Sequence[TriangleMesh | PointCloud], rotations: np.ndarray, scales: np.ndarray, settings: TrainingSettings
) -> UInt8[np.ndarray, "N H W 3"]:
    shown = np.repeat(np.arange(len(objects)), settings.images_per_variation)
    return draw(objects, rotations.reshape(-1, 3, 3), scales.reshape(-1), settings.look, shown=shown)


def _panoramas(objects: Sequence[TriangleMesh | PointCloud], first: int) -> Float32[np.ndarray, "N D"]:
    """Describe objects of a series, from number ``first`` on; every other one by surfels, even if it has faces.

    Noise and holes take a scan far from the descriptors of whole surfaces, but not from those of surfels.
    """
    import numba

    from shapewright.distances.panorama import panorama_descriptor

    numba.set_num_threads(1)  # of this thread: the other cores draw
    surfaces = [
        plain_reading(one).described_surface(by_surfels=number % 2 == 1)
        for number, one in enumerate(objects, start=first)
    ]
    return np.stack([panorama_descriptor(surface.vertices, surface.faces).to_array() for surface in surfaces])


def chunk_images(chunk: Chunk, settings: TrainingSettings) -> UInt8[np.ndarray, "N H W 3"]:
    """The learning pictures of a chunk, those of one mesh together: to look at."""
    rotations, scales = chunk.views(settings)
    return _pictures(list(chunk.objects(settings)), rotations, scales, settings)
