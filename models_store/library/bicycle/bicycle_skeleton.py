"""A frame of tubes between named nodes in the plane of symmetry; when a node slides, the ends of its tubes follow."""

import math
from collections import defaultdict

from models_store.library.aids.beam import Crease, beam
from models_store.library.aids.loft import Loft, Section, move
from shapewright.modeling import Element, Mirror, Recorder, Target

Point = tuple[float, float]
NOWHERE: Point = (0.0, 0.0)
BOTH_SIDES = (Target((), "world"), Target((), "world", (Mirror("y"),)))


class Skeleton:
    """Tubes and axles; ``nodes`` are x and z of their places in the base model."""

    def __init__(self, recorder: Recorder, nodes: dict[str, Point]) -> None:
        self._recorder = recorder
        self._nodes = nodes
        self._ends: dict[str, list[Element]] = defaultdict(list)

    def tube(
        self,
        start: str,
        end: str,
        diameter: float | Point,
        *,
        spread: Point | None = None,
        side: float = 0.0,
        from_start: Point = NOWHERE,
        from_end: Point = NOWHERE,
        sides: int = 6,
        crease: Crease | None = None,
    ) -> Loft:
        """Lay a tube from node to node.

        Args:
            diameter: one, or those at start and end.
            spread: makes it a pair, this far from the plane of symmetry at start and end.
            side: shifts a single tube along y.
            from_start, from_end: how far its ends lie off the nodes, along x and z.
        """
        (x0, z0), (x1, z1) = (
            (self._nodes[node][0] + off[0], self._nodes[node][1] + off[1])
            for node, off in ((start, from_start), (end, from_end))
        )
        first, last = (diameter, diameter) if isinstance(diameter, float) else diameter
        y0, y1 = spread or (side, side)
        length = math.hypot(x1 - x0, z1 - z0)
        made = beam(
            self._recorder,
            "+x",
            [Section(0.0, first, first), Section(length, last, last)],
            sides=sides,
            crease=crease,
            offset=(x0, y0, z0),
            anchors=BOTH_SIDES if spread else (),
        )
        self._recorder.rotate(made.body(hinge=0), -math.degrees(math.atan2(z1 - z0, x1 - x0)), "v")
        if y1 != y0:
            move(self._recorder, made.sections(1), (0.0, y1 - y0, 0.0))
        for node, rings in ((start, made.rings[0]), (end, made.rings[1])):
            self._ends[node].extend(vertex for ring in rings for vertex in ring)
        return made

    def axle(self, node: str, diameter: float, width: float) -> Loft:
        """Put a short tube across the plane of symmetry at a node; later parts hang on it."""
        x, z = self._nodes[node]
        sections = [Section(y, diameter, diameter) for y in (-width / 2, width / 2)]
        made = beam(self._recorder, "+y", sections, sides=6, offset=(x, 0.0, z))
        self._ends[node].extend(vertex for ring in made.rings for vertex in ring[0])
        return made

    def slide(self, nodes: tuple[str, ...], by: Point, parameter: str) -> None:
        """Let a parameter x shift nodes by (x - 1) times a distance along x and z."""
        ends = [Target(tuple(vertex for node in nodes for vertex in self._ends[node]), "world")]
        move(self._recorder, ends, (-by[0], 0.0, -by[1]))
        move(self._recorder, ends, (by[0], 0.0, by[1]), length=parameter)


def middle(axle: Loft) -> Target:
    """Return the anchor in the middle of an axle."""
    return Target((axle.component.whole,), "world")
