"""Models a mountain bicycle with suspension: a thick beam from the head, a mast, a swinging rear fork."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.bicycle.bicycle_assembly import NODES, TUBE, chassis, declare, equip
from shapewright.modeling import ProceduralModel, Recorder, when

PIVOT, KNEE = (0.44, 0.10), (0.52, 0.24)
"""Where the rear fork swings, and where the beam's upper tube meets the mast."""


def build() -> ProceduralModel:
    """Model the bicycle."""
    recorder = Recorder("bicycle_mountain", "bicycle", unit_m=1.0, description="A mountain bicycle with a beam frame.")
    declare(recorder)
    recorder.choice("frame", "Frame", ("beam and mast", "beam, mast and upper tube"))
    recorder.choice("shock", "Shock absorber", ("with", "without"))
    recorder.parameter("frame_height", "Height of the head tube", 0.3, 1.7, unit="m", base_value=0.13)
    recorder.parameter("seat_tube", "Height of the mast", -0.3, 2.0, unit="m", base_value=0.09)
    recorder.parameter("beam", "Beam thickness", 0.6, 1.8, unit="m", base_value=0.066)
    recorder.parameter("pivot", "Height of the rear pivot", 0.2, 2.0, unit="m", base_value=0.07)
    recorder.parameter("knee", "Height of the mast's foot", -1.0, 1.8, unit="m", base_value=0.08)
    frame = chassis(recorder, {**NODES, "pivot": PIVOT, "knee": KNEE}, (0.046, 0.036))
    tube = frame.skeleton.tube
    beams = [
        tube("knee", "high", (0.066, 0.050), from_end=(0.0, -0.05), sides=8),
        tube("bottom", "knee", (0.060, 0.066), sides=8),
    ]
    brace = tube("seat", "high", TUBE, from_end=(0.0, -0.02))
    shock = tube("knee", "rear", 0.040, from_start=(-0.02, 0.0), from_end=(0.26, 0.17))
    tubes = [
        tube("knee", "seat", TUBE * 1.2),
        tube("bottom", "pivot", TUBE * 1.3),
        brace,
    ]
    stays = [
        tube("pivot", "rear", (0.034, 0.026), spread=(0.026, 0.055)),
        tube("bottom", "rear", 0.022, spread=(0.024, 0.055)),
    ]
    recorder.part("upper tube", brace.components, present_when=(when("frame", 2),))
    recorder.part("shock absorber", shock.components, present_when=(when("shock", 1),))
    frame.skeleton.slide(("high", "stem", "clamp"), (-0.02, 0.13), "frame_height")
    frame.skeleton.slide(("seat", "post"), (-0.02, 0.09), "seat_tube")
    frame.skeleton.slide(("pivot",), (0.0, 0.07), "pivot")
    frame.skeleton.slide(("knee",), (-0.02, 0.08), "knee")
    recorder.scale([target for body in beams for target in body.sections(0, 1)], 1.0, "uvz", size="beam")
    equip(recorder, frame, tubes, stays, guarded=2)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
