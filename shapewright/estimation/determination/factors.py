"""The factor that makes intervals cover as often as they say, fitted on queries whose true values are known."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any, Final

import numpy as np
from jaxtyping import Float

from shapewright.errors import EstimationError
from shapewright.whole_file import write_whole

COVERAGE: Final = 0.9
"""Share of the intervals that hold the true value."""
FILE: Final = "interval_factors.json"
_VERSION: Final = 1


def conformal_factor(
    errors: Float[np.ndarray, " N"],
    mean_residuals: Float[np.ndarray, " N"],
    deviations: Float[np.ndarray, " N"],
    coverage: float = COVERAGE,
) -> float:
    """Return the factor with which ``factor * mean_residual * deviation`` covers the errors of new queries.

    Split conformal prediction (Vovk et al. 2005): the ceil((N + 1) coverage)-th smallest of the factors that would have
    covered each error. It holds whatever the errors' distribution, if new queries are like these.

    Args:
        errors: differences between estimated and true values, any sign.
        mean_residuals: of the fit that each is from, not less than the floor that intervals use.
        deviations: square roots of the diagonal of the inverse Fisher matrix, in the unit of the errors.
        coverage: share to cover, above 0 and below 1.

    Raises:
        EstimationError: too few errors for the coverage, or a figure that is not finite or not positive.
    """
    if not 0.0 < coverage < 1.0:
        raise EstimationError(f"expected a share between 0 and 1, got {coverage}", where="coverage")
    spreads = mean_residuals * deviations
    if not (np.isfinite(errors).all() and np.isfinite(spreads).all() and (spreads > 0).all()):
        raise EstimationError("expected finite errors, and positive residuals and deviations")
    rank = math.ceil((len(errors) + 1) * coverage - 1e-9)
    if rank > len(errors):
        least = math.ceil(coverage / (1.0 - coverage) - 1e-9)
        raise EstimationError(f"expected at least {least} errors for a coverage of {coverage}, got {len(errors)}")
    return float(np.partition(np.abs(errors) / spreads, rank - 1)[rank - 1])


@dataclass(frozen=True)
class IntervalFactors:
    """Factors by model.

    Attributes:
        default: for models that none was fitted for.
        by_digest: factors of models by their digest; another version of a model is another model.
        by_name: of the same models by name, for versions that none was fitted for.
    """

    default: float
    by_digest: Mapping[str, float] = field(default_factory=dict)
    by_name: Mapping[str, float] = field(default_factory=dict)

    def of(self, digest: str, name: str) -> float:
        """Return the factor of a model: its own, that of another version of it, or the default."""
        return self.by_digest.get(digest, self.by_name.get(name, self.default))

    @classmethod
    def shipped(cls) -> "IntervalFactors":
        """Return the factors that ship with the estimator."""
        return cls.from_json(resources.files("shapewright.estimation").joinpath(FILE).read_text(encoding="utf-8"))

    @classmethod
    def from_json(cls, text: str) -> "IntervalFactors":
        """Read what :func:`write_factors` wrote.

        Raises:
            EstimationError: the text is something else.
        """
        try:
            document: Any = json.loads(text)
            if document["version"] != _VERSION:
                raise EstimationError(f"expected version {_VERSION}, got {document['version']}", where="version")
            models = {str(name): entry for name, entry in document["models"].items()}
            factors = cls(
                default=float(document["default"]),
                by_digest={str(entry["digest"]): float(entry["factor"]) for entry in models.values()},
                by_name={name: float(entry["factor"]) for name, entry in models.items()},
            )
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise EstimationError(f"no interval factors: {error!r}") from None
        if not all(math.isfinite(factor) and factor > 0 for factor in (factors.default, *factors.by_name.values())):
            raise EstimationError("expected positive factors")
        return factors


def write_factors(path: Path, default: float, models: Mapping[str, tuple[str, float]]) -> None:
    """Write factors as they ship.

    Args:
        path: of the file.
        default: for models that are not named.
        models: digest and factor of each model, by name.

    Raises:
        OSError: the file cannot be written.
    """
    entries = {
        name: {"digest": digest, "factor": round(factor, 4)} for name, (digest, factor) in sorted(models.items())
    }
    document = {"version": _VERSION, "default": round(default, 4), "models": entries}
    write_whole(path, (json.dumps(document, indent=2) + "\n").encode())
