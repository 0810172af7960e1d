"""Models a chair on four legs: a seat with rounded corners, one of three backs, perhaps armrests and stretchers.

The legs are modelled one after another. All of the back has height 1 and width 1 first, so that one operation sizes it
and one leans it back; the rear ends of the armrests lean with it.
"""

from pathlib import Path

from models_store.library.aids.sketching import corner, push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Target, when

WIDTH, DEPTH, THICKNESS = 0.45, 0.43, 0.045
ROUNDING = 0.25  # of half a side
LEG_LENGTH, LEG_THICKNESS, LEG_TAPER, LEG_SPLAY, LEG_INSET = 0.42, 0.045, 0.75, 0.02, 0.012
BACK_HEIGHT, BACK_LEAN_DEG, BOARD_GAP = 0.48, 8.0, 0.35
ARM_HEIGHT = 0.48  # of the back
SIGNS = ((1, 1), (1, -1), (-1, 1), (-1, -1))


def model() -> AnnotatingRecorder:
    """Model the chair."""
    r = AnnotatingRecorder(
        "chair", "chair", unit_m=1.0, description="A chair with four legs, a back and perhaps armrests."
    )
    r.parameter("seat_width", "Seat width", 0.7, 1.6, unit="m", base_value=WIDTH)
    r.parameter("seat_depth", "Seat depth", 0.7, 1.4, unit="m", base_value=DEPTH)
    r.parameter("seat_thickness", "Seat thickness", 0.35, 3.0, unit="m", base_value=THICKNESS)
    r.parameter("corner_rounding", "Seat corner rounding (of half a side)", 0.1, 2.6, base_value=ROUNDING)
    r.parameter("leg_length", "Leg length", 0.45, 1.7, unit="m", base_value=LEG_LENGTH)
    r.parameter("leg_thickness", "Leg thickness", 0.5, 1.6, unit="m", base_value=LEG_THICKNESS)
    r.parameter("leg_taper", "Foot thickness (of the leg's)", 0.5, 1.35, base_value=LEG_TAPER)
    r.parameter("leg_splay", "Leg splay", -0.5, 4.0, unit="m", base_value=LEG_SPLAY)
    r.parameter("leg_inset", "Leg inset from the corners", 0.0, 4.0, unit="m", base_value=LEG_INSET)
    r.limit("leg_inset", minimum=("corner_rounding", -0.8, 1.2))
    r.choice("back", "Back", ("board", "ladder", "spindles"))
    r.parameter("back_height", "Back height", 0.5, 1.9, unit="m", base_value=BACK_HEIGHT)
    r.parameter("back_lean", "Back lean", -0.2, 2.6, unit="deg", base_value=BACK_LEAN_DEG)
    r.parameter(
        "board_gap", "Gap below the board (of the back)", 0.0, 2.0, base_value=BOARD_GAP, active_when=[when("back", 1)]
    )
    r.switch("armrests", "Armrests")
    r.parameter(
        "arm_height",
        "Armrest height (of the back)",
        0.6,
        1.35,
        base_value=ARM_HEIGHT,
        active_when=[when("armrests", 1)],
    )
    r.switch("stretchers", "Stretchers between the legs")
    seat, rear = _seat(r)
    legs = _legs(r, seat)
    _stretchers(r, legs)
    _back(r, seat, rear)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _seat(r: AnnotatingRecorder) -> tuple[Component, Element]:
    """A flat slab with rounded corners; the middle of its upper rear edge."""
    seat = r.box(1.0, 1.0, 1.0)
    middles: list[Element] = []
    for side in seat.sides:
        edges = [e for e in r.edges_of(side) if abs(r.positions(e)[0, 2] - r.positions(e)[1, 2]) < 0.5]
        r.judge("middle of a seat side", important=False)
        lower, upper = r.insert_vertex(*edges)
        r.connect(lower, upper)
        middles.append(max(lower, upper, key=lambda vertex: float(r.positions(vertex)[0, 2])))
        halves = [e for middle in (lower, upper) for e in r.mesh.edges_of_vertex(middle.id)]
        ends = {e: r.mesh.edge(e) for e in halves if (lower.id not in r.mesh.edge(e) or upper.id not in r.mesh.edge(e))}
        r.judge("seat corner rounding", important=False)
        starts = (lower.id, upper.id)
        made = r.insert_vertex(
            *((Element("edge", e), pair[1] in starts) for e, pair in sorted(ends.items())),
            lambda1=ROUNDING,
            position="corner_rounding",
        )
        for first, second in _columns(r, made):
            r.connect(first, second)
    r.mark_sharp(seat.bottom, seat.top)
    r.judge("seat depth", important=True)
    r.scale(put(seat.whole), DEPTH, "u", size="seat_depth")
    r.judge("seat width", important=True)
    r.scale(put(seat.whole), WIDTH, "v", size="seat_width")
    r.judge("seat thickness", important=True)
    r.scale(put(seat.whole), THICKNESS, "z", pivot=seat.bottom, size="seat_thickness")
    return seat, middles[3]


def _columns(r: AnnotatingRecorder, vertices: list[Element]) -> list[tuple[Element, Element]]:
    """Pair vertices of the lower rim with those above them."""
    lower = [v for v in vertices if r.positions(v)[0, 2] < 0.5]
    upper = [v for v in vertices if v not in lower]
    return [
        (low, min(upper, key=lambda v: float(abs(r.positions(v)[0, :2] - r.positions(low)[0, :2]).sum())))
        for low in lower
    ]


def _legs(r: AnnotatingRecorder, seat: Component) -> dict[tuple[int, int], Component]:
    """Four square legs below the corners, each of thickness 1 first."""
    legs = {}
    for x, y in SIGNS:
        hip = corner(r, seat.bottom, (x, y, 0))
        leg = r.box(1.0, 1.0, 0.02, offset=(-x / 2, -y / 2, -0.02), anchor=put(hip))
        r.mark_sharp(*leg.faces)
        r.judge("leg length", important=True)
        r.extrude(leg.bottom, LEG_LENGTH - 0.02, length="leg_length")
        r.mark_sharp(*r.new_sides(leg.bottom))
        r.judge("leg thickness", important=True)
        r.scale(put(leg.whole), LEG_THICKNESS, "uv", pivot=hip, size="leg_thickness")
        r.judge("leg taper", important=False)
        r.scale(put(leg.bottom), LEG_TAPER, "uv", size="leg_taper")
        r.judge("leg splay", important=True)
        push(r, leg.bottom, (LEG_SPLAY * x, LEG_SPLAY * y, 0.0), length="leg_splay")
        legs[x, y] = leg
    r.judge("leg inset", important=False)
    moved = [Target((legs[x, y].whole,), "world", _image(x, y)) for x, y in SIGNS]
    r.drag(moved, 0.0, LEG_INSET * 2**0.5, -135.0, length="leg_inset")
    return legs


def _image(x: int, y: int) -> tuple[Mirror, ...]:
    return (Mirror("x"),) * (x < 0) + (Mirror("y"),) * (y < 0)


def _stretchers(r: AnnotatingRecorder, legs: dict[tuple[int, int], Component]) -> None:
    """A bar between the legs of each side, halfway down, and one across; their ends follow the legs."""
    bars = []
    for y in (1, -1):
        ends = [face for x in (1, -1) for face in (legs[x, y].top, legs[x, y].bottom)]
        bars.append(r.box(0.02, 0.018, 0.022, anchor=put(*ends)))
    across = r.box(0.018, 0.02, 0.022, anchor=put(bars[0].whole, bars[1].whole))
    r.mark_sharp(*(face for bar in (*bars, across) for face in bar.faces))
    along = [Target((bar.sides[i],), "world", _image(x, 1)) for bar in bars for x, i in ((1, 1), (-1, 3))]
    sideways = [Target((across.sides[i],), "world", _image(1, y)) for y, i in ((1, 2), (-1, 0))]
    for ends_of_bar, phi_deg, half, size in (
        (along, 0.0, DEPTH / 2, "seat_depth"),
        (sideways, 90.0, WIDTH / 2, "seat_width"),
    ):
        r.judge("stretcher length", important=False)
        r.drag(ends_of_bar, 0.0, half, phi_deg, length=size)
        r.judge("depth of the stretcher's ends in the legs", important=False)
        r.drag(ends_of_bar, 0.0, 0.021, phi_deg + 180.0)
        r.judge("stretcher ends following the legs' inset", important=False)
        r.drag(ends_of_bar, 0.0, LEG_INSET, phi_deg + 180.0, length="leg_inset")
        r.judge("stretcher ends following the legs' splay", important=False)
        r.drag(ends_of_bar, 0.0, LEG_SPLAY / 2, phi_deg, length="leg_splay")
    r.part("stretchers", [*bars, across], [when("stretchers", 1)])


def _back(r: AnnotatingRecorder, seat: Component, rear: Element) -> None:
    """Two posts and what is between them, and the armrests; the back leans about the seat's rear edge."""
    corners = {y: corner(r, seat.top, (-1, y, 0)) for y in (1, -1)}
    posts = [
        r.box(0.036, 0.036, 1.03, offset=(0.018, -0.024 * y, -0.03), anchor=put(hip)) for y, hip in corners.items()
    ]
    hinge = put(rear)
    board = r.box(0.022, 1.0, 0.97, offset=(0.018, 0.0, 0.0), anchor=hinge)
    slats = [r.box(0.02, 1.0, 0.1, offset=(0.018, 0.0, z), anchor=hinge) for z in (0.3, 0.58, 0.86)]
    rail = r.box(0.026, 1.0, 0.12, offset=(0.018, 0.0, 0.86), anchor=hinge)
    spindles = [
        r.box(0.018, 0.045, 0.9, offset=(0.018, y, -0.02), anchor=hinge) for y in (-0.36, -0.18, 0.0, 0.18, 0.36)
    ]
    arms = [r.box(0.9, 0.05, 0.06, offset=(0.45, -0.02 * y, -0.03), anchor=put(corners[y])) for y in (1, -1)]
    supports = [r.box(0.09, 0.034, 0.04, offset=(0.72, -0.026 * y, -0.04), anchor=put(corners[y])) for y in (1, -1)]
    inner = [board, *slats, rail, *spindles]
    r.mark_sharp(*(f for part in (*posts, board, *slats, rail, *arms, *supports) for f in part.faces))
    r.mark_sharp(*(f for part in spindles for f in (part.bottom, part.top)))
    r.judge("gap below the board", important=True)
    push(r, board.bottom, (0.0, 0.0, BOARD_GAP), length="board_gap")
    for arm, support in zip(arms, supports, strict=True):
        r.judge("armrest height", important=True)
        push(r, arm.whole, (0.0, 0.0, ARM_HEIGHT), length="arm_height")
        push(r, support.top, (0.0, 0.0, ARM_HEIGHT), length="arm_height")
    r.judge("armrest length", important=True)
    r.scale(
        [put(*(c.whole for c in (arms[i], supports[i])), pivot=(corners[y],)) for i, y in ((0, 1), (1, -1))],
        DEPTH,
        "u",
        size="seat_depth",
    )
    r.judge("width between the posts", important=False)
    r.scale(put(*(part.whole for part in inner)), 0.9 * WIDTH, "v", pivot=rear, size="seat_width")
    r.judge("back height", important=True)
    everything = [part.whole for part in (*posts, *inner, *arms, *supports)]
    r.scale(put(*everything), BACK_HEIGHT, "z", pivot=rear, size="back_height")
    r.judge("back lean", important=True)
    leaning = [part.whole for part in (*posts, *inner)]
    r.rotate(put(*leaning, *(arm.sides[3] for arm in arms)), -BACK_LEAN_DEG, "v", pivot=rear, angle="back_lean")
    r.part("board", [board], [when("back", 1)])
    r.part("ladder", slats, [when("back", 2)])
    r.part("spindles", [rail, *spindles], [when("back", 3)])
    r.part("armrests", [*arms, *supports], [when("armrests", 1)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
