"""Models a light helicopter: a cabin that tapers into a tail boom, one rotor on an engine hump, skids or wheels."""

from pathlib import Path

from models_store.library.aids.beam import upper
from models_store.library.aids.loft import Section
from models_store.library.author import publish
from models_store.library.helicopter.airframe import Fin, Hull, Tailplane, engine, fin, hull, tailplane
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor, tail_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import ProceduralModel, Recorder, Target

HULL = Hull(
    sections=(
        Section(-6.2, 0.22, 0.28, (0.0, 0.42)),
        Section(-4.2, 0.34, 0.42, (0.0, 0.42)),
        Section(-2.4, 0.56, 0.70, (0.0, 0.38)),
        Section(-1.3, 1.36, 1.52, (0.0, 0.18)),
        Section(-0.3, 1.80, 1.96, (0.0, 0.00)),
        Section(0.9, 1.84, 1.96, (0.0, -0.02)),
        Section(1.8, 1.50, 1.40, (0.0, -0.18)),
        Section(2.5, 0.72, 0.62, (0.0, -0.30)),
    ),
    tail=2,
    nose=5,
    rise=0.3,
    drop=0.15,
    cabin_length=(0.65, 1.7),
    tail_length=(0.55, 1.25),
)
ENGINE = (
    Section(-1.3, 0.40, 0.30),
    Section(-0.9, 0.78, 0.70),
    Section(0.3, 0.84, 0.80),
    Section(0.8, 0.50, 0.40),
)
ROTOR = Rotor((4, 2, 3, 5), ("disc", "none"), 9.6, 0.38, (0.55, 1.35))
MAST = Mast(0.75, 0.14, 0.35, (0.4, 2.4))
TAIL_ROTOR = Rotor((4, 2, 3), ("disc", "none"), 1.5, 0.16, (0.5, 1.7), "tail_rotor", "Tail rotor")
FIN = Fin(height=1.1, chord=0.75, sweep=0.45, forward=0.15)
TAILPLANE = Tailplane(span=1.0, chord=0.5, endplate=0.7)
GEAR = Gear(("skids", "nose wheel", "tail wheel", "none"), 0.75, 0.35, 0.35)


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder(
        "helicopter", "helicopter", unit_m=1.0, description="A light helicopter with one rotor and a tail boom."
    )
    body = hull(recorder, HULL)
    hump = engine(recorder, ENGINE, upper(recorder, body, 4))
    upright = fin(recorder, FIN, body)
    tailplane(recorder, TAILPLANE, Target(body.rings[1][0], "world"), Target(upright.rings[2][0], "world"))
    apart = main_rotor(recorder, ROTOR, MAST, upper(recorder, hump, 1, 2))
    low = Target((*upright.rings[0][0], *upright.rings[1][0]), "world")
    apart += tail_rotor(recorder, TAIL_ROTOR, low, aside=0.2, moves=0.2)
    undercarriage(recorder, GEAR, body, 5, 3, nose=6, tail=1, lengthens=("cabin_length",))
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
