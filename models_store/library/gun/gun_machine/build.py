"""Models a heavy machine gun: a long box with grips behind it and a barrel before it, on a column, a tripod or a bipod.

The box begins at x = 0; the mount hangs under its middle.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import bipod, components, post, tube, whole
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, Turn, when

BOX_LENGTH, BOX_HEIGHT, BOX_WIDTH = 0.62, 0.14, 0.10
JACKET_LENGTH, JACKET_DIAMETER = 0.32, 0.060
BARREL_LENGTH, BARREL_DIAMETER = 0.80, 0.032
AMMUNITION_LENGTH, AMMUNITION_HEIGHT, AMMUNITION_REACH = 0.20, 0.16, 0.10
AMMUNITION_PLACE = 0.04
COLUMN_LENGTH, COLUMN_DIAMETER = 0.75, 0.080
TRIPOD_LENGTH = 0.80
COLUMN, TRIPOD, BIPOD = 1, 2, 3


def build() -> ProceduralModel:
    """Model the machine gun."""
    recorder = Recorder("gun_machine", "gun", unit_m=1.0, description="A heavy machine gun on its mount.")
    _declare(recorder)
    box = _box(recorder)
    barrel = _barrel(recorder, box)
    grips = _grips(recorder, box)
    _mounts(recorder, box)
    belt = _ammunition(recorder, box)
    sight = post(recorder, upper(recorder, box, 1), (0.05, 0.02, 0.05), top=0.4)
    recorder.part("sight", components(sight), present_when=(when("sight", 1),))
    recorder.scale(whole(box, *barrel, *grips, belt, sight), 1.0, "v", pivot=box.component.whole, size="thickness")
    recorder.symmetry(mirrors=("y",), apart=components(belt))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    fed = (when("ammunition", 1),)
    recorder.choice("mount", "Mount", ("column", "tripod", "bipod"))
    recorder.choice("rear", "Rear", ("two grips", "stock"))
    recorder.choice("ammunition", "Ammunition box", ("with", "without"))
    recorder.choice("sight", "Rear sight", ("with", "without"))
    recorder.parameter("box_length", "Length of the box", 0.5, 1.4, unit="m", base_value=BOX_LENGTH)
    recorder.parameter("box_height", "Height of the box", 0.6, 1.4, unit="m", base_value=BOX_HEIGHT)
    recorder.parameter("jacket_length", "Length of the barrel jacket", 0.2, 2.2, unit="m", base_value=JACKET_LENGTH)
    recorder.parameter(
        "jacket_diameter", "Diameter of the barrel jacket", 0.7, 1.8, unit="m", base_value=JACKET_DIAMETER
    )
    recorder.parameter("barrel_length", "Barrel length", 0.5, 1.4, unit="m", base_value=BARREL_LENGTH)
    recorder.limit("barrel_length", minimum=("jacket_length", 0.05, 0.42))
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 1.6, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter(
        "ammunition_length",
        "Length of the ammunition box",
        0.4,
        1.6,
        unit="m",
        base_value=AMMUNITION_LENGTH,
        active_when=fed,
    )
    recorder.parameter(
        "ammunition_height",
        "Height of the ammunition box",
        0.5,
        1.5,
        unit="m",
        base_value=AMMUNITION_HEIGHT,
        active_when=fed,
    )
    recorder.parameter(
        "ammunition_reach",
        "Reach of the ammunition box to the side",
        0.5,
        2.8,
        unit="m",
        base_value=AMMUNITION_REACH,
        active_when=fed,
    )
    recorder.parameter(
        "ammunition_place",
        "Place of the ammunition box",
        -1.0,
        3.5,
        unit="m",
        base_value=AMMUNITION_PLACE,
        active_when=fed,
    )
    recorder.parameter("rear_length", "Length behind the box", 0.6, 1.6, kind="length")
    recorder.parameter(
        "column_length",
        "Column length",
        0.4,
        1.4,
        unit="m",
        base_value=COLUMN_LENGTH,
        active_when=(when("mount", COLUMN),),
    )
    recorder.parameter(
        "column_diameter",
        "Column diameter",
        0.6,
        1.6,
        unit="m",
        base_value=COLUMN_DIAMETER,
        active_when=(when("mount", COLUMN),),
    )
    legs = (when("mount", TRIPOD, BIPOD),)
    recorder.parameter("leg_length", "Leg length", 0.5, 1.3, active_when=legs, kind="length")
    recorder.parameter("leg_spread", "Spread of the tripod's legs", 0.6, 1.25, active_when=(when("mount", TRIPOD),))
    recorder.parameter(
        "mount_place",
        "Place of the mount",
        -1.0,
        2.2,
        unit="m",
        base_value=0.12,
        active_when=(when("mount", COLUMN, TRIPOD),),
    )
    recorder.limit("mount_place", maximum=("box_length", -0.2, 2.5))
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.4, kind="length")


def _box(recorder: Recorder) -> Loft:
    places = ((0.0, 0.9), (0.06, 1.0), (0.5 * BOX_LENGTH, 1.0), (BOX_LENGTH, 0.9))
    sections = [Section(place, BOX_WIDTH, BOX_HEIGHT * share) for place, share in places]
    box = beam(recorder, "+x", sections, crease="all")
    recorder.scale(box.body(hinge=2), 1.0, "u", size="box_length")
    recorder.scale(box.body(), 1.0, "z", size="box_height")
    return box


def _barrel(recorder: Recorder, box: Loft) -> list[Loft]:
    front = at(recorder, box, 3)
    wide = JACKET_DIAMETER
    jacket = tube(recorder, front, [(-0.03, wide), (0.9 * JACKET_LENGTH, wide), (JACKET_LENGTH, 0.8 * wide)], rise=0.01)
    recorder.scale(jacket.body(hinge=0), 1.0, "u", size="jacket_length")
    recorder.scale(jacket.body(), 1.0, "vz", size="jacket_diameter")
    profile = [(-0.04, 1.1), (0.5, 1.0), (0.93, 0.8), (0.95, 1.2), (1.0, 1.3)]
    places = [(place * BARREL_LENGTH, share * BARREL_DIAMETER) for place, share in profile]
    barrel = tube(recorder, front, places, rise=0.01, bore=0.5)
    recorder.scale(barrel.body(hinge=0), 1.0, "u", size="barrel_length")
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    return [jacket, barrel]


def _grips(recorder: Recorder, box: Loft) -> list[Loft]:
    """Two upright grips between arms, or a short stock."""
    rear = at(recorder, box, 0)
    sides = [rear, Target(rear.elements, "world", (Mirror("y"),))]
    arm = [Section(-0.02, 0.02, 0.016), Section(0.14, 0.02, 0.016)]
    arms = [beam(recorder, "-x", arm, crease="all", offset=(0.0, 0.03, z), anchors=sides) for z in (-0.035, 0.035)]
    handle = [Section(-0.05, 0.032, 0.032), Section(0.0, 0.038, 0.038), Section(0.05, 0.032, 0.032)]
    handles = beam(recorder, "+z", handle, sides=8, offset=(-0.125, 0.03, 0.0), anchors=sides)
    sections = [Section(-0.03, 0.05, 0.07), Section(0.10, 0.045, 0.07), Section(0.28, 0.045, 0.14, (0.0, -0.03))]
    stock = beam(recorder, "-x", sections, anchors=rear)
    for body in (*arms, handles, stock):
        targets = [
            Target((c.whole,), "world", image, rear.elements)
            for c, image in zip(body.components, body.images, strict=True)
        ]
        recorder.scale(targets, 1.0, "u", size="rear_length")
    recorder.part("two grips", components(*arms, handles), present_when=(when("rear", 1),))
    recorder.part("stock", components(stock), present_when=(when("rear", 2),))
    return [*arms, handles, stock]


def _mounts(recorder: Recorder, box: Loft) -> None:
    under = lower(recorder, box, 2)
    cradle = beam(recorder, "-z", [Section(-0.03, 0.14, 0.07), Section(0.08, 0.08, 0.07)], crease="all", anchors=under)
    foot = Target(cradle.rings[1][0], "world")
    wide = COLUMN_DIAMETER
    column = beam(
        recorder, "-z", [Section(-0.06, wide, wide), Section(COLUMN_LENGTH, wide, wide)], sides=8, anchors=foot
    )
    recorder.scale(column.body(hinge=0), 1.0, "z", size="column_length")
    recorder.scale(column.body(), 1.0, "uv", size="column_diameter")
    turns = [foot, *(Target(foot.elements, "world", (Turn("z", angle),)) for angle in (120.0, 240.0))]
    leg = [Section(-0.03, 0.045, 0.045), Section(TRIPOD_LENGTH, 0.035, 0.035)]
    tripod = beam(recorder, "-z", leg, crease="all", anchors=turns)
    recorder.scale(tripod.body(hinge=0), 1.0, "z", size="leg_length")
    recorder.rotate(tripod.body(hinge=0), -38.0, "v", angle="leg_spread")
    legs = bipod(recorder, lower(recorder, box, 3), 0.40)
    recorder.scale(legs.body(hinge=0), 1.0, "vz", size="leg_length")
    standing = Target(tuple(c.whole for c in components(cradle, column, tripod)), "world")
    recorder.drag(standing, rho=0.12, phi_deg=180.0)
    recorder.drag(standing, rho=0.12, length="mount_place")
    recorder.part("cradle", components(cradle), present_when=(when("mount", COLUMN, TRIPOD),))
    recorder.part("column", components(column), present_when=(when("mount", COLUMN),))
    recorder.part("tripod", components(tripod), present_when=(when("mount", TRIPOD),))
    recorder.part("bipod", components(legs), present_when=(when("mount", BIPOD),))


def _ammunition(recorder: Recorder, box: Loft) -> Loft:
    """A box of cartridges on the left side, which no mirror image has."""
    side = at(recorder, box, 2, (0.0, 1.0, 0.0))
    sections = [Section(place, AMMUNITION_LENGTH, AMMUNITION_HEIGHT) for place in (-0.01, AMMUNITION_REACH)]
    belt = beam(recorder, "+y", sections, crease="all", offset=(0.0, 0.0, -0.05), anchors=side)
    recorder.scale(belt.body(), 1.0, "u", size="ammunition_length")
    recorder.scale(belt.body(), 1.0, "z", size="ammunition_height")
    recorder.scale(belt.body(hinge=0), 1.0, "v", size="ammunition_reach")
    recorder.drag(belt.body(), rho=AMMUNITION_PLACE, phi_deg=180.0)
    recorder.drag(belt.body(), rho=AMMUNITION_PLACE, length="ammunition_place")
    recorder.part("ammunition box", components(belt), present_when=(when("ammunition", 1),))
    return belt


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
