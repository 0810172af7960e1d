"""References to parts of a control mesh, and the symmetric images that operations act on together."""

import math
import re
import reprlib
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from shapewright.errors import ModelError

ElementKind = Literal["vertex", "edge", "face", "component"]
Axis = Literal["x", "y", "z"]

_KINDS: dict[str, ElementKind] = {"v": "vertex", "e": "edge", "f": "face", "c": "component"}
_LETTERS = {kind: letter for letter, kind in _KINDS.items()}
ELEMENT_PATTERN = "^[vefc](0|[1-9][0-9]{0,8})$"
AXES: tuple[Axis, ...] = ("x", "y", "z")


@dataclass(frozen=True, order=True, slots=True)
class Element:
    """A vertex, edge, face or component by its stable id; written ``v3``, ``e12``, ``f0``, ``c1``."""

    kind: ElementKind
    id: int

    @classmethod
    def parse(cls, text: str) -> "Element":
        """Read ``f12``.

        Raises:
            ModelError: the text is not a letter of ``v e f c`` followed by a number.
        """
        if not re.fullmatch(ELEMENT_PATTERN, text):
            raise ModelError(f"{reprlib.repr(text)} is not an element; write v, e, f or c and its number, like 'f12'")
        return cls(_KINDS[text[0]], int(text[1:]))

    def __str__(self) -> str:
        return f"{_LETTERS[self.kind]}{self.id}"


def vertex(vertex_id: int) -> Element:
    """Return the reference to a vertex."""
    return Element("vertex", vertex_id)


def edge(edge_id: int) -> Element:
    """Return the reference to an edge."""
    return Element("edge", edge_id)


def face(face_id: int) -> Element:
    """Return the reference to a face."""
    return Element("face", face_id)


@dataclass(frozen=True)
class Mirror:
    """Reflection in the plane through the origin whose normal is ``axis``."""

    axis: Axis

    def matrix(self) -> Float[np.ndarray, "3 3"]:
        """Return the linear map."""
        diagonal = np.ones(3)
        diagonal[AXES.index(self.axis)] = -1.0
        return np.diag(diagonal)


@dataclass(frozen=True)
class Turn:
    """Rotation about ``axis`` by a fixed, structural angle (radial copies: legs, blades, spokes)."""

    axis: Axis
    angle_deg: float

    def matrix(self) -> Float[np.ndarray, "3 3"]:
        """Return the linear map."""
        first = (AXES.index(self.axis) + 1) % 3
        second = (first + 1) % 3
        cosine, sine = math.cos(math.radians(self.angle_deg)), math.sin(math.radians(self.angle_deg))
        matrix = np.eye(3)
        matrix[first, first] = matrix[second, second] = cosine
        matrix[first, second], matrix[second, first] = -sine, sine
        return matrix


Image = tuple[Mirror | Turn, ...]


def image_matrix(image: Image) -> Float[np.ndarray, "3 3"]:
    """Return the product of the transforms, the first one applied first."""
    matrix = np.eye(3)
    for transform in image:
        matrix = transform.matrix() @ matrix
    return matrix


@dataclass(frozen=True, slots=True)
class Target:
    """Elements that move as one, and the frame in which they do.

    Attributes:
        elements: what moves; for an anchor, where the frame's origin is (none: the world's origin).
        frame: ``"own"`` is the frame of the first element, ``"world"`` the axes of the
            model, an element is that element's frame.
        image: empty, or the transforms that map the operation's *first* target onto this one. Then this target
            uses the image of the first target's frame, so that a model stays symmetric whatever its parameters.
        pivot: the elements about whose centre the target is scaled or turned, the hinge of a limb; none: about its
            own centre, or the operation's pivot. Other operations refuse it.
    """

    elements: tuple[Element, ...]
    frame: Literal["own", "world"] | Element = "own"
    image: Image = ()
    pivot: tuple[Element, ...] = ()


def group(*elements: Element, frame: Literal["own", "world"] | Element = "own") -> Target:
    """Return elements that move as one."""
    return Target(tuple(elements), frame)


def mirrored(axis: Axis, *elements: Element) -> Target:
    """Return the mirror image of the first target of an operation: these elements do the mirrored motion."""
    return Target(tuple(elements), image=(Mirror(axis),))


def turned(axis: Axis, angle_deg: float, *elements: Element) -> Target:
    """Return a turned copy of the first target of an operation."""
    return Target(tuple(elements), image=(Turn(axis, angle_deg),))


def imaged(image: Image, *elements: Element) -> Target:
    """Return the image of the first target of an operation under several transforms."""
    return Target(tuple(elements), image=image)
