"""Estimating the parameters of a query (paper section 3.3)."""

from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank, build_bank_for
from shapewright.estimation.estimate import estimate
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
