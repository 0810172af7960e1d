"""Estimating the parameters of a query (paper section 3.3)."""

from shapewright.estimation.bank import BankCancelled, PanoramaBank, build_bank
from shapewright.estimation.classes import (
    ClassEstimation,
    ClassEstimationCancelled,
    ModelTried,
    estimate_class,
)
from shapewright.estimation.estimate import estimate
from shapewright.estimation.result import (
    Distances,
    Estimation,
    EstimationCancelled,
    ParameterEstimate,
    Stage,
)
from shapewright.estimation.settings import EstimationSettings

__all__ = [
    "BankCancelled",
    "ClassEstimation",
    "ClassEstimationCancelled",
    "Distances",
    "Estimation",
    "EstimationCancelled",
    "EstimationSettings",
    "ModelTried",
    "PanoramaBank",
    "ParameterEstimate",
    "Stage",
    "build_bank",
    "estimate",
    "estimate_class",
]
