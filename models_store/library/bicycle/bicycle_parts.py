"""Parts that the models of bicycles share: wheels, mudguards, carrier, cranks, saddle, handlebars.

The bicycle drives to +x, its left side is +y. Every part hangs on an axle or tube of the frame.
"""

import math
from collections.abc import Sequence

from models_store.library.aids.beam import beam
from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import Loft, Section
from models_store.library.bicycle.bicycle_skeleton import Skeleton, middle
from shapewright.modeling import Component, Element, Mirror, Recorder, Target, Turn, when
from shapewright.modeling.elements import Image

WHEEL_DIAMETER, TYRE = 0.68, 0.040
TYRE_SIDES = 16
SPOKE_REACH = WHEEL_DIAMETER / 2 - 0.6 * TYRE
MANY, SOME, FOUR, FIVE, DISC, BARE = 1, 2, 3, 4, 5, 6
WHEELS = ("many spokes", "some spokes", "four broad spokes", "five broad spokes", "discs", "bare rims")
SPOKE, BROAD_SPOKE = 0.005, 0.022
FLAT, CITY, DROP = 1, 2, 3
CHAIN, GUARD = 1, 2
HANDLEBARS = ("flat", "swept back", "drop")


def declare_wheels(recorder: Recorder) -> None:
    """Declare what :func:`wheels` varies."""
    recorder.choice("wheels", "Wheels", WHEELS)
    recorder.parameter("wheel_diameter", "Wheel diameter", 0.6, 1.1, unit="m", base_value=WHEEL_DIAMETER)
    recorder.parameter("tyre_depth", "Tyre thickness", 0.4, 2.2, unit="m", base_value=TYRE)
    recorder.parameter("tyre_width", "Tyre width (share of its thickness)", 0.35, 1.4, base_value=1.0)
    spoked = (when("wheels", MANY, FIVE),)
    recorder.parameter("spoke_thickness", "Spoke thickness", 0.15, 2.4, unit="m", base_value=SPOKE, active_when=spoked)
    broad = (when("wheels", FOUR, FIVE),)
    for which in ("rear", "front"):
        label = f"Turn of the {which} wheel (half spaces between spokes)"
        recorder.parameter(f"{which}_turn", label, 0.0, 2.0, active_when=broad, kind="ratio")


def wheels(recorder: Recorder, rear: Loft, front: Loft) -> list[list[Element]]:
    """Put wheels on two axles; return all components of each, still of the base diameter."""
    hubs = [middle(rear), middle(front)]
    outer = control_diameter(WHEEL_DIAMETER, TYRE_SIDES)
    tyres = recorder.base("ring", (outer, outer, TYRE), sides=TYRE_SIDES, anchors=hubs)
    recorder.rotate([Target((tyre.whole,), "world") for tyre in tyres], 90.0, "u")
    cross_sections = [
        Target(tuple(vertices[i : i + 4]), "world")
        for vertices in (recorder.vertices_of(tyre.whole) for tyre in tyres)
        for i in range(0, len(vertices), 4)
    ]
    recorder.scale(cross_sections, 1.0, "uvz", size="tyre_depth")
    recorder.scale([Target((tyre.whole,), "world") for tyre in tyres], 1.0, "v", size="tyre_width")
    made: list[list[Element]] = [[tyre.whole] for tyre in tyres]
    through, single = 2 * SPOKE_REACH, SPOKE_REACH
    twelve = _spokes(recorder, hubs, [30.0 * i for i in range(6)], through, SPOKE, first_deg=15.0)
    between = [30.0 * i + extra for i in range(6) for extra in (0.0, 10.0)]
    more = _spokes(recorder, hubs, between, through, SPOKE, first_deg=25.0)
    four = _spokes(recorder, hubs, [0.0, 90.0], through, BROAD_SPOKE, turn_deg=45.0, sides=4)
    five = _spokes(recorder, hubs, [72.0 * i for i in range(5)], single, BROAD_SPOKE, turn_deg=36.0, sides=4)
    discs = _discs(recorder, hubs)
    for name, bodies, low, high in (
        ("spokes", twelve, MANY, SOME),
        ("more spokes", more, MANY, MANY),
        ("four broad spokes", four, FOUR, FOUR),
        ("five broad spokes", five, FIVE, FIVE),
        ("discs", discs, DISC, DISC),
    ):
        recorder.part(name, bodies, present_when=(when("wheels", low, high),))
        each = len(bodies) // 2
        for number in (0, 1):
            made[number] += [body.whole for body in bodies[number * each : (number + 1) * each]]
    return made


def size_wheels(recorder: Recorder, hubs: tuple[Loft, Loft], wheel_parts: list[list[Element]]) -> None:
    """Let the wheel diameter scale what belongs to each wheel about its hub."""
    targets = [
        Target(tuple(parts), "world", (), (hub.component.whole,)) for parts, hub in zip(wheel_parts, hubs, strict=True)
    ]
    recorder.scale(targets, 1.0, "uz", size="wheel_diameter")


def _spokes(
    recorder: Recorder,
    hubs: list[Target],
    angles_deg: Sequence[float],
    length: float,
    thickness: float,
    *,
    first_deg: float = 0.0,
    turn_deg: float | None = None,
    sides: int = 3,
) -> list[Component]:
    """Thin prisms from each hub to the rim at these angles from the first.

    Args:
        angles_deg: begins with 0.
        length: as far as the rim, or from rim to rim, which makes each two spokes.
        turn_deg: half the space between two spokes, by which parameters turn those of either wheel; None: none.
    """
    turns: list[Image] = [(Turn("y", angle_deg),) if angle_deg else () for angle_deg in angles_deg]
    anchors = [Target(hub.elements, "world", turn) for hub in hubs for turn in turns]
    offset = (0.0, 0.0, SPOKE_REACH - length)
    rods = recorder.base("prism", (thickness, thickness, length), sides=sides, offset=offset, anchors=anchors)
    recorder.mark_sharp(*(face for rod in rods for face in rod.faces))
    pairs = zip(rods, anchors, strict=True)
    wholes = [Target((rod.whole,), "world", anchor.image, anchor.elements) for rod, anchor in pairs]
    recorder.scale(wholes, 1.0, "uv", size="spoke_thickness")
    if first_deg:
        recorder.rotate(wholes, first_deg, "v")
    if turn_deg is None:
        return rods
    for targets, which in ((wholes[: len(turns)], "rear"), (wholes[len(turns) :], "front")):
        recorder.rotate(targets, turn_deg, "v", angle=f"{which}_turn")
    return rods


def _discs(recorder: Recorder, hubs: list[Target]) -> list[Component]:
    wide = WHEEL_DIAMETER - TYRE
    profile = ((-0.020, 0.2), (-0.010, 1.0), (0.010, 1.0), (0.020, 0.2))
    sections = [Section(y, share * wide, share * wide) for y, share in profile]
    return list(beam(recorder, "+y", sections, sides=TYRE_SIDES, anchors=hubs).components)


def mudguards(
    recorder: Recorder, hubs: tuple[Loft, Loft], turns_deg: tuple[float, float], option: int
) -> list[list[Element]]:
    """A bent strip over each wheel on two rods; ``turns_deg`` is how far before the top each one begins."""
    made: list[list[Element]] = []
    steps, step_deg = 7, 21.0
    radius = WHEEL_DIAMETER / 2 + 0.022
    chord = 2 * radius * math.sin(math.radians(step_deg / 2))
    for hub, turn_deg in zip(hubs, turns_deg, strict=True):
        axis = middle(hub)
        sections = [Section(i * chord, 0.055, 0.010) for i in range(steps)]
        strip = beam(recorder, "-x", sections, offset=(0.0, 0.0, radius), anchors=axis)
        recorder.rotate(strip.body(hinge=0), -step_deg / 2, "v")
        for number in range(1, steps - 1):
            recorder.rotate(strip.beyond(number, hinge=number), -step_deg, "v")
        bodies = list(strip.components)
        for angle_deg in (2.5 * step_deg, 5.5 * step_deg):
            image = (Mirror("y"),)
            rods = recorder.base(
                "prism",
                (0.008, 0.008, radius),
                sides=3,
                offset=(0.0, 0.022, 0.0),
                anchors=[axis, Target(axis.elements, "world", image)],
            )
            recorder.mark_sharp(*(face for rod in rods for face in rod.faces))
            pivot = axis.elements
            recorder.rotate(Target(tuple(rod.whole for rod in rods), "world", (), pivot), -angle_deg, "v")
            bodies += rods
        wholes = tuple(body.whole for body in bodies)
        recorder.rotate(Target(wholes, "world", (), axis.elements), turn_deg, "v")
        made.append(list(wholes))
    recorder.part(
        "mudguards", [element for parts in made for element in parts], present_when=(when("mudguards", option),)
    )
    return made


def carrier(recorder: Recorder, rear: Loft, option: int) -> list[Element]:
    """A rack over the rear wheel on two legs."""
    axis = middle(rear)
    height = WHEEL_DIAMETER / 2 + 0.060
    sections = [Section(-0.24, 0.12, 0.014), Section(0.14, 0.12, 0.014)]
    rack = beam(recorder, "+x", sections, crease="all", offset=(0.0, 0.0, height), anchors=axis)
    anchors = [axis, Target(axis.elements, "world", (Mirror("y"),))]
    legs = recorder.base("prism", (0.010, 0.010, height), sides=4, offset=(0.0, 0.045, 0.0), anchors=anchors)
    recorder.mark_sharp(*(face for leg in legs for face in leg.faces))
    parts = [*rack.components, *legs]
    recorder.part("carrier", parts, present_when=(when("carrier", option),))
    return [part.whole for part in parts]


def declare_cranks(recorder: Recorder) -> None:
    """Declare what :func:`cranks` varies."""
    recorder.choice("cranks", "Cranks", ("with", "without"))
    there = (when("cranks", 1),)
    recorder.parameter("crank_length", "Crank length", 0.4, 1.25, unit="m", base_value=0.17, active_when=there)
    recorder.parameter("crank_angle", "Crank angle (deg)", -2.0, 6.8, base_value=40.0, active_when=there, kind="angle")
    recorder.parameter("chainring", "Chainring diameter", 0.6, 1.5, unit="m", base_value=0.18, active_when=there)


def cranks(recorder: Recorder, bottom: Loft) -> list[Component]:
    """Chainring on the right, an arm with its pedal on either side: no mirror image has them."""
    axis = middle(bottom)
    ring = [Section(y, 0.18, 0.18) for y in (0.040, 0.050)]
    chainring = beam(recorder, "-y", ring, sides=12, anchors=axis)
    recorder.scale(chainring.body(), 1.0, "uz", size="chainring")
    arm = [Section(-0.015, 0.026, 0.016), Section(0.17, 0.020, 0.014)]
    right = beam(recorder, "-z", arm, crease="all", offset=(0.0, -0.062, 0.0), anchors=axis)
    left = beam(recorder, "+z", arm, crease="all", offset=(0.0, 0.062, 0.0), anchors=axis)
    for body in (right, left):
        recorder.scale(Target((body.component.whole,), "world", (), axis.elements), 1.0, "z", size="crank_length")
    spindle = beam(recorder, "+y", [Section(-0.064, 0.022, 0.022), Section(0.064, 0.022, 0.022)], sides=6, anchors=axis)
    arms = Target((right.component.whole, left.component.whole), "world", (), axis.elements)
    recorder.rotate(arms, 40.0, "v", angle="crank_angle")
    pedals = []
    for body, sign in ((right, -1.0), (left, 1.0)):
        end = Target(body.rings[1][0], "world")
        block = [Section(-0.004, 0.085, 0.022), Section(0.090, 0.085, 0.022)]
        pedals.append(beam(recorder, "+y" if sign > 0 else "-y", block, crease="all", anchors=end))
    made = [c for body in (chainring, right, left, spindle, *pedals) for c in body.components]
    recorder.part("cranks", made, present_when=(when("cranks", 1),))
    return made


def declare_saddle(recorder: Recorder) -> None:
    """Declare what :func:`saddle` varies."""
    recorder.parameter("saddle_length", "Saddle length", 0.55, 1.5, unit="m", base_value=0.27)
    recorder.parameter("saddle_width", "Saddle width", 0.5, 1.9, unit="m", base_value=0.15)
    recorder.parameter("saddle_depth", "Saddle thickness", 0.4, 2.0, unit="m", base_value=0.04)
    recorder.parameter("saddle_tilt", "Saddle tilt (deg)", -2.0, 3.0, base_value=3.0, kind="angle")


def saddle(recorder: Recorder, post: Loft) -> Loft:
    """A saddle on the end of its post."""
    profile = (
        (-0.12, 0.10, 0.8),
        (-0.09, 0.15, 1.15),
        (-0.02, 0.12, 1.0),
        (0.06, 0.06, 0.85),
        (0.14, 0.045, 0.75),
        (0.15, 0.03, 0.5),
    )
    sections = [Section(x, width * 1.1, 0.04 * 1.1 * depth) for x, width, depth in profile]
    end = Target(post.rings[1][0], "world")
    made = beam(recorder, "+x", sections, sides=8, offset=(0.0, 0.0, 0.006), anchors=end)
    recorder.scale(Target((made.component.whole,), "world", (), end.elements), 1.0, "u", size="saddle_length")
    recorder.scale(made.body(), 1.0, "v", size="saddle_width")
    recorder.scale(made.body(), 1.0, "z", size="saddle_depth")
    recorder.rotate(Target((made.component.whole,), "world", (), end.elements), 3.0, "v", angle="saddle_tilt")
    return made


def handlebars(recorder: Recorder, clamp: Target) -> dict[int, Loft]:
    """Pairs of bars from the clamp: flat, drop and swept back ones, as the choice ``handlebars`` says."""
    anchors = [clamp, Target(clamp.elements, "world", (Mirror("y"),))]
    places = {
        FLAT: (-0.015, 0.06, 0.12, 0.30),
        DROP: (-0.015, 0.15, 0.18, 0.21, 0.27, 0.31, 0.35, 0.39, 0.43, 0.53),
        CITY: (-0.015, 0.05, 0.13, 0.19, 0.24, 0.29, 0.45),
    }
    bars = {}
    for kind, along in places.items():
        sections = [Section(place, 0.030, 0.030) for place in along]
        bars[kind] = beam(recorder, "+y", sections, sides=6, anchors=anchors)
    flat, drop, city = bars[FLAT], bars[DROP], bars[CITY]
    recorder.rotate(flat.beyond(1, hinge=1), 14.0, "u", angle="bar_rise")
    recorder.rotate(flat.beyond(2, hinge=2), -14.0, "u", angle="bar_rise")
    recorder.rotate(flat.beyond(2, hinge=2), 9.0, "z", angle="bar_sweep")
    for number in (1, 2, 3):
        recorder.rotate(drop.beyond(number, hinge=number), -30.0, "z")
    for number in range(4, 9):
        recorder.rotate(drop.beyond(number, hinge=number), 34.0, "v", angle="bar_curl")
    recorder.rotate(city.beyond(1, hinge=1), 25.0, "u", angle="bar_rise")
    recorder.rotate(city.beyond(2, hinge=2), -25.0, "u", angle="bar_rise")
    for number in (2, 3, 4, 5):
        recorder.rotate(city.beyond(number, hinge=number), 19.0, "z", angle="bar_sweep_back")
    for kind, name in ((FLAT, "flat"), (DROP, "drop"), (CITY, "swept back")):
        recorder.scale(
            [
                Target((c.whole,), "world", image, clamp.elements)
                for c, image in zip(bars[kind].components, bars[kind].images, strict=True)
            ],
            1.0,
            "v",
            size="bar_width",
        )
        recorder.part(f"{name} handlebars", bars[kind].components, present_when=(when("handlebars", kind),))
    return bars


def declare_handlebars(recorder: Recorder) -> None:
    """Declare what :func:`handlebars` varies."""
    recorder.choice("handlebars", "Handlebars", HANDLEBARS)
    recorder.parameter("bar_width", "Handlebar width", 0.6, 1.5, base_value=0.6, unit="m")
    recorder.parameter(
        "bar_rise", "Handlebar rise", -0.3, 4.0, active_when=(when("handlebars", FLAT, CITY),), kind="length"
    )
    recorder.parameter(
        "bar_sweep", "Handlebar sweep", -0.3, 4.5, active_when=(when("handlebars", FLAT),), kind="length"
    )
    recorder.parameter(
        "bar_sweep_back",
        "Sweep of the swept handlebars",
        0.4,
        1.3,
        active_when=(when("handlebars", CITY),),
        kind="length",
    )
    recorder.parameter("bar_curl", "Curl of the drop handlebars", 0.6, 1.1, active_when=(when("handlebars", DROP),))


def declare_transmission(recorder: Recorder) -> None:
    """Declare what :func:`transmission` varies."""
    recorder.choice("transmission", "Transmission", ("chain", "chain guard", "without"))
    there = (when("transmission", GUARD),)
    recorder.parameter(
        "guard_height", "Height of the chain guard", 0.25, 1.1, unit="m", base_value=0.2, active_when=there
    )


def transmission(recorder: Recorder, skeleton: Skeleton) -> list[Component]:
    """A chain or a chain guard on the right side, from the bottom bracket to the rear axle."""
    runs = [
        skeleton.tube("bottom", "rear", 0.012, side=-0.045, from_start=(0.0, at_ring), from_end=(0.0, at_hub), sides=4)
        for at_ring, at_hub in ((0.085, 0.03), (-0.085, -0.03))
    ]
    guard = skeleton.tube("bottom", "rear", (0.2, 0.1), side=-0.052, from_start=(0.10, 0.0), sides=4, crease="all")
    recorder.scale(guard.body(), 0.1, "v")
    recorder.scale(guard.sections(0, 1), 1.0, "z", size="guard_height")
    chain = [component for run in runs for component in run.components]
    recorder.part("chain", chain, present_when=(when("transmission", CHAIN),))
    recorder.part("chain guard", guard.components, present_when=(when("transmission", GUARD),))
    return [*chain, *guard.components]
