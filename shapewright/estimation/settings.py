"""Settings of an estimation; the defaults are the paper's (section 3.3)."""

from dataclasses import asdict, dataclass, field, fields
from typing import Any, Literal, get_args

import numpy as np

from shapewright.distances.alignment import AlignmentSettings
from shapewright.errors import EstimationError

EstimatorName = Literal["fast", "reference"]
"""The estimators there are; ``reference`` is the paper, step by step."""
ModelPoints = Literal["surface", "vertices"]
"""Where the surface distance measures an instance."""


@dataclass(frozen=True)
class EstimationSettings:
    """What an estimation does and when it is satisfied.

    Args:
        samples: random instances of layer 1, 10 000 in the paper; the size of the bank.
        surface_points: Poisson-disk points on the query.
        image_size: pixels along each side of the 14 depth images, even.
        subdivision_steps: Catmull–Clark steps of the instances that are compared, 0 to 4.
        model_points: where the surface distance measures an instance: at points spread evenly over its surface, or at
            its vertices, as the paper does. Flat creased faces have few vertices, so that some models are then farther
            from themselves than the threshold of layer 2.
        surface_threshold: layer 2 is an adequate match below this surface distance.
        zbuffer_threshold: layer 3 is an adequate match below this (normalised) z-buffer distance.
        step_sizes: of the hill climbing, largest first.
        alignment: steps and limits of the realignment.
        refined_models: of several models, how many the reference takes through all layers: those with the nearest
            random instances.
        seed: of the random instances and of the points on the query.
        estimator: which of the estimators works.

    Raises:
        EstimationError: a setting is out of its range; ``where`` names it.
    """

    samples: int = 10_000
    surface_points: int = 2000
    image_size: int = 256
    subdivision_steps: int = 2
    model_points: ModelPoints = "surface"
    surface_threshold: float = 0.04
    zbuffer_threshold: float = 0.7
    step_sizes: tuple[float, ...] = (1.0, 0.5, 0.25, 0.1, 0.01)
    alignment: AlignmentSettings = field(default_factory=AlignmentSettings)
    refined_models: int = 2
    seed: int = 0
    estimator: EstimatorName = "fast"

    def __post_init__(self) -> None:
        for name, least, most in _WHOLE:
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
                raise EstimationError(f"expected a whole number from {least} to {most}, got {value}", where=name)
        if self.image_size % 2:
            raise EstimationError(f"expected an even number of pixels, got {self.image_size}", where="image_size")
        for name in ("surface_threshold", "zbuffer_threshold"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise EstimationError(f"expected a number of 0 or more, got {value}", where=name)
        steps = np.asarray(self.step_sizes, dtype=np.float64)
        falling = len(steps) > 0 and bool(np.isfinite(steps).all() and (np.diff(steps) < 0).all())
        if not falling or steps[-1] <= 0:
            raise EstimationError(
                f"expected positive steps from large to small, got {self.step_sizes}", where="step_sizes"
            )
        for name, known in (("estimator", get_args(EstimatorName)), ("model_points", get_args(ModelPoints))):
            value = getattr(self, name)
            if value not in known:
                raise EstimationError(f"expected one of {', '.join(known)}, got {value!r}", where=name)

    @classmethod
    def quick(cls, *, samples: int = 1000, seed: int = 0) -> "EstimationSettings":
        """Coarser settings of the reference (ours): about a fifth of its time, and a result not quite as close.

        On a table and a glass of the Princeton benchmark the z-buffer distance, at a tenth of the samples, ended
        at 0.08 and 0.10; the table with the paper's settings and 2000 samples at 0.07.
        """
        return cls(
            samples=samples,
            surface_points=500,
            image_size=128,
            subdivision_steps=1,
            step_sizes=(1.0, 0.5, 0.25, 0.1, 0.02),
            alignment=AlignmentSettings(0.02, 0.02 * np.pi, 0.02),
            seed=seed,
            estimator="reference",
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        document = asdict(self)
        document["step_sizes"] = list(self.step_sizes)
        document["alignment"]["scale_limits"] = list(self.alignment.scale_limits)
        return document

    @classmethod
    def from_dict(cls, document: dict[str, Any]) -> "EstimationSettings":
        """Settings from what :meth:`to_dict` gives; what is missing stays at its default.

        Raises:
            EstimationError: an unknown name, or a value that is not allowed.
        """
        values = dict(document)
        _refuse_unknown(values, cls)
        try:
            if "step_sizes" in values:
                values["step_sizes"] = tuple(float(step) for step in values["step_sizes"])
            if isinstance(values.get("alignment"), dict):
                alignment = dict(values["alignment"])
                _refuse_unknown(alignment, AlignmentSettings, "alignment.")
                if "scale_limits" in alignment:
                    low, high = alignment["scale_limits"]
                    alignment["scale_limits"] = (float(low), float(high))
                values["alignment"] = AlignmentSettings(**alignment)
            return cls(**values)
        except (TypeError, ValueError) as error:
            raise EstimationError(f"a setting is of a wrong type: {error}") from error


_WHOLE = (
    ("samples", 1, 10_000_000),
    ("surface_points", 10, 1_000_000),
    ("image_size", 8, 4096),
    ("subdivision_steps", 0, 4),
    ("refined_models", 1, 1000),
    ("seed", 0, 2**63 - 1),
)


def _refuse_unknown(document: dict[str, Any], settings: type[Any], prefix: str = "") -> None:
    known = {item.name for item in fields(settings)}
    for name in document:
        if name not in known:
            raise EstimationError("there is no such setting", where=f"{prefix}{name}")
