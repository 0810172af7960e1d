"""Models an ornate sword: wings of flat plates as its guard, one pair or two, or a bar with prongs along the blade."""

from pathlib import Path

from models_store.library.aids.loft import Loft, Section, Vector, loft
from models_store.library.author import publish
from models_store.library.sword import blades, guards
from models_store.library.sword.blades import Grip
from models_store.library.sword.tubes import tube
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.62, 0.056, 0.012
BLADE_SEGMENTS = 8
BLADE_TAPER = 0.15  # share of the width that is lost up to the tip
TIP_LENGTH = 0.12
BOSS_WIDTH, BOSS_DEPTH, BOSS_WALL, BOSS_DOME = 0.060, 0.040, 0.036, 0.012
WING_LENGTH, WING_HEIGHT, WING_THICKNESS, WING_BEND_DEG = 0.13, 0.060, 0.014, 40.0
LOWER_SIZE = 0.75  # of the second pair, relative to the first
LOWER_BEND_DEG = 25.0
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.085, 0.020, 1.5, 6.0
PRONG_LENGTH, PRONG_DIAMETER, PRONG_BEND_DEG = 0.13, 0.013, 8.0
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.14, 0.030, 0.052
HANDLE = (1.0, 1.0, 1.08, 1.15, 1.0, 0.85)
KNOB = (0.68, 1.04, 0.95, 0.5)
RIBS, RIB = 7, 1.15  # of the grip: how many, and their width relative to the grip's


def build() -> ProceduralModel:
    """Model the sword."""
    recorder = Recorder(
        "sword_winged", "sword", unit_m=1.0, description="An ornate sword whose guard bears wings or prongs."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.5, 1.5, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.5, 1.9, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.25, 2.5, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", -1.5, 4.0, base_value=BLADE_TAPER)
    recorder.parameter("tip_length", "Tip length", 0.2, 2.2, unit="m", base_value=TIP_LENGTH)
    recorder.choice("guard", "Guard", ("wings", "two pairs of wings", "prongs"))
    wings_there, lower_there, prongs_there = (when("guard", 1, 2),), (when("guard", 2),), (when("guard", 3),)
    long, high, thick, bent = "Wing length", "Wing height", "Wing thickness", "Wing bend"
    recorder.parameter("wing_length", long, 0.7, 1.5, unit="m", base_value=WING_LENGTH, active_when=wings_there)
    recorder.parameter("wing_height", high, 0.4, 1.8, unit="m", base_value=WING_HEIGHT, active_when=wings_there)
    recorder.parameter("wing_thickness", thick, 0.4, 2.0, unit="m", base_value=WING_THICKNESS, active_when=wings_there)
    recorder.parameter("wing_bend", bent, -1.0, 1.7, unit="deg", base_value=WING_BEND_DEG, active_when=wings_there)
    recorder.parameter(
        "lower_size", "Lower wings (relative to the upper)", 0.6, 1.4, base_value=LOWER_SIZE, active_when=lower_there
    )
    recorder.parameter(
        "lower_bend", "Lower wing bend", -1.0, 3.0, unit="deg", base_value=LOWER_BEND_DEG, active_when=lower_there
    )
    bar, rod = "Cross bar length (each arm)", "Cross bar thickness"
    recorder.parameter("bar_length", bar, 0.6, 1.6, unit="m", base_value=BAR_LENGTH, active_when=prongs_there)
    recorder.parameter("bar_thickness", rod, 0.6, 1.6, unit="m", base_value=BAR_DIAMETER, active_when=prongs_there)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.6, 1.4, base_value=BAR_END, active_when=prongs_there)
    recorder.parameter(
        "bar_bend", "Cross bar bend", -5, 6, unit="deg", base_value=BAR_BEND_DEG, active_when=prongs_there
    )
    recorder.parameter(
        "prong_length", "Prong length", 0.4, 1.7, unit="m", base_value=PRONG_LENGTH, active_when=prongs_there
    )
    recorder.parameter(
        "prong_bend", "Prong bend outwards", -3.0, 4.0, unit="deg", base_value=PRONG_BEND_DEG, active_when=prongs_there
    )
    recorder.parameter("disc_width", "Boss width", 0.7, 1.4, unit="m", base_value=BOSS_WIDTH)
    recorder.parameter("disc_depth", "Boss depth", 0.6, 1.4, unit="m", base_value=BOSS_DEPTH)
    recorder.parameter("disc_dome", "Boss bulge", 0.2, 2.5, unit="m", base_value=BOSS_DOME)
    recorder.parameter("grip_length", "Grip length", 0.7, 1.8, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.6, 1.5, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("grip_ribs", "Grip ribs (width relative to the grip)", 0.87, 1.3, base_value=RIB)
    recorder.parameter("pommel_width", "Pommel width", 0.5, 1.5, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.5, 1.6, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, POMMEL, KNOB, ribs=RIBS, rib=RIB)
    guards.disc(recorder, grip, BOSS_WIDTH, BOSS_DEPTH, BOSS_WALL, BOSS_DOME)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.010, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, length="blade_taper")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.point(recorder, blade, (0.62, 0.06))

    upper = _wings(recorder, grip, 1.0, WING_BEND_DEG, "wing_bend")
    lower = _wings(recorder, grip, LOWER_SIZE, -LOWER_BEND_DEG, "lower_bend")
    recorder.scale(_about_grip(grip, lower), 1.0, "uz", size="lower_size")
    for wings in (upper, lower):
        recorder.scale(_about_grip(grip, wings), 1.0, "u", size="wing_length")
        recorder.scale(_about_grip(grip, wings), 1.0, "v", size="wing_thickness")
    recorder.rotate(_about_grip(grip, lower), 28.0, "v")
    recorder.part("wings", upper.components, wings_there)
    recorder.part("lower wings", lower.components, lower_there)
    arms = guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    prongs = _prongs(recorder, arms)
    recorder.part("bar and prongs", (*arms.components, *prongs.components), prongs_there)
    recorder.symmetry(mirrors=("x", "y"))
    return recorder.build()


def _wings(recorder: Recorder, grip: Grip, size: float, bend_deg: float, angle: str) -> Loft:
    """A plate on each side that widens and ends in a point, bent about the y axis piece by piece."""
    places = ((0.0, 0.35, 0.0), (0.3, 0.4, 0.0), (0.5, 0.75, 0.05), (0.7, 1.0, 0.1), (0.88, 0.8, 0.2), (1.0, 0.15, 0.5))
    sections = [
        Section(at * size * WING_LENGTH, WING_THICKNESS, high * size * WING_HEIGHT, (0.0, up * size * WING_HEIGHT))
        for at, high, up in places
    ]
    sides = [grip.top, Target(grip.top.elements, "world", (Mirror("x"),))]
    made = loft(recorder, "x", sections, sides=6, anchors=sides)
    for level in range(1, len(sections)):
        recorder.scale(made.sections(level), 1.0, "z", size="wing_height")
    for level in range(1, 4):
        recorder.rotate(made.beyond(level + 1, hinge=level), -bend_deg / 3, "v", angle=angle)
    return made


def _prongs(recorder: Recorder, arms: Loft) -> Loft:
    """A rod upwards from the end of each arm, with a short piece below it, ending in a point."""
    ends = [Target(ring, "world", image) for ring, image in zip(arms.rings[5], arms.images, strict=True)]
    path: list[Vector] = [(0.0, 0.0, share * PRONG_LENGTH) for share in (-0.2, 0.0, 0.3, 0.6, 0.85, 1.0)]
    widths = [PRONG_DIAMETER * share for share in (0.9, 1.0, 1.0, 0.9, 0.6, 0.1)]
    made = tube(recorder, path, widths, normal="y", anchors=ends)
    for level in (2, 3, 4):
        recorder.rotate(made.beyond(level + 1, hinge=level), PRONG_BEND_DEG, "v", angle="prong_bend")
    recorder.scale(made.body(hinge=1), 1.0, "z", size="prong_length")
    return made


def _about_grip(grip: Grip, made: Loft) -> list[Target]:
    """Return a body and its copies as targets about the upper end of the grip."""
    copies = zip(made.components, made.images, strict=True)
    return [Target((component.whole,), "world", image, grip.handle[0]) for component, image in copies]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
