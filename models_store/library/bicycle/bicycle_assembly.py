"""What all models of bicycles have in common: axles, steering, the slides of their nodes, and what is put on the frame.

The rear axle is the origin. Tubes are laid between nodes first, then the nodes get their parameters; wheels, saddle,
cranks and handlebars are put on after that and follow.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from models_store.library.aids.loft import Loft
from models_store.library.bicycle.bicycle_parts import (
    carrier,
    cranks,
    declare_cranks,
    declare_handlebars,
    declare_saddle,
    declare_transmission,
    declare_wheels,
    handlebars,
    mudguards,
    saddle,
    size_wheels,
    transmission,
    wheels,
)
from models_store.library.bicycle.bicycle_skeleton import Point, Skeleton
from shapewright.modeling import Recorder, Target

NODES: dict[str, Point] = {
    "rear": (0.0, 0.0),
    "front": (1.02, 0.0),
    "bottom": (0.43, -0.055),
    "seat": (0.305, 0.45),
    "post": (0.265, 0.60),
    "low": (0.885, 0.375),
    "high": (0.850, 0.50),
    "stem": (0.830, 0.575),
    "clamp": (0.900, 0.595),
}
TUBE = 0.036


@dataclass(frozen=True)
class Chassis:
    """The axles and the steering of a bicycle, and the post that bears its saddle."""

    skeleton: Skeleton
    hubs: tuple[Loft, Loft]
    bottom: Loft
    post: Loft
    fork: Loft
    tubes: tuple[Loft, ...]
    reach: Loft


def chassis(recorder: Recorder, nodes: dict[str, Point], fork: tuple[float, float]) -> Chassis:
    """Lay axles, head tube, fork, stem and seat post; ``fork`` is its diameters above and below."""
    skeleton = Skeleton(recorder, nodes)
    hubs = (skeleton.axle("rear", 0.05, 0.12), skeleton.axle("front", 0.04, 0.10))
    bottom = skeleton.axle("bottom", 0.05, 0.07)
    skeleton.axle("low", 0.045, 0.12)
    post = skeleton.tube("seat", "post", 0.030)
    reach = skeleton.tube("stem", "clamp", 0.032)
    legs = skeleton.tube("low", "front", fork, spread=(0.046, 0.050), from_start=(0.0, -0.01))
    tubes = (
        skeleton.tube("low", "high", TUBE * 1.25, from_start=(0.004, -0.02), from_end=(-0.002, 0.01)),
        skeleton.tube("high", "stem", 0.032),
        post,
        reach,
    )
    return Chassis(skeleton, hubs, bottom, post, legs, tubes, reach)


def declare(recorder: Recorder, guards: tuple[str, str] = ("without", "with")) -> None:
    """Declare what the common parts vary; ``guards`` orders the options for mudguards and carrier."""
    declare_wheels(recorder)
    recorder.choice("mudguards", "Mudguards", guards)
    recorder.choice("carrier", "Carrier", guards)
    declare_transmission(recorder)
    recorder.parameter("wheelbase", "Length between frame and front axle", 0.4, 1.7, unit="m", base_value=0.2)
    recorder.parameter("fork_length", "Length of the fork", -0.6, 2.0, unit="m", base_value=0.05)
    recorder.parameter("fork_rake", "Fork rake", -0.8, 2.5, unit="m", base_value=0.045)
    recorder.parameter("bottom_place", "Place of the bottom bracket", -0.8, 2.8, unit="m", base_value=0.05)
    recorder.parameter("bottom_height", "Height of the bottom bracket", -0.6, 2.8, unit="m", base_value=0.05)
    recorder.parameter("seat_place", "Place of the seat tube's upper end", -1.0, 2.4, unit="m", base_value=0.04)
    recorder.parameter("saddle_height", "Saddle height above the frame", 0.3, 2.4, unit="m", base_value=0.11)
    recorder.parameter("bar_height", "Stem height", 0.15, 3.8, unit="m", base_value=0.08)
    recorder.parameter("stem_length", "Stem length", 0.0, 2.2, unit="m", base_value=0.065)
    recorder.parameter("tube_thickness", "Tube thickness", 0.5, 2.0, unit="m", base_value=TUBE)
    recorder.parameter("stay_thickness", "Thickness of the stays", 0.35, 2.2, unit="m", base_value=0.023)
    recorder.parameter("fork_thickness", "Thickness of the fork", 0.5, 1.8, unit="m", base_value=0.03)
    declare_cranks(recorder)
    declare_saddle(recorder)
    declare_handlebars(recorder)


def slide(skeleton: Skeleton) -> None:
    """Let the common parameters shift the nodes."""
    skeleton.slide(("front", "low", "high", "stem", "clamp"), (0.20, 0.0), "wheelbase")
    skeleton.slide(("low",), (-0.015, 0.05), "fork_length")
    skeleton.slide(("front",), (0.045, 0.0), "fork_rake")
    skeleton.slide(("bottom",), (0.05, 0.0), "bottom_place")
    skeleton.slide(("bottom",), (0.0, 0.05), "bottom_height")
    skeleton.slide(("seat", "post"), (0.04, 0.0), "seat_place")
    skeleton.slide(("post",), (-0.03, 0.11), "saddle_height")
    skeleton.slide(("stem", "clamp"), (-0.02, 0.08), "bar_height")
    skeleton.slide(("clamp",), (0.065, 0.015), "stem_length")


def equip(recorder: Recorder, frame: Chassis, tubes: Sequence[Loft], stays: Sequence[Loft], *, guarded: int) -> None:
    """Slide the nodes and put on everything that hangs on them; ``guarded`` is the option with guards."""
    chain = transmission(recorder, frame.skeleton)
    slide(frame.skeleton)
    for group, size in (((*frame.tubes, *tubes), "tube"), (stays, "stay"), ((frame.fork,), "fork")):
        ends = [target for tube in group for target in tube.sections(0, 1)]
        recorder.scale(ends, 1.0, "uvz", size=f"{size}_thickness")
    wheel_parts = wheels(recorder, *frame.hubs)
    for parts, guard in zip(wheel_parts, mudguards(recorder, frame.hubs, (30.0, 25.0), guarded), strict=True):
        parts += guard
    wheel_parts[0] += carrier(recorder, frame.hubs[0], guarded)
    size_wheels(recorder, frame.hubs, wheel_parts)
    drive = cranks(recorder, frame.bottom)
    saddle(recorder, frame.post)
    handlebars(recorder, Target(frame.reach.rings[1][0], "world"))
    recorder.symmetry(mirrors=("y",), apart=[*drive, *chain])
