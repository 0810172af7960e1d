"""Models a bubble helicopter: an egg of a cabin, a thin tail boom (a tube or a lattice) behind it, skids."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from models_store.library.aids.beam import beam, upper
from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft, move
from models_store.library.author import publish
from models_store.library.helicopter.airframe import Fin, Tailplane, fin, tailplane, whole
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor, tail_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

CABIN_LENGTH, CABIN_WIDTH, CABIN_HEIGHT = 3.5, 1.85, 2.0
REAR = 1  # the section of the cabin that bears the boom
TUBE = (
    Section(-4.6, 0.20, 0.22),
    Section(-3.1, 0.26, 0.30),
    Section(-1.2, 0.36, 0.44),
    Section(0.5, 0.50, 0.60),
)
BOOM_RISE = 0.30
BOOM_LIFT = 0.10
STATIONS = (-4.6, -3.9, -3.1, -2.2, -1.3, -0.4, 0.5)
ROD = 0.07
_ENDS = (STATIONS[0], STATIONS[-1])
LATTICE_ROOT, LATTICE_TIP = 0.36, 0.06  # distance of the rods from the middle of the boom
ROTOR = Rotor((4, 2, 3), ("disc", "none"), 8.0, 0.32, (0.6, 1.4))
MAST = Mast(0.8, 0.14, 0.4, (0.4, 2.2))
TAIL_ROTOR = Rotor((4, 2, 3), ("disc", "none"), 1.4, 0.14, (0.5, 1.7), "tail_rotor", "Tail rotor")
FIN = Fin(height=0.9, chord=0.6, sweep=0.35, forward=0.12)
TAILPLANE = Tailplane(span=0.8, chord=0.42, endplate=0.6)
GEAR = Gear(("skids", "nose wheel", "none"), 0.7, 0.4, 0.4, 2.7, 0.11, 0.42, 0.5)


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder(
        "helicopter_bubble", "helicopter", unit_m=1.0, description="An egg-shaped cabin with a thin tail boom."
    )
    cabin = _cabin(recorder)
    boom = _boom(recorder, cabin)
    upright = fin(recorder, FIN, boom)
    tailplane(recorder, TAILPLANE, Target(boom.rings[1][0], "world"), Target(upright.rings[2][0], "world"))
    apart = main_rotor(recorder, ROTOR, MAST, upper(recorder, cabin, 2))
    low = Target((*upright.rings[0][0], *upright.rings[1][0]), "world")
    apart += tail_rotor(recorder, TAIL_ROTOR, low, aside=0.18, moves=0.18)
    undercarriage(recorder, GEAR, cabin, 4, 2, nose=5, tail=0, lengthens=("cabin_length",))
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


def _cabin(recorder: Recorder) -> Loft:
    """An egg; its rear may be drawn up and out towards the boom, its nose may sink."""
    cabin = loft(recorder, "x", bulb(CABIN_LENGTH, CABIN_WIDTH, CABIN_HEIGHT, start=-1.8, count=7, peak=0.95))
    for what, axis in (("length", "u"), ("width", "v"), ("height", "z")):
        recorder.parameter(f"cabin_{what}", f"Cabin {what}", 0.65, 1.4, kind="length")
        recorder.scale(cabin.body(hinge=3), 1.0, axis, size=f"cabin_{what}")
    recorder.parameter("cabin_rear", "Rear of the cabin drawn out", 0.0, 2.2, base_value=0.4, unit="m")
    move(recorder, cabin.sections(0, 1), (-0.4, 0.0, 0.15), length="cabin_rear")
    recorder.parameter("nose_drop", "Nose lower than the cabin", -1.0, 2.2, base_value=0.15, unit="m")
    for number, share in ((5, 0.5), (6, 1.0)):
        move(recorder, cabin.sections(number), (0.0, 0.0, -0.15 * share), length="nose_drop")
    recorder.parameter("nose_point", "Pointed or blunt nose", 0.5, 1.7)
    recorder.scale(cabin.sections(6), 1.0, "vz", size="nose_point")
    return cabin


def _boom(recorder: Recorder, cabin: Loft) -> Loft:
    """A tube, or four rods with zigzag bracing at both sides."""
    anchor = Target(cabin.rings[REAR][0], "world")
    tube = loft(recorder, "x", TUBE, sides=6, offset=(0.0, 0.0, BOOM_LIFT), anchors=[anchor])
    sides = (anchor, replace(anchor, image=(Mirror("y"),)))
    high, low, brace = (_rods(recorder, heights, sides) for heights in ((1, 1), (-1, -1), (1, -1, 1, -1, 1, -1, 1)))
    recorder.choice("boom", "Tail boom", ("tube", "lattice"))
    recorder.parameter("tail_length", "Tail boom length", 0.5, 1.3, base_value=-TUBE[0].at, unit="m")
    recorder.scale(
        [target for body in (tube, high, low, brace) for target in body.body(hinge=len(body.rings) - 1)],
        1.0,
        "u",
        size="tail_length",
    )
    tubular = (when("boom", 1),)
    recorder.parameter(
        "tail_thickness", "Tail boom thickness", 0.4, 2.0, base_value=TUBE[1].width, active_when=tubular, unit="m"
    )
    recorder.scale(tube.sections(0, 1, 2, 3), 1.0, "vz", size="tail_thickness")
    recorder.parameter("tail_rise", "Tip of the tail boom raised", -0.8, 2.2, base_value=BOOM_RISE, unit="m")
    for places, bodies in (([s.at for s in TUBE], (tube,)), (_ENDS, (high, low)), (STATIONS, (brace,))):
        for number, place in enumerate(places[:-1]):
            share = (STATIONS[-1] - place) / (STATIONS[-1] - STATIONS[0])
            targets = [target for body in bodies for target in body.sections(number)]
            move(recorder, targets, (0.0, 0.0, BOOM_RISE * share), length="tail_rise")
    recorder.part("tube", [tube.component], present_when=tubular)
    recorder.part("lattice", whole(high, low, brace), present_when=(when("boom", 2),))
    return tube


def _rods(recorder: Recorder, heights: Sequence[int], sides: Sequence[Target]) -> Loft:
    """A rod at either side that leads from the tip to the root, at the top (1) or the bottom (-1) of the lattice."""
    places = _ENDS if len(heights) == 2 else STATIONS
    sections = []
    for place, height in zip(places, heights, strict=True):
        share = (place - STATIONS[0]) / (STATIONS[-1] - STATIONS[0])
        off = LATTICE_TIP + share * (LATTICE_ROOT - LATTICE_TIP)
        sections.append(Section(place, ROD, ROD, (off * 0.8, off * height)))
    return beam(recorder, "+x", sections, crease="all", offset=(0.0, 0.0, BOOM_LIFT), anchors=sides)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
