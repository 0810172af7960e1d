"""Models a straight sword with a cross guard along the z axis, the tip upwards, the edges towards +x and -x."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, group, mirrored

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.68, 0.050, 0.012
BLADE_SEGMENTS = 8
BLADE_TAPER = 0.30  # share of the width that is lost up to the tip
BLADE_CURVATURE_DEG = 2.0  # between root and tip
TIP_LENGTH = 0.08
TIP_WIDTHS = (0.68, 0.12)  # halfway and at the end
GUARD_BLOCK, GUARD_DEPTH, GUARD_HEIGHT = 0.05, 0.036, 0.030
ARM_LENGTH = 0.08
GUARD_CURVATURE_DEG = 12.0
ARM_THICKNESS = 0.65  # relative to the block between the arms
ARM_SEGMENTS = 4
ARM_END = 1.7  # thickness of the knobs, relative to the arms
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.15, 0.030, 0.050
SWELL = (1.0, 1.0, 1.05, 1.12, 1.0, 0.85)
KNOB = (0.68, 1.04, 0.95, 0.45)
BAR_CONTROL = 12 / 11  # a bar of square section ends this much thinner than its control mesh


def build() -> ProceduralModel:
    """Model the sword."""
    recorder = Recorder("sword", "sword", unit_m=1.0, description="A straight sword with cross guard, grip and pommel.")
    recorder.parameter("blade_length", "Blade length (without tip)", 0.35, 1.5, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.4, 2.2, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.25, 2.0, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", -0.6, 2.8, base_value=BLADE_TAPER)
    recorder.parameter("tip_length", "Tip length", 0.2, 3.0, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("tip_width", "Tip width at its end (relative to the blade)", 0.3, 3.0, base_value=TIP_WIDTHS[1])
    recorder.parameter("blade_curvature", "Blade curvature", 0.0, 3.0, unit="deg", base_value=BLADE_CURVATURE_DEG)
    recorder.parameter("guard_arm_length", "Guard arm length", 0.2, 2.0, unit="m", base_value=ARM_LENGTH)
    recorder.parameter("guard_depth", "Guard depth", 0.5, 2.5, unit="m", base_value=GUARD_DEPTH)
    recorder.parameter(
        "guard_arm_thickness", "Guard arm thickness (relative to its block)", 0.4, 1.5, base_value=ARM_THICKNESS
    )
    recorder.parameter("guard_end", "Guard knob thickness (relative to the arm)", 0.6, 1.5, base_value=ARM_END)
    recorder.parameter("guard_curvature", "Guard bend", -3.0, 4.0, unit="deg", base_value=GUARD_CURVATURE_DEG)
    recorder.parameter("grip_length", "Grip length", 0.5, 2.0, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.5, 1.6, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("pommel_width", "Pommel width", 0.5, 1.6, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.4, 1.7, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, SWELL, POMMEL, KNOB)
    _guard(recorder, grip.top)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.006, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, length="blade_taper")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.point(recorder, blade, TIP_WIDTHS, size="tip_width")
    blades.bend(recorder, blade, BLADE_CURVATURE_DEG, angle="blade_curvature")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _guard(recorder: Recorder, anchor: Target) -> Component:
    """A block with two arms that are bent alike."""
    depth, height = BAR_CONTROL * GUARD_DEPTH, BAR_CONTROL * GUARD_HEIGHT
    guard = recorder.box(GUARD_BLOCK, depth, height, offset=(0.0, 0.0, -height / 2), anchor=anchor)
    right, left = guard.sides[1], guard.sides[3]
    arms = [Target((right,)), mirrored("x", left)]
    for segment in range(ARM_SEGMENTS):
        recorder.extrude(arms, ARM_LENGTH / ARM_SEGMENTS, length="guard_arm_length")
        recorder.rotate(arms, -GUARD_CURVATURE_DEG / ARM_SEGMENTS, "u", angle="guard_curvature")
        if segment == 0:
            recorder.scale(arms, ARM_THICKNESS, "uv", size="guard_arm_thickness")
    knob = 0.28 * GUARD_HEIGHT
    recorder.extrude(arms, knob)
    recorder.scale(arms, ARM_END, "uv", size="guard_end")
    for size in (1.0, 0.6):
        recorder.extrude(arms, knob)
        recorder.scale(arms, size, "uv")
    recorder.scale(group(guard.whole, frame="world"), 1.0, "v", size="guard_depth")
    return guard


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
