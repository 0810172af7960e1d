"""Models an insect whose body shows its rings (termite, bug, larva with legs): grooves along abdomen and middle."""

from collections.abc import Sequence
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
from shapewright.modeling import Element, ProceduralModel, Recorder, Target

LEGS = LegShape(
    length=1.1, thickness=0.12, raise_deg=25.0, knee_deg=70.0, ankle_deg=12.0, inset=0.18, raise_range=(-0.4, 2.0)
)
HEADINGS_DEG = (36.0, 0.0, -36.0)
ABDOMEN_LENGTH, ABDOMEN_WIDTH, ABDOMEN_HEIGHT, ABDOMEN_RINGS = 1.5, 0.92, 0.70, 6
MIDDLE_LENGTH, MIDDLE_WIDTH, MIDDLE_HEIGHT, MIDDLE_RINGS = 0.85, 0.66, 0.52, 3
OVERLAP = 0.12
GROOVE = 0.80  # width of the body between two rings, as a share of what it would be there
HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT = 0.62, 0.62, 0.50
ANTENNAE = Feelers("antenna", "Antenna", 0.70, 0.06, heading_deg=40.0, raise_deg=-20.0, curve_deg=35.0)
JAWS = Feelers("jaw", "Jaw", 0.32, 0.13, heading_deg=22.0, curve_deg=50.0, flatness=0.6)


def build() -> ProceduralModel:
    """Model the insect."""
    recorder = Recorder(
        "spider_segmented", "spider", unit_m=0.01, description="An insect with a ringed body and six legs."
    )
    recorder.parameter("grooves", "Width of the body in its grooves", 0.85, 1.2)
    middle = _ringed(recorder, MIDDLE_LENGTH, MIDDLE_WIDTH, MIDDLE_HEIGHT, MIDDLE_RINGS, -MIDDLE_LENGTH / 2, ())
    resize(recorder, middle, "middle", "Middle", ((0.6, 1.6), (0.65, 1.6), (0.6, 1.7)), hinge=3)
    abdomen = _ringed(
        recorder,
        ABDOMEN_LENGTH,
        ABDOMEN_WIDTH,
        ABDOMEN_HEIGHT,
        ABDOMEN_RINGS,
        OVERLAP - ABDOMEN_LENGTH,
        (hub(middle, 0),),
    )
    last = len(abdomen.rings) - 1
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.5, 1.6), (0.6, 1.5), (0.5, 1.7)), hinge=last)
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 14.0, hinge=last, up=1.2)
    head = _head(recorder, middle)
    stations = [Station(flanks(recorder, middle, 5 - 2 * i, down=0.4), h) for i, h in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations)
    face(recorder, head, (ANTENNAE, 3, (-0.10, -0.10, -0.04)), (JAWS, 4, (-0.10, -0.05, 0.0)))
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _ringed(
    recorder: Recorder,
    length: float,
    width: float,
    height: float,
    rings: int,
    start: float,
    anchors: Sequence[Target],
) -> Loft:
    """A bulb with a full section in every ring (odd numbers) and a groove between two of them."""
    plain = bulb(length, width, height, start=start, count=2 * rings + 1)
    grooves = range(2, 2 * rings, 2)
    sections = [
        Section(s.at, s.width * GROOVE, s.height * GROOVE) if number in grooves else s for number, s in enumerate(plain)
    ]
    body = loft(recorder, "x", sections, anchors=anchors)
    recorder.scale(body.sections(*grooves), 1.0, "vz", size="grooves")
    for number in grooves:
        loop = body.rings[number][0]
        pairs = zip(loop, (*loop[1:], loop[0]), strict=True)
        recorder.mark_sharp(*(Element("edge", recorder.mesh.edge_between(a.id, b.id)) for a, b in pairs))
    return body


def _head(recorder: Recorder, middle: Loft) -> Loft:
    """A bulb before the middle, which nods."""
    sections = bulb(HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT, start=-OVERLAP, count=5, peak=1.15)
    head = loft(recorder, "x", sections, anchors=[hub(middle, 2 * MIDDLE_RINGS)])
    resize(recorder, head, "head", "Head", ((0.6, 1.7), (0.6, 1.6), (0.6, 1.7)), hinge=0)
    lift(recorder, head, "head_lift", "Head higher or lower", 0.08)
    recorder.parameter("head_nod", "Head bent down (deg)", -0.8, 2.0, base_value=16.0, kind="angle")
    recorder.rotate(head.body(hinge=0), 16.0, "v", angle="head_nod")
    return head


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
