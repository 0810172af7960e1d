"""Models a bicycle that one steps through: low tubes instead of the top tube, guards, carrier, perhaps a basket."""

from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.loft import Section
from models_store.library.author import publish
from models_store.library.bicycle.bicycle_assembly import NODES, TUBE, chassis, declare, equip
from shapewright.modeling import ProceduralModel, Recorder, Target, when

WAIST = (0.375, 0.165)
"""Where the upper of the low tubes meets the seat tube."""


def build() -> ProceduralModel:
    """Model the bicycle."""
    recorder = Recorder("bicycle_step_through", "bicycle", unit_m=1.0, description="A city bicycle without a top tube.")
    declare(recorder, ("with", "without"))
    recorder.choice("low_tubes", "Low tubes", ("two", "one"))
    recorder.choice("basket", "Basket", ("without", "with"))
    recorder.parameter("frame_height", "Height of the head tube", 0.3, 1.7, unit="m", base_value=0.13)
    recorder.parameter("seat_tube", "Height of the seat tube", -0.3, 2.0, unit="m", base_value=0.09)
    recorder.parameter(
        "waist",
        "Height of the upper tube at the seat",
        -0.2,
        2.2,
        unit="m",
        base_value=0.10,
        active_when=(when("low_tubes", 1),),
    )
    frame = chassis(recorder, {**NODES, "waist": WAIST}, (0.034, 0.024))
    tube = frame.skeleton.tube
    upper = tube("waist", "high", TUBE, from_end=(0.004, -0.03))
    tubes = [
        upper,
        tube("bottom", "waist", TUBE),
        tube("waist", "seat", TUBE),
        tube("bottom", "low", TUBE * 1.2, from_end=(-0.004, 0.03)),
    ]
    stays = [
        tube("bottom", "rear", 0.024, spread=(0.022, 0.052)),
        tube("seat", "rear", 0.022, spread=(0.018, 0.052), from_start=(0.0, -0.02)),
    ]
    recorder.part("upper low tube", upper.components, present_when=(when("low_tubes", 1),))
    frame.skeleton.slide(("high", "stem", "clamp"), (-0.02, 0.13), "frame_height")
    frame.skeleton.slide(("seat", "post"), (-0.02, 0.09), "seat_tube")
    frame.skeleton.slide(("waist",), (-0.022, 0.10), "waist")
    equip(recorder, frame, tubes, stays, guarded=1)
    _basket(recorder, Target(frame.reach.rings[1][0], "world"))
    return recorder.build()


def _basket(recorder: Recorder, clamp: Target) -> None:
    """A bucket of thin walls before the handlebars."""
    sections = [Section(-0.02, 0.34, 0.40), Section(0.20, 0.26, 0.32)]
    bucket = beam(recorder, "-z", sections, crease="all", offset=(0.18, 0.0, 0.06), anchors=clamp)
    opening = bucket.component.top
    recorder.extrude(opening, 0.0)
    recorder.scale(opening, 0.92, "uv")
    recorder.extrude(opening, -0.20)
    recorder.scale(opening, 0.78, "uv")
    recorder.mark_sharp(*recorder.faces_of(bucket.component))
    recorder.part("basket", bucket.components, present_when=(when("basket", 2),))


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
