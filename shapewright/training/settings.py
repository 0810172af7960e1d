"""How a classifier is trained."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from shapewright.classification.look import Look
from shapewright.errors import ClassifierError
from shapewright.network.backbone import BACKBONES, DEFAULT_BACKBONE
from shapewright.rendering.styles import SCALE_RANGE, WINDOW, Framing, PictureStyle
from shapewright.training.broken import BREAK_NAMES, MOST_BROKEN


@dataclass(frozen=True)
class TrainingSettings:
    """Settings of :func:`shapewright.training.train_classifier`.

    There are as many pictures as in the paper (section 3.2), but of twice as many variations: real meshes profit more
    from these. How pictures are framed and shaded is ours as well; :meth:`paper` has the paper's settings.

    Args:
        variations: random variations of each class.
        images_per_variation: pictures of each variation, each with its own rotation and scale.
        image_size: pixels a side; 0 takes the size that the backbone was trained for.
        scale_range: scales are drawn uniformly from it.
        negatives: objects that are of no class: so many random assemblies, and as many variations of other models
            together if there are eight of them or more, fewer if not. 0 learns to tell classes apart, but not what
            is ``unknown``.
        exemplars: whether the variations' panorama descriptors are kept, as evidence beside the pictures.
        exemplars_per_class: keep so many of them, those that represent the rest best; 0 keeps all.
        vary: whether variations vary; without, all pictures show base models (the paper's baseline, section 4.2).
        held_out: share of each class's *variations* (not pictures) kept for early stopping and calibration.
        hidden: values of the head's hidden layer; 0 trains a single layer, as the paper does.
        epochs: passes over the features at most; the learning rate falls to nothing over them.
        patience: passes without a better held-out loss after which training stops.
        learning_rate: highest one of AdamW, for standardised features.
        weight_decay: pull of the head's weights towards zero.
        batch_size: pictures in one step of the head's training at most.
        seed: of everything random; the same seed, models and settings give the same classifier.
        backbone: an entry of :data:`shapewright.network.backbone.BACKBONES`.
        style: look of the pictures.
        framing: how an object is put into its picture.
        window: half the side of a picture in units of the scaled object.
        subdivision_steps: of the variations' surfaces.
        broken: share of the variations that are broken before they are drawn, as scans and careless exports are; 0 for
            styles of triangles.
        breaks: ways to break them, the hardest more often, among
            :data:`shapewright.training.broken.BREAK_NAMES`.

    Raises:
        ClassifierError: a setting that makes no sense; ``where`` names it.
    """

    variations: int = 2000
    images_per_variation: int = 5
    image_size: int = 0
    scale_range: tuple[float, float] = (0.7, 1.0)
    negatives: int = 3000
    exemplars: bool = True
    exemplars_per_class: int = 300
    vary: bool = True
    held_out: float = 0.1
    hidden: int = 512
    epochs: int = 8
    patience: int = 4
    learning_rate: float = 1e-3
    weight_decay: float = 1e-2
    batch_size: int = 256
    seed: int = 0
    backbone: str = DEFAULT_BACKBONE
    style: PictureStyle = "splats"
    framing: Framing = "sphere"
    window: float = 1.0
    subdivision_steps: int = 2
    broken: float = 0.7
    breaks: tuple[str, ...] = BREAK_NAMES

    def __post_init__(self) -> None:
        if self.backbone not in BACKBONES:
            raise ClassifierError(f"is {self.backbone!r}, must be one of {sorted(BACKBONES)}", where="backbone")
        sizes = BACKBONES[self.backbone].sizes
        if self.image_size == 0:
            object.__setattr__(self, "image_size", sizes.usual)
        most_broken = MOST_BROKEN if self.style == "splats" else 0.0  # points without faces are what most breaks leave
        checks = {
            "variations": (self.variations >= 2, "at least 2: one to learn from, one held out"),
            "images_per_variation": (self.images_per_variation >= 1, "at least 1"),
            "image_size": (sizes.fit(self.image_size), f"{sizes} for {self.backbone}"),
            "negatives": (self.negatives >= 0, "not negative"),
            "exemplars_per_class": (self.exemplars_per_class >= 0, "not negative"),
            "held_out": (0 < self.held_out < 1, "between 0 and 1"),
            "hidden": (self.hidden >= 0, "not negative"),
            "epochs": (self.epochs >= 1, "at least 1"),
            "patience": (self.patience >= 1, "at least 1"),
            "learning_rate": (self.learning_rate > 0, "positive"),
            "weight_decay": (self.weight_decay >= 0, "not negative"),
            "batch_size": (self.batch_size >= 1, "at least 1"),
            "seed": (self.seed >= 0, "not negative"),
            "subdivision_steps": (0 <= self.subdivision_steps <= 3, "from 0 to 3"),
            "broken": (0 <= self.broken <= most_broken, f"from 0 to {MOST_BROKEN}; 0 for pictures of triangles"),
            "breaks": (
                set(self.breaks) <= set(BREAK_NAMES) and len(set(self.breaks)) == len(self.breaks),
                f"each of {list(BREAK_NAMES)} once at most",
            ),
        }
        for name, (fine, expected) in checks.items():
            if not fine:
                raise ClassifierError(f"is {getattr(self, name)!r}, must be {expected}", where=name)
        _ = self.look  # it checks its values

    @property
    def look(self) -> Look:
        """How pictures are drawn."""
        return Look(self.style, self.image_size, self.framing, self.window, self.scale_range)

    @classmethod
    def paper(cls, **changes: Any) -> "TrainingSettings":
        """The paper's counts, framing and scales, one light, one layer, classes and pictures alone (section 3.2)."""
        values: dict[str, Any] = {
            "variations": 1000,
            "images_per_variation": 10,
            "scale_range": SCALE_RANGE,
            "negatives": 0,
            "exemplars": False,
            "style": "lambert",
            "framing": "paper",
            "window": WINDOW,
            "broken": 0.0,
            "hidden": 0,
        }
        return cls(**(values | changes))

    def to_dict(self) -> dict[str, Any]:
        """The settings as JSON values."""
        return {**asdict(self), "scale_range": list(self.scale_range), "breaks": list(self.breaks)}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "TrainingSettings":
        """Settings from JSON values; what is missing keeps its default.

        Raises:
            ClassifierError: a name that is no setting, a value of a wrong type or that makes no sense.
        """
        known = checked_values(cls, values)
        if "scale_range" in known:
            known["scale_range"] = tuple(float(end) for end in known["scale_range"])
        if "breaks" in known:
            known["breaks"] = tuple(known["breaks"])
        return cls(**known)


def checked_values(settings: type, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return JSON values, each held against the type of a setting's default.

    Args:
        settings: a dataclass whose fields all have defaults.
        values: by the names of fields.

    Raises:
        ClassifierError: a name that is no setting, or a value of a wrong type.
    """
    defaults = {field.name: field.default for field in fields(settings)}
    for name, value in values.items():
        if name not in defaults:
            raise ClassifierError("no such setting", where=name)
        default = defaults[name]
        numbers = (int, float) if isinstance(default, float) else int
        if isinstance(default, tuple):
            kind = str if name == "breaks" else (int, float)
            fine = isinstance(value, (list, tuple)) and all(isinstance(part, kind) for part in value)
        elif isinstance(default, bool):
            fine = isinstance(value, bool)
        elif isinstance(default, str):
            fine = isinstance(value, str)
        else:
            fine = isinstance(value, numbers) and not isinstance(value, bool)
        if not fine:
            raise ClassifierError(f"is {value!r}, a value like {default!r} is expected", where=name)
    return dict(values)
