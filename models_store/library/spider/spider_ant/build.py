"""Models an ant: head, middle and abdomen on thin waists, six legs, bent antennae and jaws."""

from pathlib import Path

from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft
from models_store.library.author import publish
from models_store.library.spider.arthropod import (
    Feelers,
    LegShape,
    Station,
    face,
    flanks,
    hub,
    legs,
    lift,
    resize,
    tilt,
)
from shapewright.modeling import ProceduralModel, Recorder

LEGS = LegShape(
    length=1.7, thickness=0.11, raise_deg=32.0, knee_deg=80.0, ankle_deg=10.0, inset=0.16, raise_range=(-1.1, 1.8)
)
HEADINGS_DEG = (42.0, -6.0, -46.0)
MIDDLE = (
    Section(-0.52, 0.16, 0.16),
    Section(-0.34, 0.36, 0.34),
    Section(-0.06, 0.46, 0.44, (0.0, 0.03)),
    Section(0.22, 0.50, 0.46, (0.0, 0.04)),
    Section(0.42, 0.32, 0.30),
    Section(0.54, 0.18, 0.18),
)
WAIST = (Section(-0.34, 0.20, 0.20), Section(-0.18, 0.18, 0.22), Section(0.0, 0.16, 0.16), Section(0.12, 0.12, 0.12))
WAIST_OVERLAP = 0.05
ABDOMEN_LENGTH, ABDOMEN_WIDTH, ABDOMEN_HEIGHT = 1.25, 0.78, 0.74
HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT = 0.72, 0.66, 0.52
ANTENNAE = Feelers("antenna", "Antenna", 0.95, 0.06, heading_deg=42.0, raise_deg=25.0, curve_deg=45.0)
JAWS = Feelers("jaw", "Jaw", 0.38, 0.13, heading_deg=22.0, curve_deg=55.0, flatness=0.6)


def build() -> ProceduralModel:
    """Model the ant."""
    recorder = Recorder(
        "spider_ant", "spider", unit_m=0.01, description="An ant: three parts on thin waists, six legs, antennae."
    )
    middle = loft(recorder, "x", MIDDLE)
    resize(recorder, middle, "middle", "Middle", ((0.6, 1.5), (0.65, 1.5), (0.6, 1.6)), hinge=2)
    _abdomen(recorder, middle)
    head = _head(recorder, middle)
    stations = [Station(flanks(recorder, middle, 3 - i, down=0.5), heading) for i, heading in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations)
    face(recorder, head, (ANTENNAE, 3, (-0.10, -0.10, -0.06)), (JAWS, 4, (-0.12, -0.05, 0.0)))
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _abdomen(recorder: Recorder, middle: Loft) -> None:
    """A bulb behind a waist; the waist's length carries it away from the middle."""
    waist = loft(recorder, "x", WAIST, sides=6, anchors=[hub(middle, 0)])
    recorder.parameter("waist_length", "Waist length", 0.3, 2.5, base_value=-WAIST[0].at, unit="cm")
    recorder.parameter("waist_thickness", "Waist thickness", 0.5, 2.2, base_value=WAIST[1].width, unit="cm")
    recorder.scale(waist.body(hinge=3), 1.0, "u", size="waist_length")
    recorder.scale(waist.body(hinge=3), 1.0, "vz", size="waist_thickness")
    sections = bulb(
        ABDOMEN_LENGTH, ABDOMEN_WIDTH, ABDOMEN_HEIGHT, start=WAIST_OVERLAP + 0.08 - ABDOMEN_LENGTH, peak=0.9
    )
    abdomen = loft(recorder, "x", sections, anchors=[hub(waist, 0)])
    last = len(sections) - 1
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.55, 1.7), (0.55, 1.8), (0.5, 1.9)), hinge=last)
    recorder.parameter("abdomen_point", "Blunt or pointed end of the abdomen", 0.2, 1.6)
    recorder.scale(abdomen.sections(0, 1), 1.0, "vz", size="abdomen_point")
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 30.0, hinge=last, up=1.0)


def _head(recorder: Recorder, middle: Loft) -> Loft:
    """A bulb in front, widest behind; it nods about the neck."""
    sections = bulb(HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT, start=-0.10, count=5, peak=1.1)
    head = loft(recorder, "x", sections, anchors=[hub(middle, 5)])
    resize(recorder, head, "head", "Head", ((0.6, 1.6), (0.6, 1.7), (0.6, 1.8)), hinge=0)
    lift(recorder, head, "head_lift", "Head raised over the middle", 0.07)
    recorder.parameter("head_nod", "Head bent down (deg)", -0.8, 2.2, base_value=20.0, kind="angle")
    recorder.rotate(head.body(hinge=0), 20.0, "v", angle="head_nod")
    return head


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
