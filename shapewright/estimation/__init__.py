"""Estimating the parameters of a query (paper section 3.3)."""

from shapewright.estimation.bank import PanoramaBank, build_bank
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
    "Distances",
    "Estimation",
    "EstimationCancelled",
    "EstimationSettings",
    "PanoramaBank",
    "ParameterEstimate",
    "Stage",
    "build_bank",
    "estimate",
]
