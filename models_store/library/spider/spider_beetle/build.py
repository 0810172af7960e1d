"""Models a beetle: an oval hull, a shield before it, a head with jaws or a horn, six legs at the lower edge."""

from pathlib import Path

from models_store.library.aids.beam import lower
from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft, move
from models_store.library.author import publish
from models_store.library.spider.arthropod import (
    Feelers,
    LegShape,
    Station,
    components,
    face,
    flanks,
    hub,
    legs,
    lift,
    resize,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LEGS = LegShape(
    length=1.2, thickness=0.09, raise_deg=22.0, knee_deg=55.0, ankle_deg=12.0, inset=0.20, raise_range=(-0.5, 2.0)
)
HEADINGS_DEG = (38.0, -8.0, -42.0)
HULL = (
    Section(-1.30, 0.36, 0.20),
    Section(-1.12, 0.78, 0.42),
    Section(-0.78, 1.14, 0.62),
    Section(-0.38, 1.22, 0.68),
    Section(0.00, 1.06, 0.60),
    Section(0.14, 0.66, 0.36),
)
SHIELD = (
    Section(-0.22, 0.62, 0.34),
    Section(0.03, 1.04, 0.54),
    Section(0.26, 0.94, 0.48),
    Section(0.42, 0.58, 0.30),
)
HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT = 0.42, 0.50, 0.30
BELLY_RISE = 0.10
HORN = (Section(-0.08, 0.16, 0.16), Section(0.15, 0.13, 0.13), Section(0.32, 0.10, 0.10), Section(0.45, 0.05, 0.05))
HORN_CURVE_DEG = 25.0
ANTENNAE = Feelers("antenna", "Antenna", 0.55, 0.05, heading_deg=50.0, raise_deg=15.0, curve_deg=35.0)
JAWS = Feelers("jaw", "Jaw", 0.42, 0.12, heading_deg=28.0, curve_deg=60.0, flatness=0.6, length_range=(0.3, 2.2))


def build() -> ProceduralModel:
    """Model the beetle."""
    recorder = Recorder(
        "spider_beetle", "spider", unit_m=0.01, description="A beetle: an oval hull, a shield, a head, six legs."
    )
    hull = loft(recorder, "x", HULL)
    resize(recorder, hull, "hull", "Hull", ((0.6, 1.6), (0.55, 1.35), (0.45, 1.7)), hinge=5)
    recorder.parameter("belly_rise", "Flatness of the belly", -0.5, 1.7, base_value=BELLY_RISE)
    recorder.limit("belly_rise", maximum=("hull_height", 0.1, 1.3))  # the belly stays below the back
    bellies = [lower(recorder, hull, number) for number in range(1, 5)]
    move(recorder, bellies, (0.0, 0.0, BELLY_RISE), length="belly_rise")
    shield = loft(recorder, "x", SHIELD, anchors=[hub(hull, 5)])
    resize(recorder, shield, "shield", "Shield", ((0.5, 1.8), (0.5, 1.3), (0.6, 1.6)), hinge=0)
    head = _head(recorder, shield)
    stations = [
        Station(flanks(recorder, body, number, down=0.5), heading)
        for (body, number), heading in zip(((shield, 2), (hull, 4), (hull, 3)), HEADINGS_DEG, strict=True)
    ]
    legs(recorder, LEGS, stations)
    face(recorder, head, (ANTENNAE, 3, (-0.08, -0.08, -0.04)), (JAWS, 4, (-0.10, -0.04, 0.0)))
    _horn(recorder, head)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _head(recorder: Recorder, shield: Loft) -> Loft:
    """A flat bulb before the shield."""
    sections = bulb(HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT, start=-0.10, count=5)
    head = loft(recorder, "x", sections, anchors=[hub(shield, 3)])
    resize(recorder, head, "head", "Head", ((0.6, 1.8), (0.6, 1.5), (0.6, 1.7)), hinge=0)
    lift(recorder, head, "head_lift", "Head higher or lower", 0.06)
    return head


def _horn(recorder: Recorder, head: Loft) -> None:
    """One horn on the forehead that curves upwards, or none."""
    recorder.switch("horn", "Horn")
    there = (when("horn", 1),)
    horn = loft(recorder, "x", HORN, sides=6, anchors=[hub(head, 3)])
    recorder.parameter("horn_length", "Horn length", 0.6, 2.0, base_value=HORN[-1].at, active_when=there, unit="cm")
    recorder.scale(horn.body(hinge=0), 1.0, "u", size="horn_length")
    recorder.parameter("horn_curve", "Horn curve upwards", -0.4, 1.8, active_when=there)
    for joint in (0, 1, 2):
        recorder.rotate(horn.beyond(joint, hinge=joint), -HORN_CURVE_DEG, "v", angle="horn_curve")
    recorder.part("horn", components(horn), present_when=there)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
