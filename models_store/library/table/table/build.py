"""Models a rectangular table: a top, an apron beneath and four legs at its corners.

Legs and aprons are alternatives that stand in the same place; sizes stretch all of them alike.
"""

from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.boards import ACROSS, QUADRANTS, board, placed, pull, stretch
from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.loft import Loft, Section, move
from models_store.library.author import publish
from shapewright.modeling import Component, ProceduralModel, Recorder, Target, group, when

LENGTH, WIDTH, THICKNESS = 1.50, 0.80, 0.04
LEG_LENGTH, LEG_THICKNESS, LEG_INSET = 0.68, 0.07, 0.03
FOOT = 0.8  # thickness, relative to the leg's upper end
SPLAY = 0.03
ROUND_SIDES, TURNED_SIDES = 8, 6
TURNED = ((0.0, 1.0), (0.14, 1.0), (0.20, 0.5), (0.32, 1.1), (0.44, 0.5), (0.60, 1.0), (0.85, 0.55), (1.0, 0.8))
"""The profile of a turned leg: depths and diameters, shares of its length and thickness."""
APRON_HEIGHT, APRON_THICKNESS, APRON_SETBACK = 0.09, 0.025, 0.006
HALF_X, HALF_Y = LENGTH / 2, WIDTH / 2
EDGE_X, EDGE_Y = HALF_X - LEG_INSET, HALF_Y - LEG_INSET  # of the legs, outside


def build() -> ProceduralModel:
    """Model the table."""
    r = Recorder(
        "table", "table", unit_m=1.0, description="A rectangular table with four legs, with or without an apron."
    )
    _declare(r)
    top = board(r, (-HALF_X, -HALF_Y, 0.0), (HALF_X, HALF_Y, THICKNESS))[0]
    r.scale(Target((top.whole,), "world"), 1.0, "z", pivot=top.bottom, size="top_thickness")
    kinds = _legs(r, top)
    legs = [leg for kind in kinds.values() for leg in kind.components]
    frame, box = _aprons(r)
    beneath = [*legs, *frame, *box]
    stretch(r, beneath, "x", -LEG_INSET, "leg_inset")
    stretch(r, beneath, "y", -LEG_INSET, "leg_inset_sides")
    stretch(r, [top, *beneath], "x", HALF_X, "top_length")
    stretch(r, [top, *beneath], "y", HALF_Y, "top_width")

    for number, (name, kind) in enumerate(kinds.items(), start=1):
        r.part(f"{name} legs", kind.components, [when("legs", number)])
    r.part("apron frame", frame, [when("apron", 1)])
    r.part("apron box", box, [when("apron", 2)])
    r.symmetry(mirrors=("x", "y"), axis="z", order=2)
    return r.build()


def _declare(r: Recorder) -> None:
    r.parameter("top_length", "Top length", 0.5, 1.6, unit="m", base_value=LENGTH)
    r.parameter("top_width", "Top width", 0.45, 1.8, unit="m", base_value=WIDTH)
    r.parameter("top_thickness", "Top thickness", 0.3, 2.5, unit="m", base_value=THICKNESS)
    r.choice("legs", "Legs", ("square", "round", "turned"))
    r.parameter("leg_length", "Leg length", 0.3, 1.5, unit="m", base_value=LEG_LENGTH)
    r.parameter("leg_thickness", "Leg thickness", 0.35, 2.8, unit="m", base_value=LEG_THICKNESS)
    r.limit("leg_thickness", maximum=("top_width", 0.0, 3.0))
    r.limit("leg_thickness", maximum=("top_length", 0.0, 3.6))
    square = (when("legs", 1),)
    r.parameter("leg_width", "Leg width (relative to thickness)", 0.7, 2.0, base_value=1.0, active_when=square)
    r.limit("leg_width", maximum=("leg_thickness", 2.4, -0.5))
    r.parameter("foot_thickness", "Foot thickness (relative to the leg's upper end)", 0.4, 1.25, base_value=FOOT)
    r.parameter("leg_splay", "Leg splay (shift of the feet outwards)", -0.5, 3.5, unit="m", base_value=SPLAY)
    r.limit("leg_splay", maximum=("leg_length", -0.6, 3.0))
    r.parameter("leg_inset", "Leg inset from the ends", 0.0, 8.0, unit="m", base_value=LEG_INSET)
    r.limit("leg_inset", maximum=("top_length", 0.0, 9.0))
    r.parameter("leg_inset_sides", "Leg inset from the long sides", 0.0, 5.0, unit="m", base_value=LEG_INSET)
    r.limit("leg_inset_sides", maximum=("top_width", 0.0, 5.0))
    r.choice("apron", "Apron", ("frame", "box", "none"))
    r.parameter(
        "apron_height", "Apron height", 0.3, 2.6, unit="m", base_value=APRON_HEIGHT, active_when=[when("apron", 1, 2)]
    )
    r.limit("apron_height", maximum=("leg_length", 0.0, 4.0))


def _legs(r: Recorder, top: Component) -> dict[str, Loft]:
    """Three kinds of legs, their outer corners at the legs' edges; thickness grows inwards."""
    place = (EDGE_X - LEG_THICKNESS / 2, EDGE_Y - LEG_THICKNESS / 2, 0.0)
    profiles = {"square": (4, [(0.0, 1.0), (1.0, 1.0)]), "round": (ROUND_SIDES, [(0.0, 1.0), (1.0, 1.0)])}
    profiles["turned"] = (TURNED_SIDES, list(TURNED))
    kinds = {}
    for name, (sides, profile) in profiles.items():
        wide = LEG_THICKNESS if sides == 4 else control_diameter(LEG_THICKNESS, sides)
        sections = [Section(depth * LEG_LENGTH, share * wide, share * wide) for depth, share in profile]
        kinds[name] = beam(r, "-z", sections, sides=sides, offset=place, anchors=placed(QUADRANTS))
    kinds_made = list(kinds.values())
    r.scale([target for kind in kinds_made for target in kind.sections(-1)], FOOT, "uv", size="foot_thickness")

    square = kinds["square"]
    corners = [max(ring, key=lambda v: float(abs(r.positions(v)[0, :2]).sum())) for ring in square.rings[0]]
    legs = [
        Target((component.whole,), "world", image, (corner,))
        for kind in kinds_made
        for component, image, corner in zip(kind.components, QUADRANTS, corners, strict=True)
    ]
    r.scale(legs, 1.0, "uv", size="leg_thickness")
    r.scale(legs[: len(QUADRANTS)], 1.0, "u", size="leg_width")
    for kind, (_, profile) in zip(kinds_made, profiles.values(), strict=True):
        for number, (depth, _) in enumerate(profile):
            if depth:
                move(r, kind.sections(number), (SPLAY * depth, SPLAY * depth, 0.0), length="leg_splay")
    every = [component.whole for kind in kinds_made for component in kind.components]
    r.scale(group(*every, frame="world"), 1.0, "z", pivot=top.bottom, size="leg_length")
    return kinds


def _aprons(r: Recorder) -> tuple[list[Component], list[Component]]:
    """A frame of four boards between the legs, and a closed box of the same extents."""
    x, y = EDGE_X - APRON_SETBACK, EDGE_Y - APRON_SETBACK
    frame = [
        *board(r, (-x, y - APRON_THICKNESS, -APRON_HEIGHT), (x, y, 0.0), ACROSS["y"]),
        *board(r, (x - APRON_THICKNESS, -y, -APRON_HEIGHT), (x, y, 0.0), ACROSS["x"]),
    ]
    box = board(r, (-x, -y, -APRON_HEIGHT), (x, y, 0.0))
    pull(r, [*frame, *box], "z", -APRON_HEIGHT, "apron_height", beyond=-APRON_HEIGHT / 2)
    return frame, box


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
