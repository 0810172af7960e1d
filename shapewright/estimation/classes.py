"""Estimating with a class, a set of models of which the best one is found (ours; the paper has one model)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank
from shapewright.estimation.estimate import estimate, nearest
from shapewright.estimation.generator import InstanceGenerator, ModelInfo
from shapewright.estimation.result import Estimation, EstimationCancelled
from shapewright.estimation.settings import EstimationSettings
from shapewright.estimation.steady_progress import Titled
from shapewright.estimation.verdict import order
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

REFINED = 2
"""Models that go on after the scan of layer 1."""
BANKS_SHARE = 0.3
"""Share of the progress that building and scanning the banks takes."""

BankOf = Callable[[InstanceGenerator, Progress], PanoramaBank]
"""Finds or builds the bank of a model; may raise :class:`BankCancelled`."""


@dataclass(frozen=True, eq=False)
class ModelTried:
    """How near a model came.

    ``panorama`` is the distance of the nearest of its random instances; ``estimation`` is ``None`` if others were
    nearer.
    """

    model: ModelInfo
    panorama: float
    estimation: Estimation | None


@dataclass(frozen=True, eq=False)
class ClassEstimation:
    """The best estimation among a class's models.

    Args:
        model: the model that fits best.
        estimation: its estimation.
        tried: all models, the nearest of the scan first.
    """

    model: ModelInfo
    estimation: Estimation
    tried: tuple[ModelTried, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON; all but the mesh."""
        tried = [
            {
                "model_id": one.model.digest,
                "model_name": one.model.name,
                "panorama": one.panorama,
                "distances": None if one.estimation is None else one.estimation.distances.to_dict(),
            }
            for one in self.tried
        ]
        return {**self.estimation.to_dict(), "models_tried": tried}


class ClassEstimationCancelled(Cancelled):
    """The estimation was cancelled. ``best`` is the best result so far, None if there is none yet."""

    def __init__(self, best: ClassEstimation | None) -> None:
        super().__init__("the estimation was cancelled")
        self.best = best


@dataclass
class _Scanned:
    """A model after its scan; only the nearest keep their banks, as a bank may be large."""

    generator: InstanceGenerator
    distance: float
    bank: PanoramaBank | None
    estimation: Estimation | None = None


def estimate_class(
    query: TriangleMesh,
    generators: Sequence[InstanceGenerator],
    settings: EstimationSettings | None = None,
    *,
    progress: Progress = NULL_PROGRESS,
    bank_of: BankOf | None = None,
) -> ClassEstimation:
    """Find the model of a class that rebuilds a query best, with its values and pose.

    The banks of all models are scanned for the instance with the smallest panorama distance. The :data:`REFINED`
    nearest models are estimated as :func:`estimate` does, and :func:`verdict.order` tells which result is better.

    Args:
        query: the unknown mesh, in any units; soup is fine.
        generators: the compiled models of the class.
        settings: the paper's if not given; ``samples`` are those of each model.
        progress: told what is going on; it may raise ``Cancelled``.
        bank_of: finds the bank of a model; without it each is built here, and at most ``REFINED`` + 1 are kept at once.

    Raises:
        ClassEstimationCancelled: the progress cancelled; ``best`` is the best result so far.
        EstimationError: no models, or a bank belongs to another one.
        MeshError: the query has no extent.
    """
    if not generators:
        raise EstimationError("a class has at least one model", where="generators")
    settings = settings or EstimationSettings()
    bank_of = bank_of or _builder(settings)
    scanned: list[_Scanned] = []
    try:
        _scan(query, generators, settings, PartialProgress(progress, 0.0, BANKS_SHARE), bank_of, scanned)
        chosen = [one for one in scanned if one.bank is not None]
        for number, one in enumerate(chosen):
            assert one.bank is not None
            start, end = (BANKS_SHARE + (1.0 - BANKS_SHARE) * k / len(chosen) for k in (number, number + 1))
            part = Titled(PartialProgress(progress, start, end), one.generator.model.name)
            one.estimation = estimate(query, one.generator, settings, progress=part, bank=one.bank)
    except EstimationCancelled as cancelled:
        one.estimation = cancelled.best
        raise ClassEstimationCancelled(_best(query, settings, scanned)) from None
    except Cancelled:
        raise ClassEstimationCancelled(_best(query, settings, scanned)) from None
    return _verdict(scanned)


def _scan(
    query: TriangleMesh,
    generators: Sequence[InstanceGenerator],
    settings: EstimationSettings,
    progress: Progress,
    bank_of: BankOf,
    scanned: list[_Scanned],
) -> None:
    """Fill ``scanned``, nearest first."""
    from shapewright.distances.panorama import panorama_descriptor
    from shapewright.estimation.layers import nearest_in_bank  # compiled kernels: only when needed

    mesh = query.normalized().mesh
    descriptor = panorama_descriptor(mesh.vertices, mesh.faces)

    def add(generator: InstanceGenerator, bank: PanoramaBank) -> None:
        bank.check_fits(generator, settings.subdivision_steps)
        scanned.append(_Scanned(generator, nearest_in_bank(descriptor, bank).distance, bank))
        scanned.sort(key=lambda one: one.distance)
        for other in scanned[REFINED:]:
            other.bank = None

    for number, generator in enumerate(generators):
        start, end = number / len(generators), (number + 1) / len(generators)
        part = Titled(PartialProgress(progress, start, end), generator.model.name)
        part.report(0.0, "random instances")
        try:
            add(generator, bank_of(generator, part))
        except BankCancelled as cancelled:
            if cancelled.bank is not None:
                add(generator, cancelled.bank)
            raise


def _best(query: TriangleMesh, settings: EstimationSettings, scanned: list[_Scanned]) -> ClassEstimation | None:
    """What is known after a cancellation; of a scan alone the nearest instance."""
    if not scanned:
        return None
    if all(one.estimation is None for one in scanned):
        first = scanned[0]
        assert first.bank is not None
        first.estimation = nearest(query, first.generator, settings, first.bank)
    best = _verdict(scanned)
    return replace(best, estimation=replace(best.estimation, complete=False))


def _verdict(scanned: list[_Scanned]) -> ClassEstimation:
    results = [(one.estimation, one.generator.model) for one in scanned if one.estimation is not None]
    estimation, model = min(results, key=lambda result: order(result[0]))
    tried = tuple(ModelTried(one.generator.model, one.distance, one.estimation) for one in scanned)
    return ClassEstimation(model, estimation, tried)


def _builder(settings: EstimationSettings) -> BankOf:
    def build(generator: InstanceGenerator, progress: Progress) -> PanoramaBank:
        rng, _ = np.random.default_rng(settings.seed).spawn(2)  # as the estimator does without a bank
        return build_bank(generator, settings.samples, rng, progress, subdivision_steps=settings.subdivision_steps)

    return build
