"""Coverage: is there a variation near every real object of a class, and is it nearer than those of other classes?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptor, panorama_distances
from shapewright.errors import EvaluationError, MeshError
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each
from shapewright.evaluation.descriptor_cache import BankRequest, DescriptorCache, file_digest
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, CallbackProgress, PartialProgress, Progress

SAMPLES: Final = 10_000
"""Variations of each class, shared by its models."""


@dataclass(frozen=True)
class Query:
    """A real mesh, described."""

    item: LabelledFile
    digest: str
    descriptor: PanoramaDescriptor


@dataclass(frozen=True)
class Neighbour:
    """The variation of a class that is nearest to a mesh."""

    distance: float
    model: str
    row: int


@dataclass(frozen=True)
class Coverage:
    """Every query beside its nearest variation of every compared class.

    Attributes:
        queries: the meshes.
        neighbours: of each query, by class.
        requests: the variations of each model, by its name.
        skipped: meshes without a usable surface.
    """

    queries: tuple[Query, ...]
    neighbours: tuple[Mapping[str, Neighbour], ...]
    requests: Mapping[str, BankRequest]
    skipped: tuple[Skipped, ...]

    def values(self, neighbour: Neighbour) -> Float[np.ndarray, " P"]:
        """Parameter values of a variation."""
        request = self.requests[neighbour.model]
        rng = np.random.default_rng(request.seed)
        return np.asarray(request.compiled.random_values(rng, request.samples)[neighbour.row])


def measure_coverage(
    items: Sequence[LabelledFile],
    models: Mapping[str, Sequence[CompiledModel]],
    cache: DescriptorCache,
    *,
    samples: int = SAMPLES,
    seed: int = 0,
    jobs: int = 1,
    progress: Progress = NULL_PROGRESS,
) -> Coverage:
    """Find the nearest of ``samples`` variations of every class for each mesh.

    Args:
        items: the meshes; each of their classes must be among the models.
        models: the models of each class that is compared; they share its samples.
        cache: what earlier runs left is used again.
        samples: variations of each class.
        seed: of the variations.
        jobs: meshes that are read at once.
        progress: told what is going on; may cancel.

    Raises:
        EvaluationError: no mesh is left, a class without a model, fewer samples than models.
    """
    lacking = sorted({item.class_name for item in items} - set(models))
    if lacking:
        raise EvaluationError("no procedural model of this class", where=lacking[0])
    requests = _requests(models, samples, seed)
    queries, skipped = describe_meshes(items, cache, jobs=jobs, progress=PartialProgress(progress, 0.0, 0.1))
    if not queries:
        reason = f" ({skipped[0].file}: {skipped[0].reason})" if skipped else ""
        raise EvaluationError(f"there is no mesh to compare with variations{reason}")
    neighbours: list[dict[str, Neighbour]] = [{} for _ in queries]
    for number, request in enumerate(requests):
        part = PartialProgress(progress, 0.1 + 0.9 * number / len(requests), 0.1 + 0.9 * (number + 1) / len(requests))
        model = request.compiled.model
        for found, (distance, row) in zip(neighbours, _nearest(queries, request, cache, part), strict=True):
            best = found.get(model.class_name)
            if best is None or distance < best.distance:
                found[model.class_name] = Neighbour(distance, model.name, row)
    return Coverage(queries, tuple(neighbours), {r.compiled.model.name: r for r in requests}, skipped)


def describe_meshes(
    items: Sequence[LabelledFile], cache: DescriptorCache, *, jobs: int = 1, progress: Progress = NULL_PROGRESS
) -> tuple[tuple[Query, ...], tuple[Skipped, ...]]:
    """Describe meshes, in their order; those that cannot be read or have no area are skipped."""
    found: dict[LabelledFile, Query | Skipped] = {}
    digests: dict[LabelledFile, str] = {}
    for item in items:
        try:
            digests[item] = file_digest(item.path)
        except OSError as error:
            found[item] = Skipped(item.file, f"cannot be read: {error.strerror}")
            continue
        kept = cache.mesh_descriptor(digests[item])
        if kept is not None:
            found[item] = Query(item, digests[item], kept)
    missing = [item for item in items if item not in found]
    for number, (item, mesh) in enumerate(load_each(missing, jobs=jobs)):
        progress.report(number / len(missing), f"meshes: {number} of {len(missing)}")
        if isinstance(mesh, Skipped):
            found[item] = mesh
            continue
        try:
            descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
        except MeshError as error:
            found[item] = Skipped(item.file, error.message)
            continue
        cache.keep_mesh_descriptor(digests[item], descriptor)
        found[item] = Query(item, digests[item], descriptor)
    outcomes = [found[item] for item in items]
    queries = tuple(outcome for outcome in outcomes if isinstance(outcome, Query))
    return queries, tuple(outcome for outcome in outcomes if isinstance(outcome, Skipped))


def _requests(models: Mapping[str, Sequence[CompiledModel]], samples: int, seed: int) -> list[BankRequest]:
    """Share the samples of each class among its models."""
    requests = []
    for class_name, members in models.items():
        if samples < len(members):
            raise EvaluationError(f"{samples} samples are too few for {len(members)} models", where=class_name)
        for index, compiled in enumerate(members):
            share = samples // len(members) + (index < samples % len(members))
            requests.append(BankRequest(compiled, share, seed))
    return requests


def _nearest(
    queries: Sequence[Query], request: BankRequest, cache: DescriptorCache, progress: Progress
) -> list[tuple[float, int]]:
    """Distance and row of the nearest variation of one model to each query."""
    name = request.compiled.model.name

    def tell(fraction: float, message: str) -> None:
        progress.report(fraction, f"{name}: {message}")

    bank = cache.bank(request, PartialProgress(CallbackProgress(tell), 0.0, 0.9))
    known = cache.nearest(request)
    new = [query for query in queries if query.digest not in known]
    for number, query in enumerate(new):
        tell(0.9 + 0.1 * number / len(new), f"mesh {number} of {len(new)}")
        distances = panorama_distances(query.descriptor, bank.descriptors)
        row = int(np.argmin(distances))
        known[query.digest] = (float(distances[row]), row)
    if new:
        cache.keep_nearest(request, known)
    return [known[query.digest] for query in queries]
