"""How objects become the pictures that a classifier learns from and looks at; plain values, nothing is drawn."""

from dataclasses import dataclass
from typing import Any

from shapewright.errors import ClassifierError
from shapewright.rendering.styles import FRAMINGS, PICTURE_STYLES, Framing, PictureStyle


@dataclass(frozen=True)
class Look:
    """How objects become pictures.

    Args:
        style: see :data:`shapewright.rendering.styles.PictureStyle`.
        image_size: pixels a side.
        framing: how an object is put into its picture; ``splats`` know ``sphere`` alone.
        window: half the side of a picture in units of the scaled object; ``splats`` know 1 alone.
        scale_range: scales are drawn uniformly from it.

    Raises:
        ClassifierError: a value that makes no sense; ``where`` names it.
    """

    style: PictureStyle
    image_size: int
    framing: Framing
    window: float
    scale_range: tuple[float, float]

    def __post_init__(self) -> None:
        ends = self.scale_range
        is_splats = self.style == "splats"
        checks = {
            "style": (self.style in PICTURE_STYLES, f"one of {sorted(PICTURE_STYLES)}"),
            "image_size": (self.image_size >= 1, "at least 1"),
            "framing": (self.framing in (("sphere",) if is_splats else FRAMINGS), f"one of {list(FRAMINGS)}"),
            "window": (self.window > 0 and (self.window == 1.0 or not is_splats), "positive; 1 for splats"),
            "scale_range": (len(ends) == 2 and 0 < ends[0] <= ends[1], "two positive numbers in order"),
        }
        for name, (fine, expected) in checks.items():
            if not fine:
                raise ClassifierError(f"expected {expected}, got {getattr(self, name)!r}", where=name)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values, ready for JSON."""
        return {
            "style": self.style,
            "image_size": self.image_size,
            "framing": self.framing,
            "window": self.window,
            "scale_range": list(self.scale_range),
        }

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "Look":
        """Return the look of :meth:`to_dict`; unknown names are ignored.

        Raises:
            ClassifierError: a value that makes no sense.
            KeyError, TypeError, ValueError: something else.
        """
        low, high = values["scale_range"]
        return cls(
            style=values["style"],
            image_size=int(values["image_size"]),
            framing=values["framing"],
            window=float(values["window"]),
            scale_range=(float(low), float(high)),
        )
