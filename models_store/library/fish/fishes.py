"""Modelling aid for fish: a body with fins in its middle plane, bent together, and paired fins. Forward is +x."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

from models_store.library.aids.fins import Fan, Rib, fan, plate
from models_store.library.aids.loft import Loft, Section, loft, pair
from shapewright.modeling import Condition, Element, Recorder, Target

Profile = tuple[tuple[float, float, float], ...]
Ribs = tuple[tuple[float, float], ...]
BODY: Profile = (
    (-0.500, 0.28, 0.22),
    (-0.400, 0.34, 0.38),
    (-0.250, 0.56, 0.64),
    (-0.070, 0.86, 0.90),
    (0.100, 1.00, 1.00),
    (0.250, 0.95, 0.98),
    (0.360, 0.76, 0.86),
    (0.440, 0.50, 0.62),
    (0.485, 0.28, 0.38),
    (0.505, 0.10, 0.14),
)
"""Sections of a fish from the stem of its tail to its snout: place, height and width, relative to the body's."""
TAIL_STEM, MIDDLE, HEAD, SNOUT = (0, 1), (3, 4, 5), 6, (7, 8, 9)
SAG, PLACE, HEAD_TILT_DEG, SWEEP = 0.06, 0.05, 5.0, 0.08
"""Base values: relative to the body's height, to its length, an angle, relative to its length."""
PECTORAL_SWEEP_DEG, PECTORAL_DROOP_DEG, PECTORAL_PITCH_DEG = 45.0, 20.0, 20.0
PELVIC_SWEEP_DEG, PELVIC_DROOP_DEG = 35.0, 60.0
PADDLE: Ribs = ((-0.18, 0.35), (0.05, 0.42), (0.35, 0.70), (0.70, 1.00), (0.92, 0.80), (1.0, 0.45))
BLADE: Ribs = ((-0.18, 0.80), (0.05, 1.00), (0.35, 0.78), (0.70, 0.48), (0.92, 0.24), (1.0, 0.10))
"""Paired fins from root to tip: place and width, relative to the fin's length and width."""
BEND_DEG = 8.0
LABELS = {
    "body_length": ("Body length (without tail fin)", "m"),
    "body_height": ("Body height", "m"),
    "body_width": ("Body width", "m"),
    "deepest": ("Place of the greatest height (forwards)", "m"),
    "sag": ("Sag of the belly", "m"),
    "snout_length": ("Snout length (relative)", None),
    "snout_height": ("Snout height (relative)", None),
    "head_tilt": ("Head tilt downwards", "deg"),
    "stem_height": ("Height of the tail's stem (relative)", None),
    "tail_length": ("Tail fin length", "m"),
    "tail_height": ("Tail fin height", "m"),
    "tail_spread": ("Spread of the tail fin's end (relative)", None),
    "tail_fork": ("Tail fork depth (below 0: rounded)", "m"),
    "tail_lobe": ("Rise of the tail fin's upper tip", "m"),
    "fin_thickness": ("Thickness of the fins (relative)", None),
    "dorsal_height": ("Dorsal fin height", "m"),
    "dorsal_sweep": ("Dorsal fin sweep", "m"),
    "anal_height": ("Anal fin height", "m"),
    "anal_sweep": ("Anal fin sweep", "m"),
    "pectoral_length": ("Pectoral fin length", "m"),
    "pectoral_width": ("Pectoral fin width (relative)", None),
    "pectoral_sweep": ("Pectoral fin sweep", "deg"),
    "pectoral_droop": ("Pectoral fin droop", "deg"),
    "pectoral_pitch": ("Pectoral fin pitch", "deg"),
    "pelvic_length": ("Pelvic fin length", "m"),
    "pelvic_sweep": ("Pelvic fin sweep", "deg"),
    "pelvic_droop": ("Pelvic fin droop", "deg"),
    "eye_size": ("Eye size (relative)", None),
    "tail_bend": ("Bend of the tail sideways", "deg"),
    "body_bend": ("Bend of the body sideways", "deg"),
}
"""Label and unit of each parameter that this aid uses."""


def declare(recorder: Recorder, active_when: Sequence[Condition] = (), /, **ranges: tuple[float, float, float]) -> None:
    """Declare parameters of this aid, each as smallest and largest x and the base value."""
    for name, (minimum, maximum, base_value) in ranges.items():
        label, unit = LABELS[name]
        recorder.parameter(
            name, label, minimum, maximum, unit=unit, base_value=base_value, active_when=tuple(active_when)
        )


@dataclass(frozen=True)
class Outline:
    """A fin in the middle plane: places along the body and heights above its back (or below its belly).

    Attributes:
        points: (place, height), places rising, relative to the body's length and height.
    """

    points: tuple[tuple[float, float], ...]


@dataclass
class Fish:
    """A fish as it is modelled: its body and what lies in its middle plane.

    Attributes:
        profile: what :data:`BODY` is for most fish.
        fins: the fins that move with the body, tail fin left out.
    """

    body: Loft
    profile: Profile
    length: float
    height: float
    width: float
    fin_thickness: float
    fins: list[Loft] = field(default_factory=list)
    tail: Fan | None = None

    def middle(self) -> list[Loft]:
        """Return the body, its fins and its tail."""
        return [self.body, *self.fins, *([self.tail.loft] if self.tail else [])]


def model_body(
    recorder: Recorder, length: float, height: float, width: float, fin_thickness: float, profile: Profile = BODY
) -> Fish:
    """Model a body of a length, height and width, without its fins."""
    round_off = 1.09  # a control mesh of eight sides ends this much thinner
    sections = [Section(a * length, w * width * round_off, h * height * round_off) for a, h, w in profile]
    return Fish(loft(recorder, "x", sections), profile, length, height, width, fin_thickness)


def model_fin(recorder: Recorder, fish: Fish, outline: Outline, *, below: bool = False) -> Loft:
    """Model a fin on the back, or below the belly; it begins well within the body."""
    way = -1.0 if below else 1.0
    ribs = []
    for number, (place, height) in enumerate(outline.points):
        edge = contour(fish, place)
        ends = sorted((way * 0.1 * edge, way * (edge + height * fish.height)))
        thick = 0.6 if number in (0, len(outline.points) - 1) else 1.0
        ribs.append(Rib(place * fish.length, ends[0], ends[1], thick * fish.fin_thickness))
    fin = plate(recorder, "x", "z", ribs)
    fish.fins.append(fin)
    return fin


def contour(fish: Fish, place: float) -> float:
    """Return the height of the back above the axis at a place, both as modelled."""
    for (start, low, _), (end, high, _) in pairwise(fish.profile):
        if start <= place <= end:
            return fish.height / 2 * (low + (high - low) * (place - start) / (end - start))
    raise ValueError(place)


def size_fin(recorder: Recorder, fish: Fish, fins: Sequence[Loft], name: str, *, below: bool = False) -> None:
    """Let the height of fins vary about the edge of the body, and their sweep, as ``name`` with _height and _sweep."""
    way = -1.0 if below else 1.0
    for fin in fins:
        middle = sum(float(recorder.centre(v)[0]) for v in fin.rings[len(fin.rings) // 2][0]) / 4
        rings = fish.body.rings
        off = [round(abs(float(recorder.centre(ring[0][0])[0]) - middle), 9) for ring in rings]
        near = min(range(len(rings)), key=lambda i: (off[i], -i))  # of two that are as near, the one ahead
        edge = fish.body.vertex(recorder, near, (0.0, 0.0, way))
        recorder.scale(Target((fin.component.whole,), "world", (), (edge,)), 1.0, "z", size=f"{name}_height")
        for ring in fin.rings:
            outer = max(ring[0], key=lambda v: way * float(recorder.positions(v)[0, 2]))
            recorder.drag(Target((outer,), "world"), rho=SWEEP * fish.length, phi_deg=180.0, length=f"{name}_sweep")


def model_tail(recorder: Recorder, fish: Fish, length: float, heights: Sequence[float], *, rise: float = 0.0) -> None:
    """Model the tail fin; uses tail_length, tail_height, tail_spread and tail_fork.

    With a rise its upper tip stands higher than what mirrors the lower one, which tail_lobe varies.
    """
    root = Target(fish.body.rings[0][0], "world")
    inside = 0.05 * fish.length
    fish.tail = fan(recorder, "z", length, heights, fish.fin_thickness, offset=(inside, 0.0, 0.0), anchor=root)
    made = fish.tail.loft
    recorder.scale(made.body(hinge=0), 1.0, "u", size="tail_length")
    recorder.scale(made.body(hinge=0), 1.0, "z", size="tail_height")
    recorder.scale(made.sections(len(heights) - 1), 1.0, "z", size="tail_spread")
    fish.tail.fork(recorder, 0.2 * length, "tail_fork")
    if rise:
        for section, share in ((-1, 1.0), (-2, 0.4)):
            tip = max(made.rings[section][0], key=lambda v: float(recorder.positions(v)[0, 2]))
            recorder.drag(Target((tip,), "world"), share * rise, height="tail_lobe")


def shape_body(recorder: Recorder, fish: Fish) -> None:
    """Give the body its proportions, with its fins where they are of the whole.

    Uses fin_thickness, stem_height, deepest, sag, snout_length, snout_height, head_tilt and the body's three sizes.
    """
    body = fish.body
    thin = [target for part in fish.middle()[1:] for target in part.body()]
    recorder.scale(thin, 1.0, "v", size="fin_thickness")
    recorder.scale(body.sections(*TAIL_STEM), 1.0, "z", size="stem_height")
    recorder.scale(body.beyond(HEAD, hinge=HEAD), 1.0, "u", size="snout_length")
    recorder.scale(body.sections(*SNOUT), 1.0, "z", size="snout_height")
    for sections, share in ((MIDDLE, 1.0), ((2, 6), 0.6)):
        recorder.drag(body.sections(*sections), rho=share * PLACE * fish.length, length="deepest")
        recorder.drag(body.sections(*sections), -share * SAG * fish.height, length="sag")
    recorder.rotate(body.beyond(HEAD, hinge=HEAD - 1), HEAD_TILT_DEG, "v", angle="head_tilt")
    everything = Target(tuple(part.component.whole for part in fish.middle()), "world", (), body.rings[4][0])
    recorder.scale(everything, 1.0, "u", size="body_length")
    recorder.scale(everything, 1.0, "z", size="body_height")
    recorder.scale(body.body(hinge=4), 1.0, "v", size="body_width")


def bend(recorder: Recorder, fish: Fish) -> None:
    """Bend the fish sideways, from the tail forwards; uses tail_bend and body_bend."""
    for joint, name in ((0, "tail_bend"), (1, "tail_bend"), (2, "tail_bend"), (3, "body_bend"), (4, "body_bend")):
        hinge = fish.body.rings[joint][0]
        place = float(recorder.positions(hinge[0])[0, 0])
        behind = [
            v
            for part in fish.middle()
            for ring in part.rings
            for v in ring[0]
            if float(recorder.centre(v)[0]) < place - 1e-6
        ]
        recorder.rotate(Target(tuple(behind), "world", (), hinge), BEND_DEG, "z", angle=name)


def at_side(recorder: Recorder, fish: Fish, section: int, height: Literal["low", "middle", "high"]) -> list[Target]:
    """Return the vertices of a section of the body to both sides, at one of three heights, to hang fins on."""
    ring = sorted(fish.body.rings[section][0], key=lambda v: float(recorder.positions(v)[0, 1]))
    number = {"low": 0, "middle": 1, "high": 2}[height]
    right, left = (sorted(side, key=lambda v: float(recorder.positions(v)[0, 2])) for side in (ring[:3], ring[5:]))
    return pair(left[number], right[number])


def model_side_fins(
    recorder: Recorder,
    fish: Fish,
    anchors: Sequence[Target],
    length: float,
    width: float,
    name: str,
    shape: Ribs = PADDLE,
) -> Loft:
    """Model a pair of fins at the sides or the belly, ``name`` pectoral or pelvic.

    Uses its _length, _sweep and _droop; a pectoral fin's _width and _pitch too.
    """
    thin = fish.fin_thickness
    ribs = [Rib(at * length, -0.6 * w * width, 0.4 * w * width, thin * (1.0 if at < 0.9 else 0.6)) for at, w in shape]
    inside = (0.0, -0.06 * fish.width, 0.0)
    fins = plate(recorder, "y", "x", ribs, offset=inside, anchors=anchors)
    recorder.scale(fins.sections(*range(len(ribs))), 1.0, "z", size="fin_thickness")
    recorder.scale(fins.beyond(1, hinge=1), 1.0, "v", size=f"{name}_length")
    pectoral = name == "pectoral"
    if pectoral:
        recorder.scale(fins.sections(*range(2, len(ribs))), 1.0, "u", size="pectoral_width")
        recorder.rotate(fins.beyond(1, hinge=0), -PECTORAL_PITCH_DEG, "v", angle="pectoral_pitch")
    sweep_deg, droop_deg = (
        (PECTORAL_SWEEP_DEG, PECTORAL_DROOP_DEG) if pectoral else (PELVIC_SWEEP_DEG, PELVIC_DROOP_DEG)
    )
    recorder.rotate(fins.beyond(1, hinge=0), sweep_deg, "z", angle=f"{name}_sweep")
    recorder.rotate(fins.beyond(1, hinge=0), -droop_deg, "u", angle=f"{name}_droop")
    return fins


def model_eyes(recorder: Recorder, fish: Fish, size: float) -> Loft:
    """Model two eyes at the head; uses eye_size."""
    anchors = at_side(recorder, fish, 7, "high")
    sections = [Section(a * size, w * size, w * size) for a, w in ((-0.9, 0.7), (-0.2, 1.2), (0.25, 0.8))]
    eyes = loft(recorder, "y", sections, sides=6, anchors=anchors)
    recorder.scale(eyes.body(hinge=0), 1.0, "uvz", size="eye_size")
    return eyes


def wholes(*lofts: Loft) -> list[Element]:
    """Return the components of lofts and of their copies."""
    return [component.whole for loft in lofts for component in loft.components]
