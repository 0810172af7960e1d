"""Models a tandem helicopter: a long hull with a rotor on a pylon at either end, sponsons and four wheels."""

from pathlib import Path

from models_store.library.aids.beam import upper
from models_store.library.aids.loft import Loft, Section, loft, move
from models_store.library.author import publish
from models_store.library.helicopter.airframe import Pods, flank, pods, whole
from models_store.library.helicopter.rotors import Mast, Rotor, main_rotor
from models_store.library.helicopter.undercarriage import Gear, undercarriage
from shapewright.modeling import ProceduralModel, Recorder, Target, when

HULL = (
    Section(-7.4, 1.10, 0.90, (0.0, 0.45)),
    Section(-6.2, 2.20, 2.00, (0.0, 0.22)),
    Section(-3.0, 2.70, 2.70),
    Section(1.0, 2.70, 2.70),
    Section(4.6, 2.70, 2.70),
    Section(6.2, 2.20, 2.10, (0.0, -0.14)),
    Section(7.4, 1.00, 0.95, (0.0, -0.42)),
)
HULL_BEND = 0.5
FRONT_PYLON = (Section(-0.6, 2.40, 1.50), Section(0.3, 2.00, 1.10), Section(0.9, 1.00, 0.80))
REAR_PYLON = (
    Section(-0.9, 2.60, 1.30),
    Section(0.4, 2.40, 1.00),
    Section(1.5, 2.20, 0.80),
    Section(2.3, 1.30, 0.70),
)
REAR_PYLON_LEAN = 0.5
SPONSONS = Pods(
    "sponson",
    "Sponson",
    (Section(-4.2, 0.40, 0.60), Section(-3.6, 1.00, 1.20), Section(3.6, 1.00, 1.20), Section(4.2, 0.40, 0.60)),
    offset=(0.4, -0.1, -0.1),
    length_range=(0.4, 1.2),
)
ROTOR = Rotor((3, 4, 2), ("disc",), 16.0, 0.75, (0.6, 1.15))
MAST = Mast(0.7, 0.3, 0.5, (0.5, 1.8))
GEAR = Gear(("nose wheel", "tail wheel", "none"), 0.6, 0.3, 0.5, wheel_diameter=0.8, height_range=(0.4, 2.6))


def build() -> ProceduralModel:
    """Model the helicopter."""
    recorder = Recorder(
        "helicopter_tandem", "helicopter", unit_m=1.0, description="A helicopter with two rotors, fore and aft."
    )
    body = _hull(recorder)
    front = loft(recorder, "z", FRONT_PYLON, anchors=[upper(recorder, body, 4)])
    rear = loft(recorder, "z", REAR_PYLON, anchors=[upper(recorder, body, 1)])
    _pylons(recorder, front, rear)
    recorder.switch("sponsons", "Sponsons at the sides")
    there = (when("sponsons", 1),)
    sides = pods(recorder, SPONSONS, flank(recorder, body, 3, height=-0.9), there)
    recorder.part("sponsons", whole(sides), present_when=there)
    tops = (Target(pylon.rings[-1][0], "world") for pylon in (front, rear))
    apart = main_rotor(recorder, ROTOR, MAST, *tops)
    undercarriage(recorder, GEAR, body, 4, 2, nose=5, tail=1, lengthens=())
    recorder.symmetry(mirrors=("y",), apart=apart)
    return recorder.build()


def _hull(recorder: Recorder) -> Loft:
    """A long hull of which rear and nose can be raised or lowered."""
    body = loft(recorder, "x", HULL)
    for what, axis, low, high in (("length", "u", 0.7, 1.3), ("width", "v", 0.6, 1.35), ("height", "z", 0.6, 1.35)):
        recorder.parameter(f"cabin_{what}", f"Cabin {what}", low, high, kind="length")
        recorder.scale(body.body(hinge=3), 1.0, axis, size=f"cabin_{what}")
    recorder.parameter("nose_point", "Pointed or blunt nose", 0.5, 1.7)
    recorder.scale(body.sections(6), 1.0, "vz", size="nose_point")
    recorder.parameter("tail_point", "Pointed or blunt rear", 0.4, 1.6)
    recorder.scale(body.sections(0), 1.0, "vz", size="tail_point")
    recorder.parameter("hull_bend", "Both ends of the hull raised", -0.5, 2.4, base_value=HULL_BEND, unit="m")
    move(recorder, body.sections(0, 1, 5, 6), (0.0, 0.0, HULL_BEND), length="hull_bend")
    move(recorder, body.sections(0, 1, 5, 6), (0.0, 0.0, -HULL_BEND))
    return body


def _pylons(recorder: Recorder, front: Loft, rear: Loft) -> None:
    """What bears the rotors; the rear one is taller and leans backwards."""
    for pylon, name, label in ((front, "front_pylon", "Front pylon"), (rear, "rear_pylon", "Rear pylon")):
        recorder.parameter(
            f"{name}_height", f"{label} height", 0.4, 1.7, base_value=2.3 if pylon is rear else 0.9, unit="m"
        )
        recorder.scale(pylon.beyond(1, hinge=0), 1.0, "z", size=f"{name}_height")
        recorder.parameter(f"{name}_length", f"{label} length", 0.6, 1.4, kind="length")
        recorder.scale(pylon.body(hinge=0), 1.0, "u", size=f"{name}_length")
    recorder.parameter("pylon_width", "Pylon width", 0.5, 1.5, kind="length")
    recorder.scale([*front.body(hinge=0), *rear.body(hinge=0)], 1.0, "v", size="pylon_width")
    recorder.parameter(
        "rear_pylon_lean", "Rear pylon leaning backwards", -0.6, 2.0, base_value=REAR_PYLON_LEAN, unit="m"
    )
    for number in (1, 2, 3):
        by = (-REAR_PYLON_LEAN * number / 3, 0.0, 0.0)
        move(recorder, rear.sections(number), by, length="rear_pylon_lean")


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
