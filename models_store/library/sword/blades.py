"""Modelling aid for swords: blade and grip along the z axis, the tip upwards, the edges towards +x and -x.

The grip's upper end lies at z = 0. Blades are sketched straight, with width and thickness 1; then they get their
profile, their sizes, and at last they are bent. Parameters have the same names in all swords: ``blade_length``,
``blade_width``, ``blade_thickness``, ``tip_length``, ``grip_length``, ``grip_thickness``, ``pommel_width``,
``pommel_length``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from models_store.library.aids.lathe import Lathe, Ring, control_diameter, widen
from models_store.library.aids.loft import move
from shapewright.modeling import Component, Element, Mirror, Recorder, Target, group

HILT_SIDES = 8
RIDGE = 1.5  # thickness of a blade's control mesh, relative to the blade's


@dataclass(frozen=True)
class Blade:
    """A blade of lenticular section with two sharp edges.

    Attributes:
        rings: sections from the root to the tip, of four vertices each.
        tip: number of the section where the tip begins.
    """

    component: Component
    rings: tuple[Ring, ...]
    tip: int

    def beyond(self, level: int) -> Target:
        """Return all sections from one on, along the model's axes."""
        return group(*(vertex for ring in self.rings[level:] for vertex in ring), frame="world")


def blade(
    recorder: Recorder, anchor: Target, length: float, tip: float, *, root: float, segments: int, tip_segments: int = 2
) -> Blade:
    """Raise a straight blade of width and thickness 1 from a depth ``root`` below its anchor."""
    segment = 1.0 / segments
    made = recorder.base("prism", (1.0, RIDGE, segment), sides=4, offset=(0.0, 0.0, -root), anchors=anchor)[0]
    column = Lathe(recorder, made)
    rings = [column.bottom, column.top, *(column.rise(segment) for _ in range(segments - 1))]
    recorder.scale(group(made.whole, frame="world"), length, "z", pivot=made.bottom, size="blade_length")
    rings += [column.rise(tip / tip_segments, length="tip_length") for _ in range(tip_segments)]
    result = Blade(made, tuple(rings), segments)
    sharp = []
    for lower, upper in pairwise(rings):
        for start, end in zip(edge_vertices(recorder, lower), edge_vertices(recorder, upper), strict=True):
            sharp.append(Element("edge", recorder.mesh.edge_between(start.id, end.id)))
    recorder.mark_sharp(*sharp, made.bottom, made.top)
    return result


def hone(recorder: Recorder, made: Blade, losses: Sequence[float], *, sides: str = "both", length: str = "") -> None:
    """Move the edges inwards, before the blade gets its width.

    Args:
        losses: one for each section after the root: how far each edge moves inwards (below 0: outwards).
        sides: ``both``, ``+x`` or ``-x``.
        length: the parameter that varies all of them, if any.
    """
    for ring, loss in zip(made.rings[1:], losses, strict=True):
        if loss == 0.0:
            continue
        right, left = edge_vertices(recorder, ring)
        ends = [Target((right,), "world"), Target((left,), "world", (Mirror("x"),))]
        moved = {"both": ends, "+x": ends[:1], "-x": [Target((left,), "world")]}[sides]
        towards = 0.0 if sides == "-x" else 180.0
        if length:
            recorder.drag(moved, rho=loss, phi_deg=towards, length=length)
        else:
            recorder.drag(moved, rho=loss, phi_deg=towards)


def point(recorder: Recorder, made: Blade, widths: Sequence[float], *, thickness: float = 0.3, size: str = "") -> None:
    """Narrow the sections of the tip; ``size`` names the parameter that varies the width of the last one, if any."""
    *inner, end = range(len(made.rings) - len(widths), len(made.rings))
    for level, width in zip(inner, widths, strict=False):
        recorder.scale(group(*made.rings[level], frame="world"), width, "u")
    last = group(*made.rings[end], frame="world")
    if size:
        recorder.scale(last, widths[-1], "u", size=size)
    else:
        recorder.scale(last, widths[-1], "u")
    recorder.scale(last, thickness, "v")


def shift_tip(recorder: Recorder, made: Blade, shifts: Sequence[float], *, length: str) -> None:
    """Move the last sections towards +x, the spine of a blade with one edge, before the blade gets its width."""
    for ring, shift in zip(made.rings[-len(shifts) :], shifts, strict=True):
        move(recorder, [group(*ring, frame="world")], (shift, 0.0, 0.0), length=length)


def give_size(recorder: Recorder, made: Blade, width: float, thickness: float) -> None:
    """Set width and thickness of the whole blade."""
    whole = group(made.component.whole, frame="world")
    recorder.scale(whole, width, "u", pivot=made.component.bottom, size="blade_width")
    recorder.scale(whole, thickness, "v", pivot=made.component.bottom, size="blade_thickness")


def bend(recorder: Recorder, made: Blade, angle_deg: float, *, angle: str) -> None:
    """Bend the blade evenly towards +x, section by section; ``angle_deg`` is the sum."""
    step_deg = angle_deg / (len(made.rings) - 1)
    for level in range(1, len(made.rings)):
        hinge = max(made.rings[level - 1], key=lambda vertex: float(recorder.positions(vertex)[0, 1]))
        recorder.rotate(made.beyond(level), step_deg, "v", pivot=hinge, angle=angle)


def edge_vertices(recorder: Recorder, ring: Ring) -> tuple[Element, Element]:
    """Return the vertices of a section that lie on the blade's edges, the one towards +x first."""
    in_order = sorted(ring, key=lambda vertex: float(recorder.positions(vertex)[0, 0]))
    return in_order[-1], in_order[0]


@dataclass(frozen=True)
class Grip:
    """A round column downwards, and the pommel at its end.

    Attributes:
        handle: rings from the upper end on.
        knob: rings of the pommel.
    """

    component: Component
    handle: tuple[Ring, ...]
    knob: tuple[Ring, ...]

    @property
    def top(self) -> Target:
        """The upper end, as an anchor along the model's axes."""
        return group(*self.handle[0], frame="world")

    @property
    def end(self) -> Target:
        """The lower end of the handle, as an anchor along the model's axes."""
        return group(*self.handle[-1], frame="world")

    def all(self) -> Target:
        """Return everything, to be scaled along the model's axes."""
        return group(self.component.whole, frame="world")


def grip(
    recorder: Recorder,
    length: float,
    diameter: float,
    swell: Sequence[float],
    pommel: float,
    knob: Sequence[float],
    *,
    pommel_width: float | None = None,
    ribs: int = 0,
    rib: float = 1.0,
) -> Grip:
    """Model a grip from z = 0 downwards.

    Args:
        swell: widths of the handle's rings relative to its diameter, at least three, from the upper end to the lower.
        pommel: height of the pommel, and its diameter unless ``pommel_width`` is given.
        knob: widths of the pommel's rings relative to its diameter, at least two.
        ribs: how many ribs the handle has, such as windings of wire; then ``swell`` is spread over more rings.
        rib: width of a rib, relative to the handle there; the parameter ``grip_ribs`` varies it.
    """
    start = 0.04 * length
    made = recorder.prism(HILT_SIDES, control_diameter(1.0, HILT_SIDES), start, offset=(0.0, 0.0, -start))
    column = Lathe(recorder, made, downwards=True)
    if ribs:
        places = np.linspace(0.0, len(swell) - 1.0, 2 * ribs + 3)
        swell = [float(width) for width in np.interp(places, np.arange(len(swell)), swell)]
    step = (length - start) / (len(swell) - 2)
    handle = [column.bottom, column.top, *(column.rise(step, length="grip_length") for _ in swell[2:])]
    share = pommel / (len(knob) - 0.5)
    knobs = [column.rise(share if i else 0.5 * share, length="pommel_length") for i in range(len(knob))]
    widen(recorder, handle, diameter, size="grip_thickness")
    widen(recorder, knobs, pommel_width or pommel, size="pommel_width")
    for ring, width in zip((*handle, *knobs), (*swell, *knob), strict=True):
        if width != 1.0:
            widen(recorder, [ring], width)
    if ribs:
        widen(recorder, handle[2:-1:2], rib, size="grip_ribs")
    return Grip(made, tuple(handle), tuple(knobs))
