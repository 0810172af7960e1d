"""Modelling aid for swords: what guards the hand, hung on the upper end of the grip.

Names of parameters that these guards vary: ``bar_length``, ``bar_thickness``, ``bar_bend``, ``bar_end``;
``disc_width``, ``disc_depth``, ``disc_dome``; ``bow_width`` and the grip's ``grip_length``.
"""

import math

from models_store.library.aids.lathe import Lathe, Ring, control_diameter, widen
from models_store.library.aids.loft import Loft, Vector
from models_store.library.sword.blades import Grip
from models_store.library.sword.tubes import tube
from shapewright.modeling import Component, Mirror, Recorder, Target, group

DISC_SIDES = 12
BAR_SIDES = 6


def bar(recorder: Recorder, grip: Grip, length: float, diameter: float, end: float, bend_deg: float) -> Loft:
    """Two arms towards +x and -x, with thicker ends, each bent evenly by ``bend_deg`` towards the blade.

    Args:
        length: of each arm, from the middle of the grip.
        end: thickness of the ends, relative to the arms.
    """
    root = 0.1 * length
    step = 0.3 * length
    knob = 0.6 * diameter
    xs = [0.0, root, root + step, root + 2 * step, root + 3 * step]
    xs += [xs[-1] + share * knob for share in (0.7, 1.7, 2.2)]
    path: list[Vector] = [(x, 0.0, 0.0) for x in xs]
    anchors = [grip.top, Target(grip.top.elements, "world", (Mirror("x"),))]
    lengths = ["bar_length"] * 3 + ["bar_thickness"] * 3
    widths = [diameter * 12 / 11] * 5 + [diameter * 12 / 11 * share for share in (end, end, 0.55 * end)]
    arms = tube(recorder, path, widths, normal="z", anchors=anchors, sides=BAR_SIDES, lengths=lengths)
    recorder.mark_sharp(*(arm.bottom for arm in arms.components))  # so that the arms meet without a waist
    for level in range(len(xs)):
        across = arms.sections(level)
        recorder.scale(across, 1.0, "vz", size="bar_thickness")
    ends = arms.sections(5, 6, 7)
    recorder.scale(ends, 1.0, "vz", size="bar_end")
    for level in (1, 2, 3):
        recorder.rotate(arms.beyond(level + 1, hinge=level), -bend_deg / 3, "v", angle="bar_bend")
    return arms


def disc(
    recorder: Recorder, grip: Grip, width: float, depth: float, thickness: float, dome: float
) -> tuple[Component, list[Ring]]:
    """A round or oval plate across the grip, whose middle bulges towards the blade: from a disc to a half ball.

    Args:
        width, depth: along x and y.
        dome: height of the bulge.
    """
    offset = (0.0, 0.0, -thickness / 2)
    diameter = control_diameter(1.0, DISC_SIDES)
    plate = recorder.prism(DISC_SIDES, diameter, thickness, offset=offset, anchor=grip.top)
    recorder.mark_sharp(plate.bottom)
    recorder.mark_sharp(plate.top)
    column = Lathe(recorder, plate)
    rings = [column.bottom, column.top]
    rings += [column.rise(dome * share, length="disc_dome") for share in (0.45, 0.40, 0.15)]
    recorder.extrude(plate.bottom, 0.0)
    recorder.scale(plate.bottom, 0.6)
    for ring, share in zip(rings[2:], (0.88, 0.55, 0.2), strict=True):
        widen(recorder, [ring], share)
    whole = group(plate.whole, frame="world")
    recorder.scale(whole, width, "u", size="disc_width")
    recorder.scale(whole, depth, "v", size="disc_depth")
    return plate, rings


def bow(recorder: Recorder, grip: Grip, width: float, length: float, diameter: float, anchors: list[Target]) -> Loft:
    """A bow on the side of -x from the guard to the end of a grip of this length, and its symmetric copies."""
    path: list[Vector] = []
    for i in range(10):
        angle = math.pi * i / 9
        path.append((-width * math.sin(angle) ** 0.75, 0.0, -length / 2 * (1.0 - math.cos(angle))))
    made = tube(recorder, path, [diameter] * len(path), normal="y", anchors=anchors)
    copies = zip(made.components, made.images, strict=True)
    whole = [Target((component.whole,), "world", image, grip.handle[0]) for component, image in copies]
    recorder.scale(whole, 1.0, "z", size="grip_length")
    recorder.scale(whole, 1.0, "u", size="bow_width")
    return made
