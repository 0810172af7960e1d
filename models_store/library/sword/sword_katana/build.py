"""Models a katana: a slightly curved blade with one edge (towards -x), a disc, and a long flat grip."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades, guards
from shapewright.modeling import ProceduralModel, Recorder, Target, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.72, 0.036, 0.010
BLADE_SEGMENTS = 9
BLADE_TAPER = 0.15  # share of the width that is lost up to the tip, at the edge
BLADE_CURVATURE_DEG = 14.0
TIP_LENGTH = 0.05
TIP_SHIFT = 0.42  # of the point towards the spine, relative to the width
DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME = 0.085, 0.065, 0.006, 0.004
GRIP_LENGTH, GRIP_DIAMETER, GRIP_FLATNESS, CAP = 0.25, 0.036, 0.8, 0.02
TILT_DEG = 5.0
HANDLE = (1.0, 0.98, 0.95, 0.93, 0.96, 1.0, 1.03)
KNOB = (1.0, 0.8)


def build() -> ProceduralModel:
    """Model the katana."""
    recorder = Recorder(
        "sword_katana", "sword", unit_m=1.0, description="A katana or another curved sword with a disc as guard."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.45, 1.35, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.5, 1.9, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.3, 1.8, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Edge taper (share of width lost)", -1.5, 3.0, base_value=BLADE_TAPER)
    recorder.parameter("blade_curvature", "Blade curvature", 0.0, 2.5, unit="deg", base_value=BLADE_CURVATURE_DEG)
    recorder.parameter("tip_length", "Tip length", 0.1, 2.5, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("tip_shift", "Point towards the spine (share of the width)", 0.3, 1.1, base_value=TIP_SHIFT)
    recorder.switch("disc", "Disc")
    there = (when("disc", 1),)
    recorder.parameter("disc_width", "Disc width", 0.65, 1.6, unit="m", base_value=DISC_WIDTH, active_when=there)
    recorder.parameter("disc_depth", "Disc depth", 0.7, 2.0, unit="m", base_value=DISC_DEPTH, active_when=there)
    recorder.parameter("disc_dome", "Disc bulge", 0.3, 6.0, unit="m", base_value=DISC_DOME, active_when=there)
    recorder.parameter("grip_length", "Grip length", 0.45, 1.6, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip width", 0.65, 1.4, unit="m", base_value=GRIP_DIAMETER)
    recorder.limit("grip_thickness", minimum=("blade_width", 0.1, 0.5))
    recorder.parameter("grip_flatness", "Grip depth (relative to its width)", 0.5, 1.3, base_value=GRIP_FLATNESS)
    recorder.parameter("grip_tilt", "Grip tilt", -0.5, 2.0, unit="deg", base_value=TILT_DEG)
    recorder.parameter("pommel_width", "Cap width", 0.85, 1.25, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("pommel_length", "Cap length", 0.4, 2.5, unit="m", base_value=CAP)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, CAP, KNOB, pommel_width=GRIP_DIAMETER)
    recorder.scale(grip.all(), GRIP_FLATNESS, "v", size="grip_flatness")
    disc, _ = guards.disc(recorder, grip, DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME)
    recorder.part("disc", [disc], there)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.012, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, sides="-x", length="blade_taper")
    blades.point(recorder, blade, (0.7, 0.08))
    blades.shift_tip(recorder, blade, (0.4 * TIP_SHIFT, TIP_SHIFT), length="tip_shift")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.bend(recorder, blade, BLADE_CURVATURE_DEG, angle="blade_curvature")
    lower = [vertex for ring in (*grip.handle[2:], *grip.knob) for vertex in ring]
    recorder.rotate(Target(tuple(lower), "world", (), grip.handle[0]), -TILT_DEG, "v", angle="grip_tilt")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
