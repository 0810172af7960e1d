"""What every estimator is: queries and models in, the best fit out."""

from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

from shapewright.estimation.bank import PanoramaBank
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.query import Query
from shapewright.estimation.result import Estimation
from shapewright.estimation.settings import EstimationSettings
from shapewright.progress import Progress

BankOf = Callable[[InstanceGenerator, Progress], PanoramaBank]
"""Finds or builds the bank of a model; may raise :class:`shapewright.estimation.bank.BankCancelled`."""


@runtime_checkable
class Estimator(Protocol):
    """Finds the model, the parameter values and the pose that rebuild a query."""

    def estimate(
        self,
        query: Query,
        models: Sequence[InstanceGenerator],
        settings: EstimationSettings,
        progress: Progress,
    ) -> Estimation:
        """Find the best fit.

        Args:
            query: the unknown mesh and what is known of it.
            models: the compiled models of its class, at least one.
            settings: what to do and when to be satisfied.
            progress: told what is going on; the fraction never falls. It may raise ``Cancelled``.

        Raises:
            EstimationCancelled: the progress cancelled; ``best`` is the best result so far.
            EstimationError: a bank belongs to another model.
            MeshError: the query has no extent.
        """
