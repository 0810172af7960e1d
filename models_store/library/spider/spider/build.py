"""Models a spider: a small forebody with eight or ten legs, a bulb of an abdomen behind, feelers in front."""

from pathlib import Path

from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft, move
from models_store.library.author import publish
from models_store.library.spider.arthropod import (
    Feelers,
    LegShape,
    Station,
    components,
    feelers,
    flanks,
    hub,
    legs,
    resize,
    tilt,
)
from shapewright.modeling import ProceduralModel, Recorder, when

LEGS = LegShape(length=2.4, thickness=0.12, raise_deg=38.0, knee_deg=75.0, ankle_deg=20.0, inset=0.22)
HEADINGS_DEG = (58.0, 22.0, -16.0, -52.0)
THIRD_PAIR_TURN_DEG = 16.0
FOREBODY = (
    Section(-0.50, 0.30, 0.24),
    Section(-0.30, 0.66, 0.42),
    Section(-0.10, 0.80, 0.50),
    Section(0.12, 0.78, 0.50),
    Section(0.32, 0.60, 0.44),
    Section(0.52, 0.32, 0.28),
)
ABDOMEN_LENGTH, ABDOMEN_WIDTH, ABDOMEN_HEIGHT = 1.35, 1.1, 0.95
ABDOMEN_OVERLAP = 0.16
ABDOMEN_LIFT = 0.10
PALPS = Feelers("palp", "Feeler", 0.75, 0.10, heading_deg=30.0, raise_deg=20.0, curve_deg=50.0)
FANGS = Feelers("fang", "Jaw", 0.36, 0.16, heading_deg=10.0, raise_deg=-25.0, length_range=(0.6, 1.6))


def build() -> ProceduralModel:
    """Model the spider."""
    recorder = Recorder(
        "spider", "spider", unit_m=0.01, description="A spider with a bulb of an abdomen and jointed legs."
    )
    forebody = loft(recorder, "x", FOREBODY)
    resize(recorder, forebody, "forebody", "Forebody", ((0.5, 1.5), (0.5, 1.5), (0.5, 1.6)), hinge=2)
    _abdomen(recorder, forebody)
    stations = [Station(flanks(recorder, forebody, 4 - i), heading) for i, heading in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations, middle_turn_deg=THIRD_PAIR_TURN_DEG)
    recorder.switch("palps", "Feelers beside the head")
    palps = feelers(
        recorder, PALPS, flanks(recorder, forebody, 5), offset=(-0.15, -0.06, 0.0), active_when=(when("palps", 1),)
    )
    recorder.part("feelers", components(palps), present_when=(when("palps", 1),))
    recorder.switch("fangs", "Jaws")
    fangs = feelers(
        recorder, FANGS, flanks(recorder, forebody, 5), offset=(-0.15, -0.08, -0.04), active_when=(when("fangs", 1),)
    )
    recorder.part("jaws", components(fangs), present_when=(when("fangs", 1),))
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _abdomen(recorder: Recorder, forebody: Loft) -> None:
    """A bulb that hangs on the rear of the forebody by its front end."""
    sections = bulb(ABDOMEN_LENGTH, ABDOMEN_WIDTH, ABDOMEN_HEIGHT, start=ABDOMEN_OVERLAP - ABDOMEN_LENGTH)
    abdomen = loft(recorder, "x", sections, anchors=[hub(forebody, 0)])
    last = len(sections) - 1
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.5, 2.0), (0.45, 1.8), (0.45, 2.0)), hinge=last)
    recorder.parameter("abdomen_point", "Blunt or pointed end of the abdomen", 0.2, 1.8)
    recorder.scale(abdomen.sections(0, 1), 1.0, "vz", size="abdomen_point")
    recorder.parameter("abdomen_lift", "Abdomen lifted over the forebody", 0.0, 4.0, base_value=ABDOMEN_LIFT, unit="cm")
    lifted = abdomen.sections(*range(last))  # the front end stays in the forebody
    move(recorder, lifted, (0.0, 0.0, -ABDOMEN_LIFT))
    move(recorder, lifted, (0.0, 0.0, ABDOMEN_LIFT), length="abdomen_lift")
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 25.0, hinge=last, up=1.0)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
