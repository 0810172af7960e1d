"""Models a helicopter of few flat faces: a box for a cabin, a tapered boom, a disc or a plate for a rotor, floats."""

from pathlib import Path

from models_store.library.aids.beam import upper
from models_store.library.aids.loft import Section
from models_store.library.author import publish
from models_store.library.helicopter.airframe import Fin, Hull, Tailplane, fin, hull, tailplane
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor, tail_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import ProceduralModel, Recorder, Target

HULL = Hull(
    sections=(
        Section(-4.2, 0.16, 0.34, (0.0, 0.40)),
        Section(-3.0, 0.28, 0.50, (0.0, 0.36)),
        Section(-1.7, 0.60, 0.90, (0.0, 0.28)),
        Section(-1.2, 1.50, 1.50),
        Section(0.1, 1.60, 1.60),
        Section(1.2, 1.50, 1.50),
        Section(2.2, 0.95, 0.70, (0.0, -0.25)),
    ),
    tail=2,
    nose=5,
    rise=0.4,
    drop=0.2,
    cabin_length=(0.5, 1.6),
    cabin_width=(0.4, 1.5),
    cabin_height=(0.5, 1.5),
    tail_length=(0.5, 1.6),
    sharp=True,
)
ROTOR = Rotor((4, 2), ("disc", "plate", "none"), 6.5, 0.36, (0.5, 1.6))
MAST = Mast(0.45, 0.16, 0.3, (0.4, 2.4))
TAIL_ROTOR = Rotor((4, 2), ("disc", "plate", "none"), 1.5, 0.18, (0.6, 1.6), "tail_rotor", "Tail rotor")
FIN = Fin(height=0.8, chord=0.6, sweep=0.3, forward=0.10)
TAILPLANE = Tailplane(span=0.9, chord=0.5, endplate=0.6)
GEAR = Gear(("skids", "nose wheel", "tail wheel", "none"), 0.55, 0.2, 0.3, 2.8, 0.2, 0.45, 0.2)


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder("helicopter_blocky", "helicopter", unit_m=1.0, description="A helicopter of few flat faces.")
    body = hull(recorder, HULL)
    upright = fin(recorder, FIN, body)
    tailplane(recorder, TAILPLANE, Target(body.rings[1][0], "world"), Target(upright.rings[2][0], "world"))
    apart = main_rotor(recorder, ROTOR, MAST, upper(recorder, body, 4))
    low = Target((*upright.rings[0][0], *upright.rings[1][0]), "world")
    apart += tail_rotor(recorder, TAIL_ROTOR, low, aside=0.16, moves=0.12)
    undercarriage(recorder, GEAR, body, 5, 3, nose=5, tail=1, lengthens=("cabin_length",))
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
