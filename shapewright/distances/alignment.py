"""Poses, the 24 rotations between coordinate systems, and the paper's greedy realignment (section 3.3)."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from shapewright.errors import EstimationError

PointDistance = Callable[[Float[np.ndarray, "V 3"]], float]
"""Distance of an object to the query, of its posed points alone."""


@dataclass(frozen=True, eq=False)
class Pose:
    """A similarity that keeps orientation: ``apply(p) = scale * rotation @ p + translation``.

    Args:
        rotation: proper rotation matrix, acts on column vectors.
        translation: in the units of the target space.
        scale: factor of all lengths, positive.

    Raises:
        EstimationError: ``rotation`` is no proper rotation within 1e-6, or a figure is not finite, or
        ``scale``
            is not positive.
    """

    rotation: Float[np.ndarray, "3 3"] = field(default_factory=lambda: np.eye(3))
    translation: Float[np.ndarray, " 3"] = field(default_factory=lambda: np.zeros(3))
    scale: float = 1.0

    def __post_init__(self) -> None:
        rotation = np.ascontiguousarray(self.rotation, dtype=np.float64)
        translation = np.ascontiguousarray(self.translation, dtype=np.float64)
        if rotation.shape != (3, 3) or translation.shape != (3,):
            shapes = f"{rotation.shape} and {translation.shape}"
            raise EstimationError(f"expected shapes (3, 3) and (3,), got {shapes}")
        if not (np.isfinite(rotation).all() and np.isfinite(translation).all() and np.isfinite(self.scale)):
            raise EstimationError("a figure of the pose is NaN or infinite")
        if not self.scale > 0:
            raise EstimationError(f"the scale of a pose is positive, got {self.scale}", where="scale")
        proper = np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-6 and np.linalg.det(rotation) > 0
        if not proper:
            raise EstimationError("the matrix is no proper rotation", where="rotation")
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "translation", translation)
        object.__setattr__(self, "scale", float(self.scale))

    @cached_property
    def _linear(self) -> Float[np.ndarray, "3 3"]:
        return np.ascontiguousarray((self.scale * self.rotation).T)

    def apply(self, points: Float[np.ndarray, "*N 3"]) -> Float[np.ndarray, "*N 3"]:
        """The points in the target space."""
        return np.asarray(points @ self._linear + self.translation)

    def inverse(self) -> "Pose":
        """The pose that takes everything back."""
        scale = 1.0 / self.scale
        return Pose(self.rotation.T, -scale * (self.rotation.T @ self.translation), scale)

    def compose(self, inner: "Pose") -> "Pose":
        """This pose after ``inner``: ``a.compose(b).apply(p) == a.apply(b.apply(p))``."""
        return Pose(
            self.rotation @ inner.rotation,
            self.scale * (self.rotation @ inner.translation) + self.translation,
            self.scale * inner.scale,
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain lists and floats, ready for JSON."""
        return {
            "rotation": self.rotation.tolist(),
            "translation": self.translation.tolist(),
            "scale": self.scale,
        }


def rotations_24() -> Float[np.ndarray, "24 3 3"]:
    """The proper rotations that map the axes of a coordinate system onto axes (section 3.3, layer 2).

    Ordered as the paper counts them: the x-axis to each of +x, +y, +z, -x, -y, -z, and for each of these four
    turns about it. The first is the identity.
    """
    rotations = []
    axes = np.eye(3)
    for target in (*axes, *-axes):
        side = np.roll(np.abs(target), 1)
        other = np.cross(target, side)
        quarter_turns = (side, other, -side, -other)
        rotations += [np.stack([target, turned, np.cross(target, turned)], axis=1) for turned in quarter_turns]
    return np.stack(rotations)


@dataclass(frozen=True)
class AlignmentSettings:
    """Steps and limits of the greedy realignment; the defaults are the paper's.

    Args:
        translation_step: in the units of the normalised query (its coordinates reach from -1 to 1).
        rotation_step_rad: turn about each axis of the query, 0.01 * 180 degrees.
        scale_step: share of the original scale.
        scale_limits: smallest and largest share of the original scale.

    Raises:
        EstimationError: a step is not positive, or the limits do not enclose 1.
    """

    translation_step: float = 0.01
    rotation_step_rad: float = 0.01 * np.pi
    scale_step: float = 0.01
    scale_limits: tuple[float, float] = (0.5, 1.5)

    def __post_init__(self) -> None:
        for name in ("translation_step", "rotation_step_rad", "scale_step"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise EstimationError(f"a step is positive and finite, got {value}", where=name)
        low, high = self.scale_limits
        if not 0 < low <= 1 <= high < np.inf:
            raise EstimationError(f"the limits enclose 1, got {low} to {high}", where="scale_limits")


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where a realignment ended: the pose, its distance, and how many poses were measured on the way."""

    pose: Pose
    distance: float
    probes: int


def realign(
    points: Float[np.ndarray, "V 3"],
    distance: PointDistance,
    pose: Pose,
    settings: AlignmentSettings | None = None,
    *,
    original_scale: float | None = None,
    known_distance: float | None = None,
    checkpoint: Callable[[], None] | None = None,
) -> Alignment:
    """Greedy search for the best translation, rotation and scale (paper section 3.3).

    Like the search for parameters: one round tries one fixed step in both directions along each axis, about
    each axis and in scale, keeps whatever lowers the distance, and rounds go on until one changes nothing.
    Turning and scaling leave the mean of the points where it is (ours; about the origin they would also move
    the object).

    Two kinds of probes are left out, as they cannot change the outcome: the step straight back after one that
    was kept, and those of the last round that the round before has already refused at the same pose.

    Args:
        points: the object in its own space; only transformed, never generated anew.
        distance: measures posed points.
        pose: where to begin, own space to query space.
        settings: steps and limits.
        original_scale: what the scale limits and steps are shares of; the scale of ``pose`` if not given.
        known_distance: distance at ``pose``, if the caller has it.
        checkpoint: called once a round; may raise to stop the search.
    """
    settings = settings or AlignmentSettings()
    unit = pose.scale if original_scale is None else original_scale
    mean = points.mean(axis=0)
    turns = _turns(settings.rotation_step_rad)
    best = distance(pose.apply(points)) if known_distance is None else known_distance
    probes = int(known_distance is None)
    move, refused, back = 0, 0, -1
    while refused < _MOVES:
        if move == 0 and checkpoint is not None:
            checkpoint()
        refused += 1
        candidate = None if move == back else _moved(pose, move, mean, turns, unit, settings)
        if candidate is not None:
            measured = distance(candidate.apply(points))
            probes += 1
            if measured < best - _NOISE * abs(best):
                pose, best = candidate, measured
                refused, back = 0, move ^ 1
        move = (move + 1) % _MOVES
    return Alignment(pose, best, probes)


_NOISE = 1e-12  # of the distance: less is rounding, and would let a search drift on a plateau
_MOVES = 14  # both directions of three translations, three rotations and the scale


def _turns(angle_rad: float) -> Float[np.ndarray, "3 2 3 3"]:
    """Rotation about each axis by plus and minus an angle."""
    identity = np.eye(3)
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    turns = np.empty((3, 2, 3, 3))
    for axis, vector in enumerate(identity):
        along = np.outer(vector, vector)
        quarter = np.cross(vector, identity).T  # quarter @ p == cross(vector, p)
        turns[axis, 0] = along + cosine * (identity - along) + sine * quarter
        turns[axis, 1] = turns[axis, 0].T
    return turns


def _moved(
    pose: Pose,
    move: int,
    mean: Float[np.ndarray, " 3"],
    turns: Float[np.ndarray, "3 2 3 3"],
    unit: float,
    settings: AlignmentSettings,
) -> Pose | None:
    """The pose after one step; None if the step leaves the limits of the scale."""
    coordinate, direction = divmod(move, 2)
    sign = 1 - 2 * direction
    rotation, translation, scale = pose.rotation, pose.translation, pose.scale
    if coordinate < 3:
        translation = translation.copy()
        translation[coordinate] += sign * settings.translation_step
        return _unchecked(rotation, translation, scale)
    pivot = pose.apply(mean)
    if coordinate < 6:
        rotation = turns[coordinate - 3, direction] @ rotation
    else:
        low, high = settings.scale_limits
        scale += sign * settings.scale_step * unit
        if not low * unit * (1 - 1e-9) <= scale <= high * unit * (1 + 1e-9):
            return None
    return _unchecked(rotation, pivot - scale * (rotation @ mean), scale)


def _unchecked(rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"], scale: float) -> Pose:
    """A pose whose parts are known to be right; probes are many, and the checks would cost as much as some of them.

    Products of rotations lose orthogonality by rounding alone, 1e-12 after a million steps.
    """
    pose = object.__new__(Pose)
    object.__setattr__(pose, "rotation", rotation)
    object.__setattr__(pose, "translation", translation)
    object.__setattr__(pose, "scale", scale)
    return pose
