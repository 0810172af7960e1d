"""Models a bicycle with a diamond frame: touring, racing or mountain bicycle by its handlebars and tyres."""

from pathlib import Path

from models_store.library.author import publish
from models_store.library.bicycle.bicycle_assembly import NODES, TUBE, chassis, declare, equip
from shapewright.modeling import ProceduralModel, Recorder


def build() -> ProceduralModel:
    """Model the bicycle."""
    recorder = Recorder("bicycle", "bicycle", unit_m=1.0, description="A bicycle with a diamond frame.")
    declare(recorder)
    recorder.parameter("frame_height", "Height of the top tube", 0.35, 2.3, unit="m", base_value=0.13)
    recorder.parameter("top_tube_slope", "Slope of the top tube", 0.0, 2.8)
    recorder.parameter("down_tube", "Thickness of the down tube (relative to the others)", 0.7, 2.2)
    frame = chassis(recorder, NODES, (0.034, 0.024))
    tube = frame.skeleton.tube
    down_tube = tube("bottom", "low", TUBE * 1.15, from_end=(-0.004, 0.03))
    tubes = [
        down_tube,
        tube("bottom", "seat", TUBE),
        tube("seat", "high", TUBE, from_end=(0.004, -0.03)),
    ]
    stays = [
        tube("bottom", "rear", 0.024, spread=(0.022, 0.052)),
        tube("seat", "rear", 0.022, spread=(0.018, 0.052), from_start=(0.0, -0.02)),
    ]
    frame.skeleton.slide(("seat", "post", "high", "stem", "clamp"), (0.0, 0.13), "frame_height")
    frame.skeleton.slide(("seat",), (0.02, -0.07), "top_tube_slope")
    recorder.scale(down_tube.sections(0, 1), 1.0, "uvz", size="down_tube")
    equip(recorder, frame, tubes, stays, guarded=2)
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
