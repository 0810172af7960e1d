"""Models an attack helicopter: a slim hull, engines at its shoulders, stub wings with pods, a gun under the nose."""

from pathlib import Path

from models_store.library.aids.beam import lower, upper
from models_store.library.aids.loft import Loft, Section, loft
from models_store.library.author import publish
from models_store.library.helicopter.airframe import (
    Fin,
    Hull,
    Pods,
    Tailplane,
    engine,
    fin,
    flank,
    hull,
    pods,
    stub_wings,
    tailplane,
    whole,
)
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor, tail_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

HULL = Hull(
    sections=(
        Section(-8.0, 0.34, 0.46, (0.0, 0.38)),
        Section(-5.6, 0.52, 0.70, (0.0, 0.28)),
        Section(-3.2, 0.74, 1.06, (0.0, 0.18)),
        Section(-1.9, 1.10, 1.62, (0.0, 0.06)),
        Section(-0.6, 1.22, 1.90, (0.0, 0.04)),
        Section(0.9, 1.14, 1.90, (0.0, 0.06)),
        Section(2.4, 1.04, 1.60, (0.0, -0.06)),
        Section(3.8, 0.86, 0.98, (0.0, -0.24)),
        Section(4.9, 0.50, 0.52, (0.0, -0.30)),
    ),
    tail=2,
    nose=6,
    rise=0.3,
    drop=0.2,
)
HUMP = (
    Section(-2.0, 0.30, 0.26),
    Section(-1.3, 0.62, 0.60),
    Section(0.4, 0.70, 0.66),
    Section(1.1, 0.40, 0.36),
)
CANOPY = (
    Section(-1.6, 0.30, 0.24),
    Section(-0.9, 0.72, 0.80),
    Section(0.3, 0.76, 0.84),
    Section(1.2, 0.50, 0.40),
)
CANOPY_PLACE = 6  # the section of the hull that bears it
ENGINES = Pods(
    "side_engine",
    "Side engine",
    (Section(-1.3, 0.42, 0.42), Section(-0.8, 0.66, 0.64), Section(0.5, 0.70, 0.68), Section(0.9, 0.46, 0.46)),
)
ROTOR = Rotor((4, 2, 3, 5), ("disc", "none"), 13.0, 0.55, (0.55, 1.3))
MAST = Mast(0.75, 0.22, 0.35, (0.4, 2.0))
TAIL_ROTOR = Rotor((4, 2, 3), ("disc", "none"), 2.6, 0.24, (0.5, 1.5), "tail_rotor", "Tail rotor")
FIN = Fin(height=1.7, chord=1.0, sweep=0.8, forward=0.25)
TAILPLANE = Tailplane(span=1.5, chord=0.7, endplate=0.9)
GEAR = Gear(("tail wheel", "nose wheel", "skids", "none"), 0.85, 0.45, 0.4, 3.2, 0.12, 0.62, 0.5)
WING_SPAN, WING_CHORD, WING_DROOP_DEG, WING_SUNK = 1.9, 0.95, 8.0, 0.35
POD = (Section(-0.9, 0.18, 0.18), Section(-0.7, 0.34, 0.34), Section(0.6, 0.34, 0.34), Section(0.95, 0.14, 0.14))
POD_BELOW = 0.14
GUN = (Section(-0.3, 0.16, 0.16), Section(1.3, 0.12, 0.12))


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder(
        "helicopter_attack", "helicopter", unit_m=1.0, description="A slim attack helicopter with stub wings."
    )
    body = hull(recorder, HULL)
    hump = engine(recorder, HUMP, upper(recorder, body, 4))
    _canopy(recorder, body)
    _side_engines(recorder, body)
    _wings(recorder, body)
    _gun(recorder, body)
    upright = fin(recorder, FIN, body)
    tailplane(recorder, TAILPLANE, Target(body.rings[1][0], "world"), Target(upright.rings[2][0], "world"))
    apart = main_rotor(recorder, ROTOR, MAST, upper(recorder, hump, 1, 2))
    high = Target((*upright.rings[1][0], *upright.rings[2][0]), "world")
    apart += tail_rotor(recorder, TAIL_ROTOR, high, aside=0.28, moves=0.25)
    undercarriage(recorder, GEAR, body, 5, 3, nose=7, tail=1, lengthens=("cabin_length",))
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


def _canopy(recorder: Recorder, body: Loft) -> None:
    """A hump over both seats before the engines, or none."""
    recorder.switch("canopy", "Canopy")
    there = (when("canopy", 1),)
    canopy = loft(recorder, "x", CANOPY, anchors=[upper(recorder, body, CANOPY_PLACE)])
    for what, axis, low, high in (("length", "u", 0.6, 1.4), ("height", "z", 0.4, 1.7)):
        recorder.parameter(f"canopy_{what}", f"Canopy {what}", low, high, kind="length", active_when=there)
        recorder.scale(canopy.body(), 1.0, axis, size=f"canopy_{what}")
    recorder.part("canopy", whole(canopy), present_when=there)


def _side_engines(recorder: Recorder, body: Loft) -> None:
    """Two nacelles at the shoulders, or none."""
    recorder.switch("side_engines", "Engines at the sides")
    there = (when("side_engines", 1),)
    nacelles = pods(recorder, ENGINES, flank(recorder, body, 4, height=1.0), there)
    recorder.part("side engines", whole(nacelles), present_when=there)


def _wings(recorder: Recorder, body: Loft) -> None:
    """Stub wings, with pods under their middles and at their tips."""
    recorder.choice("weapons", "Stub wings", ("with two pods a side", "with one pod a side", "bare", "none"))
    winged, armed = (when("weapons", 1, 3),), (when("weapons", 1, 2),)
    recorder.parameter("wing_span", "Stub wing span", 0.5, 1.6, base_value=WING_SPAN, active_when=winged, unit="m")
    recorder.parameter("wing_chord", "Stub wing chord", 0.6, 1.6, base_value=WING_CHORD, active_when=winged, unit="m")
    recorder.parameter(
        "wing_droop", "Stub wing droop (deg)", -0.8, 2.4, base_value=WING_DROOP_DEG, active_when=winged, kind="angle"
    )
    wings = stub_wings(recorder, flank(recorder, body, 4), WING_SPAN, WING_CHORD, WING_DROOP_DEG, WING_SUNK)
    recorder.part("stub wings", whole(wings), present_when=winged)
    recorder.parameter("pod_length", "Pod length", 0.5, 1.6, active_when=armed, kind="length")
    recorder.parameter("pod_size", "Pod thickness", 0.5, 1.7, active_when=armed, kind="length")
    for station, there in ((2, armed), (1, (when("weapons", 1),))):
        anchors = [Target(wings.rings[station][0], "world"), Target(wings.rings[station][1], "world", (Mirror("y"),))]
        made = loft(recorder, "x", POD, sides=6, offset=(0.1, 0.0, -POD_BELOW), anchors=anchors)
        recorder.scale(made.body(), 1.0, "u", size="pod_length")
        recorder.scale(made.body(), 1.0, "vz", size="pod_size")
        recorder.part("pods at the tips" if station == 2 else "inner pods", whole(made), present_when=there)


def _gun(recorder: Recorder, body: Loft) -> None:
    """A barrel under the nose, or none."""
    recorder.switch("gun", "Gun under the nose")
    there = (when("gun", 1),)
    gun = loft(recorder, "x", GUN, sides=6, anchors=[lower(recorder, body, 7)])
    recorder.parameter("gun_length", "Gun length", 0.6, 1.8, base_value=GUN[1].at, active_when=there, unit="m")
    recorder.scale(gun.body(hinge=0), 1.0, "u", size="gun_length")
    recorder.part("gun", whole(gun), present_when=there)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
