"""Directions to look from: random ones to learn with, evenly spread ones, and one for people.

A view is a rotation matrix that turns the object; the camera never moves. It looks along -z with y up.
"""

from typing import Literal

import numpy as np
from jaxtyping import Float

from shapewright.rendering.styles import SCALE_RANGE

UpAxis = Literal["y", "z"]


def random_views(
    rng: np.random.Generator, count: int, *, scale_range: tuple[float, float] = SCALE_RANGE
) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
    """Rotations drawn uniformly from all rotations, scales drawn uniformly from a range (paper section 3.2).

    Returns:
        Rotation matrices (N, 3, 3) and scales (N,).
    """
    return _random_rotations(rng, count), rng.uniform(*scale_range, size=count)


def spread_views(
    rng: np.random.Generator, count: int, *, scale_range: tuple[float, float] = SCALE_RANGE
) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
    """As :func:`random_views`, but the directions are spread evenly over the sphere, which is turned at random.

    Each rotation alone is still uniformly random, and so is each scale.
    """
    directions = even_views(count)
    angles_rad = rng.uniform(0.0, 2.0 * np.pi, count)
    rolls = np.array([_about("z", angle_rad) for angle_rad in angles_rad]).reshape(count, 3, 3)
    (whole,) = _random_rotations(rng, 1)
    return np.asarray(rolls @ directions @ whole), rng.uniform(*scale_range, size=count)


def views_about(
    rng: np.random.Generator,
    direction: Float[np.ndarray, "3"],
    count: int,
    *,
    farthest_rad: float,
    scale_range: tuple[float, float] = SCALE_RANGE,
) -> tuple[Float[np.ndarray, "N 3 3"], Float[np.ndarray, " N"]]:
    """Views from one direction and from around it, turned about the line of sight at random.

    Args:
        rng: source of the random numbers.
        direction: from the object to the viewer, a unit vector.
        count: number of views.
        farthest_rad: angle from the direction that no view exceeds; within, all views are equally probable.
        scale_range: scales are drawn uniformly from it.

    Returns:
        Rotation matrices (N, 3, 3) and scales (N,).
    """
    heights = rng.uniform(np.cos(farthest_rad), 1.0, count)
    tilts_rad, azimuths_rad, rolls_rad = np.arccos(heights), *rng.uniform(0.0, 2.0 * np.pi, (2, count))
    aim = _look_from(direction)
    rotations = [
        _about("z", roll) @ _about("x", tilt) @ _about("z", azimuth) @ aim
        for roll, tilt, azimuth in zip(rolls_rad, tilts_rad, azimuths_rad, strict=True)
    ]
    return np.array(rotations).reshape(count, 3, 3), rng.uniform(*scale_range, size=count)


def even_views(count: int) -> Float[np.ndarray, "N 3 3"]:
    """Rotations that look at an object from evenly spread directions, the object's y axis upwards.

    The directions lie on a Fibonacci sphere, the same ones each time.
    """
    steps = np.arange(count) + 0.5
    height = 1.0 - 2.0 * steps / max(count, 1)
    azimuth_rad = np.pi * (1.0 + np.sqrt(5.0)) * steps
    radius = np.sqrt(np.maximum(0.0, 1.0 - height * height))
    directions = np.stack([radius * np.sin(azimuth_rad), height, radius * np.cos(azimuth_rad)], axis=1)
    return np.stack([_look_from(direction) for direction in directions]) if count else np.zeros((0, 3, 3))


def _look_from(direction: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Turn ``direction`` (a unit vector) towards the camera, y as far up as it goes."""
    up = np.array([0.0, 1.0, 0.0]) if abs(direction[1]) < 0.999 else np.array([0.0, 0.0, -1.0])
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(direction, right), direction])


def three_quarter_view(
    up: UpAxis = "y", *, azimuth_rad: float = np.deg2rad(35.0), elevation_rad: float = np.deg2rad(22.0)
) -> Float[np.ndarray, "3 3"]:
    """A view from the front, the side and a little above: what product pictures use.

    Args:
        up: the axis of the object that points upwards.
        azimuth_rad: turn about the upright axis.
        elevation_rad: height of the camera above the horizon.
    """
    upright = _about("x", -np.pi / 2) if up == "z" else np.eye(3)
    return np.asarray(_about("x", elevation_rad) @ _about("y", -azimuth_rad) @ upright)


def _random_rotations(rng: np.random.Generator, count: int) -> Float[np.ndarray, "{count} 3 3"]:
    """Draw rotation matrices uniformly, by normal quaternions.

    The numbers are those of ``scipy.spatial.transform.Rotation.random``, without the time that loading scipy takes.
    """
    quaternions = rng.normal(size=(count, 4))
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [x * x - y * y - z * z + w * w, 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), -x * x + y * y - z * z + w * w, 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), -x * x - y * y + z * z + w * w],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def _about(axis: Literal["x", "y", "z"], angle_rad: float) -> Float[np.ndarray, "3 3"]:
    """Rotate about a coordinate axis, counter-clockwise seen from its positive end."""
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(3)
    matrix[[first, second], [first, second]] = np.cos(angle_rad)
    matrix[second, first] = np.sin(angle_rad)
    matrix[first, second] = -np.sin(angle_rad)
    return matrix
