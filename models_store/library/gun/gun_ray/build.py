"""Models a ray gun, as toys and comics have it: a swollen body, rings around a thin barrel, a nose.

The body begins at x = 0 and swells in its middle; the grip hangs under its rear.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import components, trigger, trigger_guard, tube, whole
from shapewright.modeling import ProceduralModel, Recorder, Target, when

BODY_LENGTH, BODY_DIAMETER = 0.20, 0.085
BARREL_LENGTH, BARREL_DIAMETER = 0.10, 0.024
RING_DIAMETER, NOSE_DIAMETER = 0.055, 0.060
GRIP_LENGTH, GRIP_DEPTH, GRIP_RAKE_DEG = 0.15, 0.048, 10.0
RING_PLACES = (0.25, 0.5, 0.75)


def build() -> ProceduralModel:
    """Model the ray gun."""
    recorder = Recorder("gun_ray", "gun", unit_m=1.0, description="A ray gun of toys and comics.")
    _declare(recorder)
    body = _body(recorder)
    barrel, *on_barrel = _barrel(recorder, body)
    grip = _grip(recorder, body)
    below = lower(recorder, body, 2)
    guard = trigger_guard(recorder, below, 0.070, 0.056)
    lever = trigger(recorder, below, 0.034)
    fin = beam(
        recorder,
        "+z",
        [
            Section(-0.012, 0.09, 0.008),
            Section(0.015, 0.07, 0.006, (-0.01, 0.0)),
            Section(0.045, 0.02, 0.004, (-0.04, 0.0)),
        ],
        anchors=upper(recorder, body, 2),
    )
    recorder.scale(fin.body(hinge=0), 1.0, "z", size="fin_height")
    recorder.part("fin", components(fin), present_when=(when("fin", 2),))
    recorder.part("trigger guard", components(guard), present_when=(when("guard", 1),))
    recorder.scale(whole(body, barrel, *on_barrel, grip, guard, lever, fin), 1.0, "v", size="thickness")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    recorder.choice("nose", "Nose", ("cone", "ball", "funnel"))
    recorder.choice("rings", "Rings around the barrel", ("three", "without"))
    recorder.choice("fin", "Fin", ("without", "with"))
    recorder.choice("guard", "Trigger guard", ("with", "without"))
    recorder.parameter("body_length", "Body length", 0.65, 1.5, unit="m", base_value=BODY_LENGTH)
    recorder.parameter("body_diameter", "Body diameter", 0.7, 1.3, unit="m", base_value=BODY_DIAMETER)
    recorder.parameter("body_rear", "Diameter of the body's rear (share)", 0.75, 1.5, base_value=1.0)
    recorder.parameter("body_tilt", "Tilt of the body's rear (deg)", -1.0, 2.5, base_value=12.0, kind="angle")
    recorder.parameter("barrel_length", "Barrel length", 0.5, 1.8, unit="m", base_value=BARREL_LENGTH)
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.6, 1.6, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter(
        "ring_diameter", "Ring diameter", 0.7, 1.5, unit="m", base_value=RING_DIAMETER, active_when=(when("rings", 1),)
    )
    recorder.parameter("nose_diameter", "Nose diameter", 0.5, 1.5, unit="m", base_value=NOSE_DIAMETER)
    recorder.parameter("nose_length", "Nose length", 0.5, 1.6, kind="length")
    recorder.parameter("grip_length", "Grip length", 0.65, 1.3, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_depth", "Grip depth", 0.7, 1.3, unit="m", base_value=GRIP_DEPTH)
    recorder.parameter("grip_rake", "Grip rake (deg)", -1.0, 2.5, base_value=GRIP_RAKE_DEG, kind="angle")
    recorder.parameter("grip_waves", "Depth of the finger grooves", 0.0, 2.0, unit="m", base_value=0.006)
    recorder.parameter(
        "guard_length", "Trigger guard length", 0.75, 1.3, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter(
        "guard_height", "Trigger guard height", 0.75, 1.3, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter("fin_height", "Fin height", 0.5, 1.6, unit="m", base_value=0.045, active_when=(when("fin", 2),))
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.2, kind="length")


def _body(recorder: Recorder) -> Loft:
    profile = [(0.0, 0.45), (0.18, 0.75), (0.45, 1.0), (0.7, 1.05), (0.9, 0.75), (1.0, 0.4)]
    body = beam(
        recorder,
        "+x",
        [Section(p * BODY_LENGTH, 0.9 * d * BODY_DIAMETER * 1.1, d * BODY_DIAMETER * 1.1) for p, d in profile],
        sides=8,
    )
    recorder.mark_sharp(body.component.bottom, body.component.top, sharp=False)
    recorder.scale(body.body(), 1.0, "u", size="body_length")
    recorder.scale(body.body(), 1.0, "vz", size="body_diameter")
    recorder.scale(body.sections(0, 1), 1.0, "vz", size="body_rear")
    rear = Target((*body.rings[0][0], *body.rings[1][0]), "world", (), body.rings[2][0])
    recorder.rotate(rear, 12.0, "v", angle="body_tilt")
    return body


def _barrel(recorder: Recorder, body: Loft) -> list[Loft]:
    front = at(recorder, body, 5)
    barrel = tube(recorder, front, [(-0.03, BARREL_DIAMETER), (BARREL_LENGTH + 0.01, BARREL_DIAMETER)])
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    rings = []
    for place in RING_PLACES:
        middle = place * BARREL_LENGTH
        ring = tube(recorder, front, [(middle - 0.005, RING_DIAMETER), (middle + 0.005, RING_DIAMETER)])
        recorder.scale(ring.body(), 1.0, "vz", size="ring_diameter")
        rings.append(ring)
    drawn = Target(whole(barrel, *rings).elements, "world", (), front.elements)
    recorder.scale(drawn, 1.0, "u", size="barrel_length")
    tip = at(recorder, barrel, 1)
    wide = NOSE_DIAMETER
    shapes = {
        "cone": [(-0.015, wide), (0.015, wide), (0.055, 0.12 * wide)],
        "ball": [(-0.015, 0.4 * wide), (0.0, 0.95 * wide), (0.02, 0.95 * wide), (0.035, 0.4 * wide)],
        "funnel": [(-0.015, 0.5 * wide), (0.01, 0.55 * wide), (0.05, 1.2 * wide)],
    }
    noses = []
    for number, (name, profile) in enumerate(shapes.items(), start=1):
        nose = tube(recorder, tip, profile, bore=0.8 if name == "funnel" else 0.0)
        recorder.scale(nose.body(hinge=0), 1.0, "u", size="nose_length")
        recorder.scale(nose.body(), 1.0, "vz", size="nose_diameter")
        recorder.part(name, components(nose), present_when=(when("nose", number),))
        noses.append(nose)
    recorder.part("rings", components(*rings), present_when=(when("rings", 1),))
    return [barrel, *rings, *noses]


def _grip(recorder: Recorder, body: Loft) -> Loft:
    shares = ((-0.06, 1.0), (0.1, 1.0), (0.28, 0.95), (0.46, 0.95), (0.64, 0.95), (0.82, 1.0), (1.0, 0.8))
    sections = [Section(place * GRIP_LENGTH, GRIP_DEPTH * share * 1.1, 0.036 * share) for place, share in shares]
    grip = beam(recorder, "-z", sections, sides=8, offset=(0.01, 0.0, 0.010), anchors=lower(recorder, body, 1))
    recorder.scale(grip.body(hinge=1), 1.0, "z", size="grip_length")
    recorder.scale(grip.body(), 1.0, "u", size="grip_depth")
    for number in (2, 4):
        recorder.drag(grip.sections(number), rho=0.006, phi_deg=180.0, length="grip_waves")
    recorder.rotate(grip.body(hinge=0), GRIP_RAKE_DEG, "v", angle="grip_rake")
    return grip


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
