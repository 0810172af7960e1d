"""Models a rapier or foil: a slender blade behind a cup or disc, a cross bar, or both; side rings and a knuckle bow."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.sword import blades, guards
from models_store.library.sword.tubes import arc, tube
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.86, 0.028, 0.010
BLADE_SEGMENTS = 6
BLADE_TAPER = 0.5  # share of the width that is lost up to the tip
TIP_LENGTH = 0.06
CUP_DIAMETER, CUP_WALL, CUP_DOME = 0.12, 0.006, 0.035
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.10, 0.012, 1.9, 8.0
RING_RADIUS, RING_DIAMETER = 0.05, 0.008
BOW_WIDTH, BOW_DIAMETER = 0.065, 0.009
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.13, 0.028, 0.042
SWELL = (0.9, 0.95, 1.08, 1.08, 0.95, 0.8)
KNOB = (0.7, 1.04, 0.95, 0.5)
RIBS, RIB = 7, 1.15  # of the grip: how many, and their width relative to the grip's


def build() -> ProceduralModel:
    """Model the rapier."""
    recorder = Recorder(
        "sword_rapier", "sword", unit_m=1.0, description="A rapier or foil with cross bar, cup or both."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.5, 1.4, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.35, 2.5, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.2, 1.6, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", 0.0, 1.85, base_value=BLADE_TAPER)
    recorder.parameter("tip_length", "Tip length", 0.2, 2.5, unit="m", base_value=TIP_LENGTH)
    recorder.choice("guard", "Guard", ("cross bar", "cup and cross bar", "cup"))
    bar_there, cup_there = (when("guard", 1, 2),), (when("guard", 2, 3),)
    length, bar_depth = "Cross bar length (each arm)", "Cross bar thickness"
    recorder.parameter("bar_length", length, 0.5, 1.6, unit="m", base_value=BAR_LENGTH, active_when=bar_there)
    recorder.parameter("bar_thickness", bar_depth, 0.6, 1.6, unit="m", base_value=BAR_DIAMETER, active_when=bar_there)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.5, 1.4, base_value=BAR_END, active_when=bar_there)
    recorder.parameter("bar_bend", "Cross bar bend", -4, 6, unit="deg", base_value=BAR_BEND_DEG, active_when=bar_there)
    recorder.parameter("disc_width", "Cup width", 0.4, 1.5, unit="m", base_value=CUP_DIAMETER, active_when=cup_there)
    recorder.parameter(
        "disc_depth", "Cup depth (relative to its width)", 0.75, 1.0, base_value=1.0, active_when=cup_there
    )
    recorder.parameter("disc_dome", "Cup height", 0.05, 2.4, unit="m", base_value=CUP_DOME, active_when=cup_there)
    recorder.switch("rings", "Side rings", active_when=bar_there)
    rings_there = (*bar_there, when("rings", 1))
    recorder.parameter(
        "ring_size", "Side ring size", 0.5, 1.4, unit="m", base_value=RING_RADIUS, active_when=rings_there
    )
    recorder.switch("bow", "Knuckle bow")
    bow_there = (when("bow", 1),)
    recorder.parameter(
        "bow_width", "Knuckle bow width", 0.6, 1.3, unit="m", base_value=BOW_WIDTH, active_when=bow_there
    )
    recorder.parameter("grip_length", "Grip length", 0.6, 1.8, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.5, 1.8, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("grip_ribs", "Grip ribs (width relative to the grip)", 0.87, 1.3, base_value=RIB)
    recorder.parameter("pommel_width", "Pommel width", 0.4, 1.6, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.3, 2.2, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, SWELL, POMMEL, KNOB, ribs=RIBS, rib=RIB)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.004, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, length="blade_taper")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.point(recorder, blade, (0.66, 0.08))

    arms = guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    recorder.part("cross bar", arms.components, bar_there)
    cup, _ = guards.disc(recorder, grip, CUP_DIAMETER, CUP_DIAMETER, CUP_WALL, CUP_DOME)
    recorder.part("cup", [cup], cup_there)
    sides = [grip.top, Target(grip.top.elements, "world", (Mirror("y"),))]
    path = arc((0.0, 0.9 * RING_RADIUS, 0.0), RING_RADIUS, -72.0, 252.0, 10, normal="z")
    rings = tube(recorder, path, [RING_DIAMETER] * len(path), normal="z", anchors=sides, sides=5)
    copies = zip(rings.components, rings.images, strict=True)
    whole = [Target((component.whole,), "world", image, grip.handle[0]) for component, image in copies]
    recorder.scale(whole, 1.0, "uv", size="ring_size")
    recorder.part("side rings", rings.components, rings_there)
    bow = guards.bow(recorder, grip, BOW_WIDTH, GRIP_LENGTH, BOW_DIAMETER, [grip.top])
    recorder.part("knuckle bow", bow.components, bow_there)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
