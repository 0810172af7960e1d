"""Models a cricket or grasshopper without wings: a long body, small legs in front, large hind legs with high knees."""

from pathlib import Path

from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft
from models_store.library.author import publish
from models_store.library.spider.arthropod import (
    Feelers,
    LegShape,
    Station,
    components,
    face,
    feelers,
    flanks,
    hub,
    legs,
    resize,
    tilt,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LEGS = LegShape(
    length=1.0, thickness=0.08, raise_deg=22.0, knee_deg=70.0, ankle_deg=8.0, inset=0.12, raise_range=(-0.8, 2.0)
)
HIND_LEGS = LegShape(
    length=2.1,
    thickness=0.13,
    raise_deg=48.0,
    knee_deg=105.0,
    ankle_deg=6.0,
    inset=0.12,
    raise_range=(0.3, 1.4),
    knee_range=(0.4, 1.35),
    spread_range=(0.1, 1.6),
    prefix="hind_",
    label="hind ",
)
HEADINGS_DEG, HIND_HEADING_DEG = (40.0, -5.0), -55.0
MIDDLE = (
    Section(-0.45, 0.40, 0.42),
    Section(-0.25, 0.52, 0.58),
    Section(0.02, 0.54, 0.62),
    Section(0.26, 0.48, 0.56),
    Section(0.44, 0.30, 0.36),
)
ABDOMEN = (
    Section(-1.70, 0.10, 0.10),
    Section(-1.50, 0.26, 0.28),
    Section(-0.95, 0.44, 0.46),
    Section(-0.35, 0.52, 0.56),
    Section(0.05, 0.44, 0.48),
    Section(0.16, 0.24, 0.26),
)
HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT = 0.46, 0.44, 0.56
ANTENNAE = Feelers("antenna", "Antenna", 1.1, 0.05, heading_deg=25.0, raise_deg=25.0, curve_deg=-30.0)
JAWS = Feelers("jaw", "Jaw", 0.20, 0.09, heading_deg=20.0, curve_deg=40.0, flatness=0.6)
BRISTLES = Feelers("bristle", "Tail bristle", 0.45, 0.07, heading_deg=158.0, spread_range=(0.85, 1.12))


def build() -> ProceduralModel:
    """Model the cricket."""
    recorder = Recorder(
        "spider_cricket", "spider", unit_m=0.01, description="A cricket: six legs, the hind ones large."
    )
    middle = loft(recorder, "x", MIDDLE)
    resize(recorder, middle, "middle", "Middle", ((0.6, 1.5), (0.6, 1.4), (0.6, 1.5)), hinge=2)
    abdomen = loft(recorder, "x", ABDOMEN, anchors=[hub(middle, 0)])
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.5, 1.6), (0.6, 1.6), (0.55, 1.6)), hinge=5)
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 12.0, hinge=5, up=1.2)
    head = _head(recorder, middle)
    stations = [Station(flanks(recorder, middle, 3 - i, down=0.5), heading) for i, heading in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations)
    legs(recorder, HIND_LEGS, [Station(flanks(recorder, middle, 1, down=0.3), HIND_HEADING_DEG)])
    face(recorder, head, (ANTENNAE, 3, (-0.10, -0.08, -0.04)), (JAWS, 4, (-0.10, -0.03, -0.02)))
    recorder.switch("bristles", "Tail bristles")
    there = (when("bristles", 1),)
    bristles = feelers(recorder, BRISTLES, flanks(recorder, abdomen, 1), offset=(0.06, -0.09, 0.0), active_when=there)
    recorder.part("tail bristles", components(bristles), present_when=there)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _head(recorder: Recorder, middle: Loft) -> Loft:
    """A high bulb before the middle, which nods."""
    sections = bulb(HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT, start=-0.10, count=5)
    head = loft(recorder, "x", sections, anchors=[hub(middle, 4)])
    resize(recorder, head, "head", "Head", ((0.6, 1.6), (0.6, 1.6), (0.6, 1.5)), hinge=0)
    recorder.parameter("head_nod", "Head bent down (deg)", -0.6, 2.2, base_value=22.0, kind="angle")
    recorder.rotate(head.body(hinge=0), 22.0, "v", angle="head_nod")
    return head


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
