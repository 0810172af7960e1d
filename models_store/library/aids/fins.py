"""Modelling aid for thin plates: fins, wings, feathers, tails. All are closed, with a lens as their section."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import ORIGIN, Loft, Section, Vector, loft
from shapewright.modeling import Element, Recorder, Target
from shapewright.modeling.elements import Axis

PLATE_SIDES = 4
FAN_SIDES = 8


@dataclass(frozen=True)
class Rib:
    """One section of a plate: where it lies, from where to where it reaches, how thick it is and how far off."""

    at: float
    low: float
    high: float
    thickness: float
    off: float = 0.0


def plate(
    recorder: Recorder,
    axis: Axis,
    across: Axis,
    ribs: Sequence[Rib],
    *,
    offset: Vector = ORIGIN,
    anchors: Sequence[Target] = (),
) -> Loft:
    """Model a plate along ``axis`` whose ribs reach along ``across``; its two long edges are sharp."""
    first = next(name for name in "xyz" if name != axis)
    sections = []
    for rib in ribs:
        extents = (rib.high - rib.low, control_diameter(rib.thickness, PLATE_SIDES))
        shifts = ((rib.low + rib.high) / 2, rib.off)
        if first != across:
            extents, shifts = extents[::-1], shifts[::-1]
        sections.append(Section(rib.at, *extents, shifts))
    made = loft(recorder, axis, sections, sides=PLATE_SIDES, offset=offset, anchors=anchors)
    _sharpen(recorder, made, across)
    return made


@dataclass(frozen=True)
class Fan:
    """A tail that widens towards its end; ``loft`` begins at the root and lies towards -x."""

    loft: Loft
    across: Axis

    def fork(self, recorder: Recorder, depth: float, length: str) -> None:
        """Draw the two ends of the fan back by a depth, what lies between in proportion; below 0: a wedge.

        ``length`` names the parameter that varies it.
        """
        for section, share in ((-1, 1.0), (-2, 0.25)):
            ring = self.loft.rings[section][0]
            centre = {v: float(recorder.positions(v)[0, "xyz".index(self.across)]) for v in ring}
            middle = sum(centre.values()) / len(centre)
            widest = max(abs(c - middle) for c in centre.values())
            ends = [Target((v,), "world") for v, c in centre.items() if abs(c - middle) > 0.9 * widest]
            between = [Target((v,), "world") for v, c in centre.items() if 0.1 < abs(c - middle) / widest <= 0.9]
            recorder.drag(ends, rho=share * depth, phi_deg=180.0, length=length)
            recorder.drag(between, rho=0.5 * share * depth, phi_deg=180.0, length=length)


def fan(
    recorder: Recorder,
    across: Literal["y", "z"],
    length: float,
    widths: Sequence[float],
    thickness: float,
    *,
    offset: Vector = ORIGIN,
    anchor: Target | None = None,
) -> Fan:
    """Model a tail of a length with widths from its root to its end, evenly spaced."""
    thin = [control_diameter(thickness * share, FAN_SIDES) for share in (1.0, 0.9, 0.8, 0.5)[-len(widths) :]]
    steps = [length * number / (len(widths) - 1) for number in range(len(widths))]
    sections = [
        Section(at, *((w, t) if across == "y" else (t, w))) for at, w, t in zip(steps, widths, thin, strict=True)
    ]
    body = loft(recorder, "x", sections, sides=FAN_SIDES, offset=offset, anchors=[anchor] if anchor else ())
    _sharpen(recorder, body, across)
    _divide_end(recorder, body, across)
    recorder.rotate(body.body(hinge=0), 180.0, "z")
    return Fan(body, across)


def _sharpen(recorder: Recorder, body: Loft, across: Axis) -> None:
    """Crease the two edges of a plate between its two faces."""
    place = "xyz".index(across)
    edges = []
    for copy in range(len(body.images)):
        in_order = [sorted(ring[copy], key=lambda v: float(recorder.positions(v)[0, place])) for ring in body.rings]
        for end in (0, -1):
            line = [ring[end] for ring in in_order]
            edges += [Element("edge", recorder.mesh.edge_between(a.id, b.id)) for a, b in pairwise(line)]
    recorder.mark_sharp(*edges)


def _divide_end(recorder: Recorder, body: Loft, across: Axis) -> None:
    """Cut the end face of a fan into strips, so that a fork is not filled."""
    place = "xyz".index(across)
    ring = sorted(body.rings[-1][0], key=lambda v: float(recorder.positions(v)[0, place]))
    for start, end in zip(ring[1:-1:2], ring[2:-1:2], strict=True):
        recorder.connect(start, end)


def with_parts(targets: Sequence[Target], *parts: Loft) -> list[Target]:
    """Return targets of a body and its copies that take along what hangs on each: the copies of ``parts``."""
    together = []
    for number, target in enumerate(targets):
        hanging: tuple[Element, ...] = tuple(part.components[number].whole for part in parts)
        together.append(Target((*target.elements, *hanging), target.frame, target.image, target.pivot))
    return together
