"""Models a revolver.

The cylinder's axis is the x axis of the model. What lies before the cylinder hangs on its front, the straps above and
below on the frame behind it, so cylinder and frame grow together.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import components, post, square_off, trigger, trigger_guard, tube, whole
from shapewright.modeling import Component, ProceduralModel, Recorder, group, when

SHIELD = 0.030  # length of the frame behind the cylinder
FRAME_DROP = 0.006
CYLINDER_LENGTH, CYLINDER_DIAMETER = 0.042, 0.040
CYLINDER_SIDES = 12
BARREL_LENGTH, BARREL_DIAMETER, BARREL_RISE = 0.110, 0.017, 0.009
GRIP_LENGTH, GRIP_DEPTH, GRIP_WIDTH = 0.092, 0.038, 0.030
GRIP_RAKE_DEG, GRIP_BEND_DEG = 32.0, -8.0


def build() -> ProceduralModel:
    """Model the revolver."""
    recorder = Recorder("gun_revolver", "gun", unit_m=1.0, description="A revolver with a closed or open frame.")
    _declare(recorder)
    shield = beam(
        recorder,
        "+x",
        [
            Section(-0.016, 0.020, 0.020),
            Section(0.006, 0.024, 0.042, (0.0, 0.005)),
            Section(SHIELD, 0.030, 0.050),
        ],
        crease="all",
    )
    recorder.scale(shield.body(hinge=0), 1.0, "u", size="frame_length")
    recorder.drag([*shield.sections(0), *shield.sections(1)], -FRAME_DROP, height="frame_drop")
    cylinder = _cylinder(recorder, shield)
    block = beam(
        recorder,
        "+x",
        [Section(-0.002, 0.022, 0.050), Section(0.012, 0.020, 0.046)],
        crease="all",
        anchors=at(recorder, cylinder, 3),
    )
    recorder.scale(
        group(*(c.whole for c in components(shield, cylinder, block)), frame="world"),
        1.0,
        "vz",
        pivot=cylinder.component.whole,
        size="cylinder_diameter",
    )
    straps = _straps(recorder, shield)
    barrels = _barrels(recorder, block)
    grip = _grip(recorder, shield)
    details = _details(recorder, shield, straps[1])
    recorder.scale(whole(shield, cylinder, block, *straps, *barrels, grip, *details), 1.0, "v", size="thickness")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    recorder.choice("frame", "Frame", ("closed", "open above the cylinder"))
    recorder.choice("barrel", "Barrel", ("round", "slab-sided"))
    recorder.choice("lug", "Rod under the barrel", ("with", "without"))
    recorder.choice("guard", "Trigger guard", ("with", "without"))
    recorder.choice("hammer", "Hammer", ("outside", "hidden"))
    recorder.parameter("cylinder_length", "Cylinder length", 0.65, 1.6, unit="m", base_value=CYLINDER_LENGTH)
    recorder.parameter("cylinder_diameter", "Cylinder diameter", 0.75, 1.3, unit="m", base_value=CYLINDER_DIAMETER)
    recorder.parameter("flutes", "Diameter between the cylinder's flutes (share)", 0.85, 1.15, base_value=0.86)
    recorder.parameter("barrel_length", "Barrel length", 0.35, 2.2, unit="m", base_value=BARREL_LENGTH)
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 1.6, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter(
        "lug_length", "Length of the rod (share of the barrel)", 0.3, 1.3, base_value=0.7, active_when=(when("lug", 1),)
    )
    recorder.parameter("frame_length", "Frame length behind the cylinder", 0.6, 1.6, kind="length")
    recorder.parameter(
        "frame_drop", "Drop of the frame behind the cylinder", -0.5, 3.0, unit="m", base_value=FRAME_DROP
    )
    recorder.parameter("grip_length", "Grip length", 0.65, 1.5, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_depth", "Grip depth", 0.75, 1.5, unit="m", base_value=GRIP_DEPTH)
    recorder.parameter("grip_top", "Grip depth at its top (share)", 0.6, 1.2, base_value=0.95)
    recorder.parameter("grip_base", "Grip depth at its base (share)", 0.7, 1.5, base_value=1.25)
    recorder.parameter("grip_rake", "Grip rake (deg)", 0.3, 1.75, base_value=GRIP_RAKE_DEG, kind="angle")
    recorder.parameter("grip_bend", "Grip bend (deg)", -1.5, 2.5, base_value=GRIP_BEND_DEG, kind="angle")
    recorder.parameter("grip_corners", "Corners of the grip's sections, from oval to square", 0.95, 1.6)
    recorder.parameter("grip_width", "Grip width", 0.6, 1.3, unit="m", base_value=GRIP_WIDTH)
    recorder.parameter(
        "guard_length", "Trigger guard length", 0.75, 1.3, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter(
        "guard_height", "Trigger guard height", 0.75, 1.3, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter("sight_height", "Front sight height", 0.3, 2.0, unit="m", base_value=0.009)
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.3, kind="length")


def _cylinder(recorder: Recorder, shield: Loft) -> Loft:
    places = (0.001, 0.3 * CYLINDER_LENGTH, 0.85 * CYLINDER_LENGTH, CYLINDER_LENGTH)
    sections = [Section(place, CYLINDER_DIAMETER * 1.04, CYLINDER_DIAMETER * 1.04) for place in places]
    cylinder = beam(recorder, "+x", sections, sides=CYLINDER_SIDES, anchors=at(recorder, shield, 2))
    flutes = group(*(v for ring in cylinder.rings[2:] for v in ring[0][::2]), frame="world")
    recorder.scale(flutes, 0.86, "vz", size="flutes")
    recorder.scale(cylinder.body(hinge=0), 1.0, "u", size="cylinder_length")
    return cylinder


def _straps(recorder: Recorder, shield: Loft) -> list[Loft]:
    """The bars above and below the cylinder, sunk into the frame at both ends."""
    straps = []
    for anchor, rise, thickness in (
        (upper(recorder, shield, 2), 0.000, 0.009),
        (lower(recorder, shield, 2), -0.001, 0.011),
    ):
        sections = [Section(place, 0.018, thickness) for place in (-0.018, -0.002, CYLINDER_LENGTH + 0.010)]
        strap = beam(recorder, "+x", sections, crease="all", offset=(0.0, 0.0, rise), anchors=anchor)
        recorder.scale(strap.body(hinge=1), 1.0, "u", size="cylinder_length")
        straps.append(strap)
    recorder.part("top strap", components(straps[0]), present_when=(when("frame", 1),))
    return straps


def _barrels(recorder: Recorder, block: Loft) -> list[Loft]:
    """The round and the slab-sided barrel, what lies under it, its sight."""
    muzzle = at(recorder, block, 1)
    profile = [(-0.010, 1.1), (0.010, 1.1), (0.9 * BARREL_LENGTH, 0.95), (BARREL_LENGTH, 0.95)]
    places = [(place, share * BARREL_DIAMETER) for place, share in profile]
    barrel = tube(recorder, muzzle, places, rise=BARREL_RISE, bore=0.6)
    sections = [Section(place, 0.9 * BARREL_DIAMETER, 1.4 * BARREL_DIAMETER) for place, _ in profile]
    slab = beam(recorder, "+x", sections, crease="all", offset=(0.0, 0.0, BARREL_RISE), anchors=muzzle)
    for body in (barrel, slab):
        recorder.scale(body.body(hinge=0), 1.0, "u", size="barrel_length")
        recorder.scale(body.body(), 1.0, "vz", size="barrel_diameter")
    lug = tube(recorder, lower(recorder, barrel, 1), [(-0.020, 0.013), (0.7 * BARREL_LENGTH, 0.010)], rise=-0.001)
    for name in ("barrel_length", "lug_length"):
        recorder.scale(lug.body(hinge=0), 1.0, "u", size=name)
    sight = post(recorder, upper(recorder, barrel, 2, 3), (0.016, 0.004, 0.009), sink=0.7, top=0.4)
    recorder.scale(sight.body(hinge=0), 1.0, "z", size="sight_height")
    recorder.part("round barrel", components(barrel), present_when=(when("barrel", 1),))
    recorder.part("slab-sided barrel", components(slab), present_when=(when("barrel", 2),))
    recorder.part("rod", components(lug), present_when=(when("lug", 1),))
    return [barrel, slab, lug, sight]


def _grip(recorder: Recorder, shield: Loft) -> Loft:
    profile = (
        (-0.22, 0.84, 0.8),
        (0.0, 1.0, 0.8),
        (0.3, 0.9, 1.0),
        (0.6, 1.0, 1.05),
        (0.85, 1.15, 1.0),
        (1.0, 1.2, 0.9),
    )
    sections = [
        Section(place * GRIP_LENGTH, GRIP_DEPTH * depth * 1.1, GRIP_WIDTH * width * 1.1)
        for place, depth, width in profile
    ]
    grip = beam(recorder, "-z", sections, sides=8, offset=(-0.002, 0.0, 0.004), anchors=lower(recorder, shield, 0, 1))
    square_off(recorder, grip, range(6), 1.0, "uv", "grip_corners")
    recorder.scale(grip.body(hinge=1), 1.0, "z", size="grip_length")
    recorder.scale(grip.body(), 1.0, "u", size="grip_depth")
    recorder.scale(grip.body(), 1.0, "v", size="grip_width")
    recorder.scale(grip.sections(0, 1), 0.95, "u", size="grip_top")
    recorder.scale(grip.sections(4, 5), 1.0, "u", size="grip_base")
    for number in (2, 3):
        recorder.rotate(grip.beyond(number, hinge=number), GRIP_BEND_DEG, "v", angle="grip_bend")
    recorder.rotate(grip.body(hinge=0), GRIP_RAKE_DEG, "v", angle="grip_rake")
    return grip


def _details(recorder: Recorder, shield: Loft, strap: Loft) -> list[Loft | Component]:
    below = lower(recorder, strap, 0, 1)
    guard = trigger_guard(recorder, below, 0.048, 0.036, along=0.012)
    lever = trigger(recorder, below, 0.021, along=0.006)
    hammer = beam(
        recorder,
        "+z",
        [
            Section(-0.012, 0.014, 0.008),
            Section(0.006, 0.010, 0.008, (-0.004, 0.0)),
            Section(0.016, 0.007, 0.008, (-0.010, 0.0)),
            Section(0.020, 0.006, 0.010, (-0.018, 0.0)),
        ],
        offset=(-0.004, 0.0, 0.0),
        anchors=upper(recorder, shield, 1),
    )
    recorder.part("hammer", components(hammer), present_when=(when("hammer", 1),))
    recorder.part("trigger guard", components(guard), present_when=(when("guard", 1),))
    return [guard, lever, hammer]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
