"""Models a sabre: a curved blade with one edge (towards -x), a bar or disc, and a knuckle bow of up to three bars."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades, guards
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.78, 0.038, 0.010
BLADE_SEGMENTS = 9
SWELL = 0.10  # how far the edge bulges before the tip, relative to the width
BLADE_CURVATURE_DEG = 26.0
TIP_LENGTH = 0.11
TIP_SHIFT = 0.40  # of the point towards the spine, relative to the width
TILT_DEG = 8.0  # of the grip
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.095, 0.013, 1.5, 6.0
DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME = 0.11, 0.075, 0.007, 0.008
BOW_WIDTH, BOW_DIAMETER, BOW_SPREAD_DEG = 0.075, 0.009, 32.0
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.15, 0.030, 0.040
HANDLE = (0.9, 0.95, 1.05, 1.1, 1.0, 0.85)
KNOB = (0.7, 1.04, 0.95, 0.5)


def build() -> ProceduralModel:
    """Model the sabre."""
    recorder = Recorder("sword_sabre", "sword", unit_m=1.0, description="A sabre or scimitar with a curved blade.")
    recorder.parameter("blade_length", "Blade length (without tip)", 0.5, 1.35, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.5, 2.0, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.3, 1.7, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_swell", "Edge bulge (share of the width)", -1.0, 4.0, base_value=SWELL)
    recorder.parameter("blade_curvature", "Blade curvature", 0.2, 2.2, unit="deg", base_value=BLADE_CURVATURE_DEG)
    recorder.parameter("tip_length", "Tip length", 0.3, 2.0, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("tip_shift", "Point towards the spine (share of the width)", 0, 1.2, base_value=TIP_SHIFT)
    recorder.choice("guard", "Guard", ("cross bar", "disc"))
    bar_there, disc_there = (when("guard", 1),), (when("guard", 2),)
    length, thickness = "Cross bar length (each arm)", "Cross bar thickness"
    recorder.parameter("bar_length", length, 0.4, 1.6, unit="m", base_value=BAR_LENGTH, active_when=bar_there)
    recorder.parameter("bar_thickness", thickness, 0.6, 2.0, unit="m", base_value=BAR_DIAMETER, active_when=bar_there)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.6, 1.5, base_value=BAR_END, active_when=bar_there)
    recorder.parameter("bar_bend", "Cross bar bend", -6, 8, unit="deg", base_value=BAR_BEND_DEG, active_when=bar_there)
    recorder.parameter("disc_width", "Disc width", 0.6, 1.5, unit="m", base_value=DISC_WIDTH, active_when=disc_there)
    recorder.parameter("disc_depth", "Disc depth", 0.7, 1.6, unit="m", base_value=DISC_DEPTH, active_when=disc_there)
    recorder.parameter("disc_dome", "Disc bulge", 0.2, 4.0, unit="m", base_value=DISC_DOME, active_when=disc_there)
    recorder.choice("bow", "Knuckle bow", ("three bars", "one bar", "none"))
    bow_there, three = (when("bow", 1, 2),), (when("bow", 1),)
    recorder.parameter(
        "bow_width", "Knuckle bow width", 0.6, 1.3, unit="m", base_value=BOW_WIDTH, active_when=bow_there
    )
    spread = "Angle between its bars"
    recorder.parameter("bow_spread", spread, 0.5, 1.7, unit="deg", base_value=BOW_SPREAD_DEG, active_when=three)
    recorder.parameter("grip_length", "Grip length", 0.65, 1.7, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.6, 1.5, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("grip_tilt", "Grip tilt", -0.5, 2.0, unit="deg", base_value=TILT_DEG)
    recorder.parameter("pommel_width", "Pommel width", 0.6, 1.5, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.4, 1.5, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, POMMEL, KNOB)
    arms = guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    recorder.part("cross bar", arms.components, bar_there)
    disc, _ = guards.disc(recorder, grip, DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME)
    recorder.part("disc", [disc], disc_there)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.006, segments=BLADE_SEGMENTS)
    bulge = [-SWELL * share for share in (0.0, 0.0, 0.0, 0.1, 0.3, 0.6, 0.9, 1.0, 0.9, 0.6, 0.0)]
    blades.hone(recorder, blade, bulge, sides="-x", length="blade_swell")
    blades.point(recorder, blade, (0.66, 0.06))
    blades.shift_tip(recorder, blade, (0.45 * TIP_SHIFT, TIP_SHIFT), length="tip_shift")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.bend(recorder, blade, BLADE_CURVATURE_DEG, angle="blade_curvature")

    middle = guards.bow(recorder, grip, BOW_WIDTH, GRIP_LENGTH, BOW_DIAMETER, [grip.top])
    sides = [grip.top, Target(grip.top.elements, "world", (Mirror("y"),))]
    outer = guards.bow(recorder, grip, BOW_WIDTH, GRIP_LENGTH, BOW_DIAMETER, sides)
    recorder.rotate(outer.body(hinge=0), BOW_SPREAD_DEG, "z", angle="bow_spread")
    recorder.part("middle bar of the bow", middle.components, bow_there)
    recorder.part("outer bars of the bow", outer.components, three)
    lower = [vertex for ring in (*grip.handle[2:], *grip.knob) for vertex in ring]
    bows = [component.whole for component in (*middle.components, *outer.components)]
    recorder.rotate(Target((*lower, *bows), "world", (), grip.handle[0]), -TILT_DEG, "v", angle="grip_tilt")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
