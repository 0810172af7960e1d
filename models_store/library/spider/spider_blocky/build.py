"""Models a spider of few flat faces: box-like abdomen, forebody and head, eight straight legs."""

from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.spider.arthropod import LegShape, Station, components, flanks, hub, legs, lift, resize, tilt
from shapewright.modeling import ProceduralModel, Recorder, when

LEGS = LegShape(
    length=2.2, thickness=0.16, raise_deg=25.0, knee_deg=65.0, ankle_deg=14.0, inset=0.12, raise_range=(-0.6, 2.2)
)
HEADINGS_DEG = (48.0, 17.0, -15.0, -46.0)
FOREBODY = (
    Section(-0.55, 0.50, 0.44),
    Section(-0.28, 0.62, 0.52),
    Section(-0.08, 0.66, 0.54),
    Section(0.12, 0.64, 0.52),
    Section(0.32, 0.58, 0.46),
    Section(0.48, 0.46, 0.38),
)
ABDOMEN = (
    Section(-1.45, 0.55, 0.50),
    Section(-1.20, 1.00, 0.90),
    Section(-0.40, 0.95, 0.85),
    Section(0.10, 0.42, 0.40),
)
HEAD = (Section(-0.12, 0.40, 0.36), Section(0.16, 0.52, 0.46), Section(0.55, 0.30, 0.26))


def build() -> ProceduralModel:
    """Model the spider."""
    recorder = Recorder(
        "spider_blocky", "spider", unit_m=0.01, description="A spider of few flat faces, with eight legs."
    )
    forebody = beam(recorder, "+x", FOREBODY, crease="all")
    resize(recorder, forebody, "forebody", "Forebody", ((0.5, 2.0), (0.5, 1.7), (0.5, 1.7)), hinge=2)
    _abdomen(recorder, forebody)
    stations = [Station(flanks(recorder, forebody, 4 - i), heading) for i, heading in enumerate(HEADINGS_DEG)]
    pairs = legs(recorder, LEGS, stations)
    recorder.mark_sharp(
        *(face for pair in pairs for component in pair.components for face in recorder.faces_of(component))
    )
    _head(recorder, forebody)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _abdomen(recorder: Recorder, forebody: Loft) -> None:
    """A box with tapered ends that overlaps the rear of the forebody."""
    abdomen = beam(recorder, "+x", ABDOMEN, crease="all", anchors=[hub(forebody, 0)])
    last = len(ABDOMEN) - 1
    resize(recorder, abdomen, "abdomen", "Abdomen", ((0.4, 1.7), (0.5, 1.7), (0.35, 1.8)), hinge=last)
    recorder.parameter("abdomen_point", "Blunt or pointed end of the abdomen", 0.1, 1.8)
    recorder.scale(abdomen.sections(0), 1.0, "vz", size="abdomen_point")
    recorder.parameter("abdomen_front", "Width of the abdomen's front", 0.6, 1.2)
    recorder.scale(abdomen.sections(2), 1.0, "vz", size="abdomen_front")
    lift(recorder, abdomen, "abdomen_lift", "Abdomen lifted over the forebody", 0.14)
    tilt(recorder, abdomen, "abdomen_tilt", "Abdomen raised (deg)", 20.0, hinge=last, up=1.0)


def _head(recorder: Recorder, forebody: Loft) -> None:
    """A box in front, or none."""
    recorder.switch("head", "Head", ("no separate head", "separate head"))
    there = (when("head", 1),)
    head = beam(recorder, "+x", HEAD, crease="all", anchors=[hub(forebody, 5)])
    for what, axes, low, high in (("length", "u", 0.6, 2.0), ("size", "vz", 0.7, 1.5)):
        recorder.parameter(f"head_{what}", f"Head {what}", low, high, kind="length", active_when=there)
        recorder.scale(head.body(hinge=0), 1.0, axes, size=f"head_{what}")
    recorder.parameter("head_point", "Blunt or pointed front of the head", 0.3, 1.6, active_when=there)
    recorder.scale(head.sections(2), 1.0, "vz", size="head_point")
    recorder.parameter("head_nod", "Head bent down (deg)", -1.2, 2.0, base_value=14.0, active_when=there, kind="angle")
    recorder.rotate(head.body(hinge=0), 14.0, "v", angle="head_nod")
    recorder.part("head", components(head), present_when=there)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
