"""The one entry to every estimator."""

from collections.abc import Sequence

from shapewright.errors import EstimationError
from shapewright.estimation.estimator import BankOf, Estimator
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.query import Query
from shapewright.estimation.result import Estimation
from shapewright.estimation.settings import EstimationSettings, EstimatorName
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress


def estimate(
    query: TriangleMesh | Query,
    models: InstanceGenerator | Sequence[InstanceGenerator],
    settings: EstimationSettings | None = None,
    *,
    progress: Progress = NULL_PROGRESS,
    banks: BankOf | None = None,
) -> Estimation:
    """Find the parameter values and the pose with which a model, or the best of several, rebuilds a query.

    Args:
        query: the unknown mesh, in any units; soup is fine. A :class:`Query` says more: its unit, the axis that
            points up, or its rotation.
        models: the compiled model of its class, or all compiled models of the class, of which the best is found.
        settings: the paper's if not given; ``settings.estimator`` chooses who works.
        progress: told what is going on; the fraction never falls. It may raise ``Cancelled``.
        banks: finds the random instances of a model (:func:`build_bank`); without it they are built where an
            estimator needs them, which takes a good part of the time of the reference.

    Raises:
        EstimationCancelled: the progress cancelled; ``best`` is the best result so far.
        EstimationError: no models, or a bank belongs to another model.
        MeshError: the query has no extent.
    """
    settings = settings or EstimationSettings()
    asked = query if isinstance(query, Query) else Query(query)
    several = list(models) if isinstance(models, Sequence) else [models]
    if not several:
        raise EstimationError("expected at least one model, got none", where="models")
    return _estimator(settings.estimator, banks).estimate(asked, several, settings, progress)


def _estimator(name: EstimatorName, banks: BankOf | None) -> Estimator:
    """Make an estimator; each is imported, with its compiled kernels, only when it is needed."""
    if name == "reference":
        from shapewright.estimation.reference import ReferenceEstimator

        return ReferenceEstimator(banks)
    from shapewright.estimation.fast.estimator import FastEstimator

    return FastEstimator()
