"""The one entry to every estimator, for one model; :mod:`shapewright.estimation.classes` has the one for a class."""

from shapewright.errors import Cancelled
from shapewright.estimation.bank import PanoramaBank
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.result import Estimation, EstimationCancelled
from shapewright.estimation.settings import EstimationSettings
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress


def estimate(
    query: TriangleMesh,
    compiled: InstanceGenerator,
    settings: EstimationSettings | None = None,
    *,
    progress: Progress = NULL_PROGRESS,
    bank: PanoramaBank | None = None,
) -> Estimation:
    """Find the parameter values and the pose with which a model rebuilds a query (paper section 3.3).

    Args:
        query: the unknown mesh, in any units; soup is fine.
        compiled: the model of its class, compiled.
        settings: the paper's if not given.
        progress: told what is going on; the fraction never falls. It may raise ``Cancelled``.
        bank: the random instances of layer 1, if they were built before (:func:`build_bank`); otherwise they
            are built here, which takes a good part of the time.

    Raises:
        EstimationCancelled: the progress cancelled; ``best`` is the best result so far.
        EstimationError: the bank belongs to another model.
        MeshError: the query has no extent.
    """
    from shapewright.estimation.reference import ReferenceEstimator  # compiled kernels: only when needed

    settings = settings or EstimationSettings()
    return ReferenceEstimator(query, compiled, settings, progress).run(bank)


def nearest(
    query: TriangleMesh, compiled: InstanceGenerator, settings: EstimationSettings, bank: PanoramaBank
) -> Estimation:
    """Take the nearest of a bank's instances as it is: the answer of an estimation cancelled at its first step.

    Raises:
        EstimationError: the bank belongs to another model.
        MeshError: the query has no extent.
    """
    try:
        return estimate(query, compiled, settings, progress=_OnlyTheFirstStep(), bank=bank)
    except EstimationCancelled as cancelled:
        if cancelled.best is None:  # it has a bank, so there is a nearest one
            raise
        return cancelled.best


class _OnlyTheFirstStep:
    """Lets an estimation begin and cancels it at its first step."""

    def report(self, fraction: float, message: str) -> None:
        """Cancel as soon as anything is done."""
        if fraction > 0:
            raise Cancelled
