"""What a base made, as a script refers to it."""

from dataclasses import dataclass

from shapewright.modeling.elements import Element


@dataclass(frozen=True)
class Component:
    """A component that a base made.

    Attributes:
        whole: the component itself, to move all of it.
        faces: all its first faces; a prism or a box: bottom, top, sides.
    """

    whole: Element
    faces: tuple[Element, ...]

    @property
    def bottom(self) -> Element:
        """The first face of a prism or box, looking down its z."""
        return self.faces[0]

    @property
    def top(self) -> Element:
        """The second face of a prism or box, looking along its z."""
        return self.faces[1]

    @property
    def sides(self) -> tuple[Element, ...]:
        """The faces around a prism or box; a box: -y, +x, +y, -x."""
        return self.faces[2:]
