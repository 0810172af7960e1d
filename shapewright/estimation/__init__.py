"""Estimating the parameters of a query (paper section 3.3).

Names are loaded when first used: a classifier needs the protocol of its models, but none of the estimators.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank, build_bank_for
    from shapewright.estimation.estimating import estimate
    from shapewright.estimation.estimator import BankOf, Estimator
    from shapewright.estimation.generator import InstanceGenerator
    from shapewright.estimation.query import Query
    from shapewright.estimation.result import (
        Alternative,
        Combination,
        Distances,
        Estimation,
        EstimationCancelled,
        FailedThreshold,
        ModelTried,
        ParameterEstimate,
        Ratio,
        Stage,
        Verdict,
    )
    from shapewright.estimation.settings import EstimationSettings

_HOMES = {
    "Alternative": "result",
    "BankCancelled": "bank",
    "BankOf": "estimator",
    "Combination": "result",
    "Distances": "result",
    "Estimation": "result",
    "EstimationCancelled": "result",
    "EstimationSettings": "settings",
    "Estimator": "estimator",
    "FailedThreshold": "result",
    "InstanceGenerator": "generator",
    "ModelTried": "result",
    "PanoramaBank": "bank",
    "ParameterEstimate": "result",
    "Query": "query",
    "Ratio": "result",
    "Stage": "result",
    "Verdict": "result",
    "build_bank": "bank",
    "build_bank_for": "bank",
    "estimate": "estimating",
}

__all__ = [
    "Alternative",
    "BankCancelled",
    "BankOf",
    "Combination",
    "Distances",
    "Estimation",
    "EstimationCancelled",
    "EstimationSettings",
    "Estimator",
    "FailedThreshold",
    "InstanceGenerator",
    "ModelTried",
    "PanoramaBank",
    "ParameterEstimate",
    "Query",
    "Ratio",
    "Stage",
    "Verdict",
    "build_bank",
    "build_bank_for",
    "estimate",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
