"""Models a round, oval or round-cornered table on three, four or six legs.

Legs hang on a ring of vertices in the underside of the top, so they follow its outline wherever it goes.
"""

import math
from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.boards import ACROSS, QUADRANTS, board, pull, shift, stretch
from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import Loft, Section, move
from models_store.library.author import publish
from shapewright.modeling import Component, Element, ProceduralModel, Recorder, Target, Turn, group, when

SIDES = 12
DIAMETER, THICKNESS, UNDERSIDE = 1.0, 0.035, 0.96  # the underside's width is relative to the top's
LEG_LENGTH, LEG_THICKNESS, FOOT = 0.65, 0.05, 0.8
LEG_CIRCLE = 0.36  # radius
KNEE = 0.5  # its height, as a share of the leg
KNEE_SHIFT = 0.04
SPLAY = 0.02
ROUND_SIDES = 6
FULLNESS = 0.10  # how far the corners of a round-cornered top lie outside of a round one
APRON_HEIGHT, APRON_THICKNESS = 0.07, 0.02
RING_DROP, RING_THICKNESS = 0.06, 0.02
LEGS: dict[int, tuple[tuple[int, ...], ...]] = {
    4: ((1, 2), (4, 5), (7, 8), (10, 11)),
    3: ((0,), (4,), (8,)),
    6: ((0,), (2,), (4,), (6,), (8,), (10,)),
}
"""For each number of legs the vertices of the ring (every 30 degrees) between which each hangs."""


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table_round",
        "table",
        unit_m=1.0,
        description="A round, oval or round-cornered table on three, four or six legs.",
    )
    _declare(r)
    top, ring = _top(r)
    drum, tube, rails = _aprons(r)
    around = (*ring, drum.whole, tube.whole, *(rail.whole for rail in rails))
    r.scale(group(*around, frame="world"), 1.0, "uv", size="leg_circle")
    _square_up(r, [top, drum, tube], rails)
    outline = group(top.whole, *around[len(ring) :], frame="world")
    r.scale(outline, 1.0, "uv", size="top_diameter")
    r.scale(outline, 1.0, "v", size="top_width")
    pull(r, [drum, *rails], "z", -APRON_HEIGHT, "apron_height", beyond=-APRON_HEIGHT / 2)
    pull(r, [tube], "z", -RING_DROP, "apron_height", beyond=0.0)

    sets = [(count, sides) for count in LEGS for sides in (4, ROUND_SIDES)]
    legs = [_legs(r, ring, count, sides) for count, sides in sets]
    _shape_legs(r, legs, [LEGS[count] for count, _ in sets], top)
    for (count, sides), made in zip(sets, legs, strict=True):
        conditions = [when("leg_count", list(LEGS).index(count) + 1), when("leg_section", 1 if sides == 4 else 2)]
        r.part(f"{count} {'square' if sides == 4 else 'round'} legs", made.components, conditions)
    r.part("apron drum", [drum], [when("apron", 2)])
    r.part("ring", [tube], [when("apron", 3)])
    r.part("apron rails", rails, [when("apron", 4), when("leg_count", 1)])
    r.symmetry(mirrors=("y",))
    return r.build()


def _declare(r: Recorder) -> None:
    r.parameter("top_diameter", "Top diameter", 0.6, 1.6, unit="m", base_value=DIAMETER)
    r.parameter("top_thickness", "Top thickness", 0.3, 3.0, unit="m", base_value=THICKNESS)
    r.parameter("underside_width", "Underside (relative to the top)", 0.9, 1.04, base_value=UNDERSIDE)
    r.choice("outline", "Outline of the top", ("round", "oval", "round corners"))
    oval, cornered = (when("outline", 2, 3),), (when("outline", 3),)
    r.parameter("top_width", "Top width (relative to its length)", 0.5, 1.0, base_value=1.0, active_when=oval)
    r.parameter("corner_fullness", "Fullness of the corners (1 is round)", 1.0, 2.2, active_when=cornered)
    r.choice("leg_count", "Legs", ("four", "three", "six"))
    r.choice("leg_section", "Section of the legs", ("square", "round"))
    r.parameter("leg_length", "Leg length", 0.3, 1.6, unit="m", base_value=LEG_LENGTH)
    r.parameter("leg_thickness", "Leg thickness", 0.4, 2.4, unit="m", base_value=LEG_THICKNESS)
    r.limit("leg_thickness", maximum=("top_diameter", 0.0, 2.4))
    r.parameter("foot_thickness", "Foot thickness (relative to the upper end)", 0.4, 1.25, base_value=FOOT)
    r.parameter("leg_circle", "Radius of the circle of legs (relative to the top)", 0.45, 1.3, base_value=LEG_CIRCLE)
    r.limit("leg_circle", maximum=("leg_thickness", 1.37, -0.11))
    r.parameter("leg_splay", "Leg splay (shift of the feet outwards)", -0.5, 10.0, unit="m", base_value=SPLAY)
    r.limit("leg_splay", maximum=("leg_circle", 20.0, -14.0))
    r.limit("leg_splay", maximum=("leg_length", 0.0, 10.0))
    r.choice("leg_form", "Form of the legs", ("straight", "bent at a knee"))
    bent = (when("leg_form", 2),)
    r.parameter("knee_shift", "Shift of the knee inwards (1 is straight)", 0.5, 3.0, active_when=bent)
    r.choice("apron", "Beneath the top", ("nothing", "drum", "ring", "rails between four legs"))
    some = (when("apron", 2, 4),)
    r.parameter("apron_height", "Apron height", 0.4, 2.0, unit="m", base_value=APRON_HEIGHT, active_when=some)
    r.limit("apron_height", maximum=("leg_length", 0.0, 4.0))


def _top(r: Recorder) -> tuple[Component, tuple[Element, ...]]:
    """A disc with its underside at z = 0, and the ring of vertices that was drawn into the underside."""
    top = r.prism(SIDES, control_diameter(DIAMETER, SIDES), THICKNESS)
    r.mark_sharp(top.bottom, top.top)
    r.scale(Target((top.whole,), "world"), 1.0, "z", pivot=top.bottom, size="top_thickness")
    r.scale(Target((top.bottom,), "world"), UNDERSIDE, "uv", size="underside_width")
    r.extrude(top.bottom, 0.0)
    r.scale(top.bottom, 2 * LEG_CIRCLE / control_diameter(DIAMETER, SIDES) / UNDERSIDE, "uv")
    r.extrude(top.top, 0.0)
    r.scale(top.top, 0.6, "uv")
    ring = sorted(r.vertices_of(top.bottom), key=lambda v: math.atan2(*r.positions(v)[0, 1::-1]) % (2 * math.pi - 1e-9))
    return top, tuple(ring)


def _aprons(r: Recorder) -> tuple[Component, Component, list[Component]]:
    """A drum and a ring as wide as the circle of legs, and rails between four legs."""
    drum = r.prism(SIDES, 2 * LEG_CIRCLE, APRON_HEIGHT, offset=(0.0, 0.0, -APRON_HEIGHT))
    r.mark_sharp(drum.bottom, drum.top)
    size = (2 * LEG_CIRCLE + RING_THICKNESS, 2 * LEG_CIRCLE + RING_THICKNESS, RING_THICKNESS)
    tube = r.base("ring", size, sides=SIDES, tube_sides=4, offset=(0.0, 0.0, -RING_DROP))[0]
    far = LEG_CIRCLE * math.cos(math.pi / SIDES) * math.sqrt(0.5)
    half = APRON_THICKNESS / 2
    rails = [
        *board(r, (-far, far - half, -APRON_HEIGHT), (far, far + half, 0.0), ACROSS["y"]),
        *board(r, (far - half, -far, -APRON_HEIGHT), (far + half, far, 0.0), ACROSS["x"]),
    ]
    return drum, tube, rails


def _square_up(r: Recorder, rounds: list[Component], rails: list[Component]) -> None:
    """Push what lies 30 and 60 degrees from the axes towards the corners of a square."""
    by = FULLNESS * math.sqrt(0.5)
    corners: list[list[Element]] = [[], [], [], []]
    for made in rounds:
        for vertex in r.vertices_of(made.whole):
            x, y, _ = r.positions(vertex)[0]
            if min(abs(x), abs(y)) > 0.3 * max(abs(x), abs(y)):
                corners[(0 if x > 0 else 1) if y > 0 else (2 if x < 0 else 3)].append(vertex)
    targets = [Target(tuple(found), "world", image) for found, image in zip(corners, QUADRANTS, strict=True)]
    shift(r, targets, (by, by, 0.0), "corner_fullness")
    stretch(r, rails, "x", by, "corner_fullness")
    stretch(r, rails, "y", by, "corner_fullness")


def _legs(r: Recorder, ring: tuple[Element, ...], count: int, sides: int) -> Loft:
    """Legs of height LEG_LENGTH, each an image of the first."""
    turns = [(Turn("z", 360.0 * number / count),) if number else () for number in range(count)]
    images = QUADRANTS if count == 4 else turns
    anchors = [
        Target(tuple(ring[i] for i in places), "world", image)
        for places, image in zip(LEGS[count], images, strict=True)
    ]
    wide = LEG_THICKNESS if sides == 4 else control_diameter(LEG_THICKNESS, sides)
    sections = [Section(share * LEG_LENGTH, wide, wide) for share in (0.0, KNEE, 1.0)]
    return beam(r, "-z", sections, sides=sides, anchors=anchors)


def _shape_legs(r: Recorder, legs: list[Loft], places: list[tuple[tuple[int, ...], ...]], top: Component) -> None:
    feet = [target for made in legs for target in made.sections(-1)]
    r.scale(feet, FOOT, "uv", size="foot_thickness")
    knees = [target for made in legs for target in made.sections(1)]
    r.scale(knees, (1 + FOOT) / 2, "uv")
    r.scale([target for made in legs for target in made.body()], 1.0, "uv", size="leg_thickness")
    for made, hung in zip(legs, places, strict=True):
        bearing = math.radians(sum(hung[0]) / len(hung[0]) * 360.0 / SIDES)
        out = (math.cos(bearing), math.sin(bearing), 0.0)
        for section, share in ((1, KNEE), (2, 1.0)):
            move(r, made.sections(section), (share * SPLAY * out[0], share * SPLAY * out[1], 0.0), length="leg_splay")
        shift(r, made.sections(1), (-KNEE_SHIFT * out[0], -KNEE_SHIFT * out[1], 0.0), "knee_shift")
    every = [component.whole for made in legs for component in made.components]
    r.scale(group(*every, frame="world"), 1.0, "z", pivot=top.bottom, size="leg_length")


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
