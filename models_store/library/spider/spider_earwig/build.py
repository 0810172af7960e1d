"""Models a long flat insect (earwig, rove beetle, cockroach): long abdomen, short middle, six legs, tail bristles."""

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
    lift,
    resize,
    tilt,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LEGS = LegShape(
    length=1.0, thickness=0.08, raise_deg=28.0, knee_deg=62.0, ankle_deg=8.0, inset=0.12, raise_range=(-0.4, 2.0)
)
HEADINGS_DEG = (34.0, 2.0, -30.0)
MIDDLE = (
    Section(-0.42, 0.40, 0.24),
    Section(-0.26, 0.50, 0.32),
    Section(-0.02, 0.46, 0.32),
    Section(0.22, 0.50, 0.32),
    Section(0.42, 0.32, 0.22),
)
ABDOMEN = (
    Section(-1.85, 0.14, 0.08),
    Section(-1.70, 0.36, 0.20),
    Section(-1.35, 0.58, 0.32),
    Section(-0.80, 0.66, 0.38),
    Section(-0.25, 0.62, 0.38),
    Section(0.02, 0.46, 0.30),
    Section(0.12, 0.30, 0.20),
)
HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT = 0.48, 0.40, 0.28
ANTENNAE = Feelers("antenna", "Antenna", 0.75, 0.05, heading_deg=30.0, raise_deg=12.0, curve_deg=-30.0)
JAWS = Feelers("jaw", "Jaw", 0.22, 0.09, heading_deg=20.0, curve_deg=50.0, flatness=0.6)
BRISTLES = Feelers(
    "bristle", "Tail bristle", 0.50, 0.09, heading_deg=155.0, curve_deg=-60.0, flatness=0.7, spread_range=(0.85, 1.15)
)


def build() -> ProceduralModel:
    """Model the insect."""
    recorder = Recorder(
        "spider_earwig", "spider", unit_m=0.01, description="A long flat insect with six legs and tail bristles."
    )
    middle = loft(recorder, "x", MIDDLE)
    resize(recorder, middle, "middle", "Middle", ((0.6, 1.5), (0.6, 1.3), (0.6, 1.6)), hinge=2)
    abdomen = loft(recorder, "x", ABDOMEN, anchors=[hub(middle, 0)])
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.5, 1.6), (0.55, 1.6), (0.45, 1.8)), hinge=6)
    recorder.parameter("abdomen_point", "Blunt or pointed end of the abdomen", 0.4, 1.7)
    recorder.scale(abdomen.sections(0, 1), 1.0, "vz", size="abdomen_point")
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 9.0, hinge=6, up=1.4)
    head = _head(recorder, middle)
    stations = [Station(flanks(recorder, middle, 3 - i, down=0.4), heading) for i, heading in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations)
    face(recorder, head, (ANTENNAE, 3, (-0.10, -0.08, -0.03)), (JAWS, 4, (-0.10, -0.03, 0.0)))
    recorder.switch("bristles", "Tail bristles")
    there = (when("bristles", 1),)
    bristles = feelers(recorder, BRISTLES, flanks(recorder, abdomen, 1), offset=(0.08, -0.12, 0.0), active_when=there)
    recorder.part("tail bristles", components(bristles), present_when=there)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _head(recorder: Recorder, middle: Loft) -> Loft:
    """A bulb before the middle."""
    sections = bulb(HEAD_LENGTH, HEAD_WIDTH, HEAD_HEIGHT, start=-0.10, count=5)
    head = loft(recorder, "x", sections, anchors=[hub(middle, 4)])
    resize(recorder, head, "head", "Head", ((0.6, 1.6), (0.6, 1.6), (0.6, 1.6)), hinge=0)
    lift(recorder, head, "head_lift", "Head higher or lower", 0.05)
    return head


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
