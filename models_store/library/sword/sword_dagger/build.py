"""Models a dagger or knife: a short blade, often tapered all along, with or without a guard."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades, guards
from shapewright.modeling import ProceduralModel, Recorder, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.22, 0.034, 0.010
BLADE_SEGMENTS = 6
BLADE_TAPER = 0.45  # share of the width that is lost up to the tip
LEAF = 0.06  # how far each edge bulges in the middle, relative to the width
TIP_LENGTH = 0.05
TIP_SHIFT = 0.20  # of the point towards the spine, relative to the width
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.055, 0.016, 1.4, 8.0
DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME = 0.055, 0.045, 0.008, 0.004
GRIP_LENGTH, GRIP_DIAMETER, GRIP_FLATNESS, POMMEL = 0.105, 0.030, 0.9, 0.034
HANDLE = (0.95, 0.95, 1.05, 1.08, 1.0, 0.92)
KNOB = (0.85, 1.04, 1.0, 0.6)
RIBS, RIB = 7, 1.15  # of the grip: how many, and their width relative to the grip's


def build() -> ProceduralModel:
    """Model the dagger."""
    recorder = Recorder(
        "sword_dagger", "sword", unit_m=1.0, description="A dagger, short sword or knife, with or without guard."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.6, 1.8, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.5, 1.6, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.25, 1.8, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", -0.2, 1.9, base_value=BLADE_TAPER)
    recorder.parameter("blade_leaf", "Bulge of the edges (share of the width)", -1.5, 3.0, base_value=LEAF)
    recorder.parameter("tip_length", "Tip length", 0.3, 2.2, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("tip_shift", "Point towards the spine (share of the width)", 0.0, 1.8, base_value=TIP_SHIFT)
    recorder.limit("tip_shift", maximum=("blade_taper", 1.95, -0.8))
    recorder.choice("guard", "Guard", ("cross bar", "disc", "none"))
    bar_there, disc_there = (when("guard", 1),), (when("guard", 2),)
    length, thickness = "Cross bar length (each arm)", "Cross bar thickness"
    recorder.parameter("bar_length", length, 0.5, 2.0, unit="m", base_value=BAR_LENGTH, active_when=bar_there)
    recorder.parameter("bar_thickness", thickness, 0.6, 2.4, unit="m", base_value=BAR_DIAMETER, active_when=bar_there)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.6, 1.4, base_value=BAR_END, active_when=bar_there)
    recorder.limit("bar_end", maximum=("bar_thickness", 1.9, -0.5))
    recorder.parameter("bar_bend", "Cross bar bend", -6, 8, unit="deg", base_value=BAR_BEND_DEG, active_when=bar_there)
    recorder.parameter("disc_width", "Disc width", 0.8, 1.7, unit="m", base_value=DISC_WIDTH, active_when=disc_there)
    recorder.parameter("disc_depth", "Disc depth", 0.75, 2.0, unit="m", base_value=DISC_DEPTH, active_when=disc_there)
    recorder.parameter("disc_dome", "Disc bulge", 0.2, 3.0, unit="m", base_value=DISC_DOME, active_when=disc_there)
    recorder.parameter("grip_length", "Grip length", 0.7, 1.6, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip width", 0.7, 1.7, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("grip_flatness", "Grip depth (relative to its width)", 0.5, 1.15, base_value=GRIP_FLATNESS)
    recorder.parameter("grip_ribs", "Grip ribs (width relative to the grip)", 0.87, 1.3, base_value=RIB)
    recorder.parameter("pommel_width", "Pommel width", 0.7, 1.5, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.3, 1.5, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, POMMEL, KNOB, ribs=RIBS, rib=RIB)
    recorder.scale(grip.all(), GRIP_FLATNESS, "v", size="grip_flatness")
    arms = guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    recorder.part("cross bar", arms.components, bar_there)
    disc, _ = guards.disc(recorder, grip, DISC_WIDTH, DISC_DEPTH, DISC_WALL, DISC_DOME)
    recorder.part("disc", [disc], disc_there)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.006, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, length="blade_taper")
    blades.hone(recorder, blade, [-LEAF * share for share in (-0.2, 0.2, 0.8, 1, 0.8, 0.4, 0, 0)], length="blade_leaf")
    blades.point(recorder, blade, (0.64, 0.06))
    blades.shift_tip(recorder, blade, (0.45 * TIP_SHIFT, TIP_SHIFT), length="tip_shift")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
