"""Models a stool: a round or a square seat on three legs, four legs or a pedestal, perhaps with a ring for the feet.

The legs are modelled one after another, each in two pieces: the ring lies where they meet.
"""

import math
from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, ProceduralModel, Target, Turn, when

SEAT_SIDES, LEG_SIDES, RING_SIDES = 16, 6, 12
SEAT, THICKNESS, CUSHION = 0.36, 0.05, 0.02
DROP, REST = 0.40, 0.24  # from the seat to the ring, from the ring to the floor
LEG_THICKNESS, LEG_TAPER, LEG_INSET, LEG_SPLAY = 0.034, 0.8, 0.13, 0.10
FOOT, COLUMN = 0.34, 0.06
SPLIT = DROP / (DROP + REST)


def model() -> AnnotatingRecorder:
    """Model the stool."""
    r = AnnotatingRecorder(
        "stool", "stool", unit_m=1.0, description="A stool without a back: legs or a pedestal, perhaps a ring."
    )
    r.choice("seat", "Seat", ("round", "square"))
    r.parameter("seat_size", "Seat width", 0.7, 1.7, unit="m", base_value=SEAT)
    r.parameter("seat_thickness", "Seat thickness", 0.4, 3.2, unit="m", base_value=THICKNESS)
    r.parameter("cushion", "Height of the rounded cushion", 0.0, 3.5, unit="m", base_value=CUSHION)
    r.choice("support", "Support", ("four legs", "three legs", "pedestal"))
    legs = [when("support", 1, 2)]
    r.parameter("drop", "Seat to foot ring", 0.35, 1.5, unit="m", base_value=DROP)
    r.parameter("rest", "Foot ring to floor", 0.4, 1.8, unit="m", base_value=REST)
    r.parameter("leg_thickness", "Leg thickness", 0.5, 1.9, unit="m", base_value=LEG_THICKNESS, active_when=legs)
    r.parameter("leg_taper", "Foot thickness (of the leg's)", 0.5, 1.5, base_value=LEG_TAPER, active_when=legs)
    r.parameter("leg_splay", "Leg splay", -0.1, 2.0, unit="m", base_value=LEG_SPLAY, active_when=legs)
    r.parameter(
        "leg_spread", "Distance of the legs at the seat", 0.5, 1.1, unit="m", base_value=2 * LEG_INSET, active_when=legs
    )
    r.limit("leg_spread", maximum=("seat_size", -0.05, 1.15))
    r.switch("ring", "Foot ring", active_when=legs)
    pedestal = [when("support", 3)]
    r.parameter("column_thickness", "Pedestal thickness", 0.5, 3.0, unit="m", base_value=COLUMN, active_when=pedestal)
    r.parameter("foot_size", "Pedestal foot width", 0.6, 1.5, unit="m", base_value=FOOT, active_when=pedestal)
    seat = _seat(r)
    four, three = _legs(r, seat)
    ring = _ring(r, seat)
    column = _pedestal(r, seat)
    r.part("four legs", four, [when("support", 1)])
    r.part("three legs", three, [when("support", 2)])
    r.part("foot ring", [ring], [when("ring", 1), when("support", 1, 2)])
    r.part("pedestal", column, [when("support", 3)])
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _seat(r: AnnotatingRecorder) -> Component:
    """Both seats, modelled alike, and the hub below them that is always there."""
    hub = r.prism(SEAT_SIDES, 0.16, 0.02, offset=(0.0, 0.0, -0.016))
    r.mark_sharp(hub.bottom, hub.top)
    flat = math.cos(math.pi / 4)
    round_seat = r.prism(SEAT_SIDES, control_diameter(1.0, SEAT_SIDES), 1.0)
    square_seat = r.prism(4, 1.0 / flat, 1.0)
    r.judge("turn of the square seat", important=False)
    r.rotate(put(square_seat.whole), 45.0, "z")
    r.mark_sharp(round_seat.bottom, *square_seat.faces, round_seat.top)
    seats = [round_seat, square_seat]
    tops = [seat.top for seat in seats]
    r.judge("seat thickness", important=True)
    r.scale([put(s.whole, pivot=(s.bottom,)) for s in seats], THICKNESS, "z", size="seat_thickness")
    for height, share in ((0.6, 0.9), (0.3, 0.8), (0.1, 0.6)):
        r.judge("cushion height", important=True)
        r.extrude(tops, height * CUSHION, length="cushion")
        outline = {edge.id for edge in r.edges_of(square_seat.top)}
        rising = {e for v in r.vertices_of(square_seat.top) for e in r.mesh.edges_of_vertex(v.id)} - outline
        r.mark_sharp(*(Element("edge", edge) for edge in sorted(rising)))  # smooth ones would fold
        r.judge("cushion rounding", important=False)
        r.scale(tops, share, "uv")
    r.judge("seat width", important=True)
    r.scale([put(s.whole) for s in seats], SEAT, "uv", size="seat_size")
    r.part("round seat", [round_seat], [when("seat", 1)])
    r.part("square seat", [square_seat], [when("seat", 2)])
    return hub


def _legs(r: AnnotatingRecorder, hub: Component) -> tuple[list[Component], list[Component]]:
    """Round legs below the seat, straight ones that splay outwards; the i-th of three with the i-th of four."""
    four: list[Component] = []
    three: list[Component] = []
    for angle_deg, other_deg in ((45.0, 0.0), (135.0, 120.0), (225.0, 240.0), (315.0, None)):
        size = (control_diameter(1.0, LEG_SIDES), control_diameter(1.0, LEG_SIDES), 0.02)
        anchors = [put(hub.bottom)] * (1 if other_deg is None else 2)
        legs = r.base("prism", size, sides=LEG_SIDES, offset=(0.0, 0.0, 0.002), anchors=anchors)
        image = (Turn("z", (other_deg or 0.0) - angle_deg),)
        feet = [leg.bottom for leg in legs]
        r.judge("seat to foot ring", important=True)
        r.extrude(feet, DROP, length="drop")
        joints = [r.vertices_of(foot) for foot in feet]
        r.judge("foot ring to floor", important=True)
        r.extrude(feet, REST, length="rest")
        r.mark_sharp(*feet, *(leg.top for leg in legs))
        r.judge("leg thickness", important=True)
        r.scale([put(leg.whole) for leg in legs], LEG_THICKNESS, "uv", size="leg_thickness")
        r.judge("leg taper", important=False)
        r.scale([put(foot) for foot in feet], LEG_TAPER, "uv", size="leg_taper")
        wholes = [leg.whole for leg in legs]
        for label, what, by, name in (
            ("leg splay at the ring", joints, SPLIT * LEG_SPLAY, "leg_splay"),
            ("leg splay", [[foot] for foot in feet], LEG_SPLAY, "leg_splay"),
            ("distance of the legs at the seat", [[whole] for whole in wholes], LEG_INSET, "leg_spread"),
        ):
            r.judge(label, important=label != "leg splay at the ring")
            targets = [Target(tuple(what[0]), "world"), *(Target(tuple(other), "world", image) for other in what[1:])]
            r.drag(targets, 0.0, by, angle_deg, length=name)
        four.append(legs[0])
        three += legs[1:]
    return four, three


def _ring(r: AnnotatingRecorder, hub: Component) -> Component:
    """A thin ring through the legs; its sections follow them outwards."""
    start = 0.1
    ring = r.base(
        "ring", (start, start, 0.018), sides=RING_SIDES, tube_sides=4, offset=(0.0, 0.0, 0.002), anchors=put(hub.bottom)
    )[0]
    vertices = r.vertices_of(ring.whole)
    sections = [put(*vertices[4 * i : 4 * i + 4]) for i in range(RING_SIDES)]
    targets = [sections[0]] + [
        Target(section.elements, "world", (Turn("z", 360.0 / RING_SIDES * i),))
        for i, section in enumerate(sections[1:], start=1)
    ]
    curve = control_diameter(1.0, RING_SIDES)
    r.judge("ring height", important=False)
    push(r, ring.whole, (0.0, 0.0, -DROP), length="drop")
    r.judge("ring radius", important=False)
    r.drag(targets, 0.0, -(start / 2 - 0.009))
    r.drag(targets, 0.0, curve * LEG_INSET, length="leg_spread")
    r.drag(targets, 0.0, curve * SPLIT * LEG_SPLAY, length="leg_splay")
    return ring


def _pedestal(r: AnnotatingRecorder, hub: Component) -> list[Component]:
    """A column on a flat round foot."""
    column = r.prism(8, control_diameter(1.0, 8), 0.02, anchor=put(hub.bottom))
    r.judge("pedestal height", important=True)
    r.extrude(column.bottom, DROP, length="drop")
    r.extrude(column.bottom, REST - 0.04, length="rest")
    r.mark_sharp(column.bottom, column.top)
    r.judge("pedestal thickness", important=True)
    r.scale(put(column.whole), COLUMN, "uv", size="column_thickness")
    foot = r.prism(
        SEAT_SIDES, control_diameter(1.0, SEAT_SIDES), 0.018, offset=(0.0, 0.0, -0.018), anchor=put(column.bottom)
    )
    r.mark_sharp(foot.bottom)
    for height, share in ((0.012, 0.7), (0.03, 0.25)):
        r.judge("height of the pedestal's foot", important=False)
        r.extrude(foot.top, height)
        r.judge("slope of the pedestal's foot", important=False)
        r.scale(put(foot.top), share, "uv")
    r.judge("width of the pedestal's foot", important=True)
    r.scale(put(foot.whole), FOOT, "uv", size="foot_size")
    return [column, foot]


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
