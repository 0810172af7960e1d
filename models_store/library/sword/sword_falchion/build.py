"""Models a broad sword with one edge (towards -x): falchion, machete, headsman's sword with a blunt tip."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades, guards
from shapewright.modeling import ProceduralModel, Recorder, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.55, 0.055, 0.009
BLADE_SEGMENTS = 8
FLARE = 0.20  # how much wider the blade is before its tip, relative to the width
BELLY = 0.08  # how far the edge bulges in the last third, relative to the width
BLADE_CURVATURE_DEG = 8.0
TIP_LENGTH = 0.10
TIP_WIDTH = 0.22  # relative to the blade
TIP_SHIFT = 0.35  # of the point towards the spine, relative to the width
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.075, 0.018, 1.4, 8.0
DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME = 0.10, 0.085, 0.010, 0.006
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.14, 0.032, 0.046
HANDLE = (1.0, 0.95, 1.0, 1.08, 1.0, 0.9)
KNOB = (0.7, 1.04, 0.95, 0.5)


def build() -> ProceduralModel:
    """Model the falchion."""
    recorder = Recorder(
        "sword_falchion", "sword", unit_m=1.0, description="A broad sword with one edge: falchion or machete."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.55, 1.5, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.6, 1.8, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.3, 1.8, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_flare", "Blade flare (share of the width)", -1.5, 3.5, base_value=FLARE)
    recorder.parameter("blade_belly", "Edge bulge (share of the width)", -1.5, 4.0, base_value=BELLY)
    recorder.parameter("blade_curvature", "Blade curvature", 0.0, 2.8, unit="deg", base_value=BLADE_CURVATURE_DEG)
    recorder.parameter("tip_length", "Tip length", 0.1, 2.0, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("tip_width", "Tip width at its end (relative to the blade)", 0.2, 3.5, base_value=TIP_WIDTH)
    recorder.parameter("tip_shift", "Point towards the spine (share of the width)", -0.2, 1.3, base_value=TIP_SHIFT)
    recorder.choice("guard", "Guard", ("cross bar", "disc", "none"))
    bar_there, disc_there = (when("guard", 1),), (when("guard", 2),)
    length, thickness = "Cross bar length (each arm)", "Cross bar thickness"
    recorder.parameter("bar_length", length, 0.5, 1.8, unit="m", base_value=BAR_LENGTH, active_when=bar_there)
    recorder.parameter("bar_thickness", thickness, 0.6, 1.8, unit="m", base_value=BAR_DIAMETER, active_when=bar_there)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.6, 1.5, base_value=BAR_END, active_when=bar_there)
    recorder.parameter("bar_bend", "Cross bar bend", -6, 8, unit="deg", base_value=BAR_BEND_DEG, active_when=bar_there)
    recorder.parameter("disc_width", "Disc width", 0.7, 1.7, unit="m", base_value=DISC_WIDTH, active_when=disc_there)
    recorder.parameter("disc_depth", "Disc depth", 0.7, 1.7, unit="m", base_value=DISC_DEPTH, active_when=disc_there)
    recorder.parameter("disc_dome", "Disc bulge", 0.2, 5.0, unit="m", base_value=DISC_DOME, active_when=disc_there)
    recorder.parameter("grip_length", "Grip length", 0.7, 1.8, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.7, 1.6, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("pommel_width", "Pommel width", 0.65, 1.7, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.3, 1.7, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, POMMEL, KNOB)
    arms = guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    recorder.part("cross bar", arms.components, bar_there)
    disc, _ = guards.disc(recorder, grip, DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME)
    recorder.part("disc", [disc], disc_there)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.008, segments=BLADE_SEGMENTS)
    wider = [-FLARE / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, wider, length="blade_flare")
    bulge = [-BELLY * share for share in (0.0, 0.0, -0.2, -0.1, 0.3, 0.8, 1.0, 1.0, 0.7, 0.0)]
    blades.hone(recorder, blade, bulge, sides="-x", length="blade_belly")
    blades.point(recorder, blade, (0.74, TIP_WIDTH), size="tip_width")
    blades.shift_tip(recorder, blade, (0.35 * TIP_SHIFT, TIP_SHIFT), length="tip_shift")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.bend(recorder, blade, BLADE_CURVATURE_DEG, angle="blade_curvature")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
