"""Models a transport helicopter: a roomy hull with engines on its back, sponsons, wheels, a rotor of many blades."""

from pathlib import Path

from models_store.library.aids.beam import upper
from models_store.library.aids.loft import Section
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
    tailplane,
    whole,
)
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor, tail_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import ProceduralModel, Recorder, Target, when

HULL = Hull(
    sections=(
        Section(-8.6, 0.42, 0.55, (0.0, 0.80)),
        Section(-6.2, 0.70, 0.90, (0.0, 0.66)),
        Section(-3.8, 1.20, 1.40, (0.0, 0.46)),
        Section(-2.4, 2.00, 2.20, (0.0, 0.12)),
        Section(-0.6, 2.34, 2.50, (0.0, 0.00)),
        Section(1.6, 2.34, 2.50, (0.0, 0.00)),
        Section(3.2, 2.04, 2.10, (0.0, -0.12)),
        Section(4.4, 1.10, 1.10, (0.0, -0.36)),
    ),
    tail=2,
    nose=5,
    rise=0.4,
    drop=0.15,
)
ENGINE = (
    Section(-2.2, 0.60, 0.40),
    Section(-1.4, 1.40, 0.90),
    Section(1.2, 1.50, 1.00),
    Section(2.0, 0.90, 0.60),
)
SPONSONS = Pods(
    "sponson",
    "Sponson",
    (Section(-1.7, 0.30, 0.30), Section(-1.2, 0.85, 0.80), Section(1.0, 0.85, 0.80), Section(1.5, 0.40, 0.36)),
    offset=(-0.2, -0.1, 0.1),
)
ROTOR = Rotor((4, 6, 3, 5), ("disc", "none"), 15.0, 0.55, (0.55, 1.3))
MAST = Mast(0.8, 0.28, 0.4, (0.4, 2.0))
TAIL_ROTOR = Rotor((4, 2, 3), ("disc", "none"), 3.0, 0.26, (0.5, 1.5), "tail_rotor", "Tail rotor")
FIN = Fin(height=2.0, chord=1.1, sweep=0.9, forward=0.25)
TAILPLANE = Tailplane(span=1.7, chord=0.8, endplate=1.0)
GEAR = Gear(("nose wheel", "tail wheel", "none"), 0.7, 0.35, 0.45, wheel_diameter=0.75)


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder(
        "helicopter_transport", "helicopter", unit_m=1.0, description="A transport helicopter on wheels."
    )
    body = hull(recorder, HULL)
    hump = engine(recorder, ENGINE, upper(recorder, body, 4))
    recorder.switch("sponsons", "Sponsons at the sides")
    there = (when("sponsons", 1),)
    sides = pods(recorder, SPONSONS, flank(recorder, body, 4, height=-0.9), there)
    recorder.part("sponsons", whole(sides), present_when=there)
    upright = fin(recorder, FIN, body)
    tailplane(recorder, TAILPLANE, Target(body.rings[1][0], "world"), Target(upright.rings[2][0], "world"))
    apart = main_rotor(recorder, ROTOR, MAST, upper(recorder, hump, 1, 2))
    high = Target((*upright.rings[1][0], *upright.rings[2][0]), "world")
    apart += tail_rotor(recorder, TAIL_ROTOR, high, aside=0.3, moves=0.3)
    undercarriage(recorder, GEAR, body, 5, 3, nose=6, tail=1, lengthens=())
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
