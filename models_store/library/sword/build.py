"""Models a sword: blade, guard, grip and pommel along the z axis, the tip upwards, the edges towards +x and -x.

Grip and blade are components of their own, anchored at the guard. The blade is sketched straight, of length, width
and thickness 1; then it is tapered, sized and at last bent segment by segment.
"""

from itertools import pairwise
from pathlib import Path

from models_store.library.author import publish
from models_store.library.lathe import Lathe, Ring, control_diameter, widen
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Recorder, Target, group, mirrored

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 0.68, 0.050, 0.012
BLADE_SEGMENTS = 12
BLADE_TAPER = 0.30  # share of the width that is lost up to the tip
BLADE_CURVATURE_DEG = 4.0  # between root and tip
TIP_LENGTH = 0.07
TIP_WIDTHS = (0.66, 0.05)  # halfway and at the end
GUARD_BLOCK, GUARD_DEPTH, GUARD_HEIGHT = 0.05, 0.036, 0.034
ARM_LENGTH = 0.08
GUARD_CURVATURE_DEG = 12.0
ARM_THICKNESS = 0.65  # relative to the block between the arms
ARM_SEGMENTS = 4
GRIP_LENGTH, GRIP_DIAMETER = 0.16, 0.030
POMMEL = 0.050
HILT_SIDES = 6
BAR_CONTROL = 12 / 11  # a bar of square section ends this much thinner than its control mesh


def build() -> ProceduralModel:
    """Model the sword."""
    recorder = Recorder(
        "sword", "sword", description="A sword or dagger with guard, grip and pommel; straight or curved."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.35, 1.5, base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.3, 2.2, base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.25, 2.0, base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", -0.8, 2.5, base_value=BLADE_TAPER)
    recorder.parameter("tip_length", "Tip length", 0.3, 3.0, base_value=TIP_LENGTH)
    recorder.parameter("blade_curvature", "Blade curvature", 0.0, 5.0, unit="deg", base_value=BLADE_CURVATURE_DEG)
    recorder.parameter("guard_arm_length", "Guard arm length", 0.2, 1.8, base_value=ARM_LENGTH)
    recorder.parameter("guard_depth", "Guard depth", 0.5, 2.5, base_value=GUARD_DEPTH)
    recorder.parameter(
        "guard_arm_thickness", "Guard arm thickness (relative to its block)", 0.5, 1.5, base_value=ARM_THICKNESS
    )
    recorder.parameter("guard_curvature", "Guard bend", -3.0, 3.0, unit="deg", base_value=GUARD_CURVATURE_DEG)
    recorder.parameter("grip_length", "Grip length", 0.5, 2.0, base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.5, 1.6, base_value=GRIP_DIAMETER)
    recorder.parameter("pommel_size", "Pommel size", 0.5, 1.5, base_value=POMMEL)
    guard = _guard(recorder)
    _grip(recorder, guard)
    _blade(recorder, guard)
    return recorder.build()


def _guard(recorder: Recorder) -> Component:
    """A block with two arms that are bent alike."""
    depth, height = BAR_CONTROL * GUARD_DEPTH, BAR_CONTROL * GUARD_HEIGHT
    guard = recorder.box(GUARD_BLOCK, depth, height, offset=(0.0, 0.0, -height / 2))
    right, left = guard.sides[1], guard.sides[3]
    arms = [Target((right,)), mirrored("x", left)]
    for segment in range(ARM_SEGMENTS):
        recorder.extrude(arms, ARM_LENGTH / ARM_SEGMENTS, length="guard_arm_length")
        recorder.rotate(arms, -GUARD_CURVATURE_DEG / ARM_SEGMENTS, "u", angle="guard_curvature")
        if segment == 0:
            recorder.scale(arms, ARM_THICKNESS, "uv", size="guard_arm_thickness")
    knob = 0.28 * GUARD_HEIGHT
    for size in (1.7, 1.0, 0.6):
        recorder.extrude(arms, knob)
        recorder.scale(arms, size, "uv")
    recorder.scale(group(guard.whole, frame="world"), 1.0, "v", size="guard_depth")
    return guard


def _grip(recorder: Recorder, guard: Component) -> None:
    """A column downwards from the guard with a swelling in the middle, a neck and the pommel."""
    start = 0.03 * GRIP_LENGTH
    grip = recorder.prism(
        HILT_SIDES, control_diameter(1.0, HILT_SIDES), start, offset=(0.0, 0.0, -start), anchor=guard.bottom
    )
    column = Lathe(recorder, grip)
    handle = [column.bottom, column.top]
    handle += [column.rise(share * GRIP_LENGTH, length="grip_length") for share in (0.22, 0.26, 0.26, 0.22, 0.04)]
    knob = [column.rise(share * POMMEL, length="pommel_size") for share in (0.15, 0.25, 0.35, 0.2)]
    widen(recorder, handle, GRIP_DIAMETER, size="grip_thickness")
    for ring, width in zip(handle, (1.0, 1.0, 1.05, 1.12, 1.0, 0.88, 0.85), strict=True):
        if width != 1.0:
            widen(recorder, [ring], width)
    widen(recorder, knob, POMMEL, size="pommel_size")
    for ring, width in zip(knob, (0.68, 1.04, 0.95, 0.45), strict=True):
        widen(recorder, [ring], width)


def _blade(recorder: Recorder, guard: Component) -> None:
    """A blade of lenticular section with two sharp edges."""
    segment = 1.0 / BLADE_SEGMENTS
    root = BAR_CONTROL * GUARD_HEIGHT / 2  # it starts within the guard
    blade = recorder.base("prism", (1.0, 1.5, segment), sides=4, offset=(0.0, 0.0, -root), anchors=guard.top)[0]
    column = Lathe(recorder, blade)
    rings = [column.bottom, column.top, *(column.rise(segment) for _ in range(BLADE_SEGMENTS - 1))]
    whole = group(blade.whole, frame="world")
    recorder.scale(whole, BLADE_LENGTH, "z", pivot=blade.bottom, size="blade_length")
    rings += [column.rise(TIP_LENGTH / 2, length="tip_length") for _ in range(2)]

    for level, ring in enumerate(rings[1:], start=1):
        right, left = _edge_vertices(recorder, ring)
        loss = BLADE_TAPER / 2 * min(level / BLADE_SEGMENTS, 1.0)
        ends = [Target((right,), "world"), Target((left,), "world", (Mirror("x"),))]
        recorder.drag(ends, rho=loss, phi_deg=180.0, length="blade_taper")
    recorder.scale(whole, BLADE_WIDTH, "u", size="blade_width")
    recorder.scale(whole, BLADE_THICKNESS, "v", size="blade_thickness")
    for ring, width in zip(rings[-2:], TIP_WIDTHS, strict=True):
        recorder.scale(group(*ring, frame="world"), width, "u")
    recorder.scale(group(*rings[-1], frame="world"), 0.25, "v")
    _sharpen(recorder, blade, rings)

    step_deg = BLADE_CURVATURE_DEG / (len(rings) - 1)
    for level in range(1, len(rings)):
        beyond = [vertex for ring in rings[level:] for vertex in ring]
        hinge = _ridge_vertex(recorder, rings[level - 1])
        recorder.rotate(group(*beyond, frame="world"), step_deg, "v", pivot=hinge, angle="blade_curvature")


def _sharpen(recorder: Recorder, blade: Component, rings: list[Ring]) -> None:
    edges = []
    for lower, upper in pairwise(rings):
        for start, end in zip(_edge_vertices(recorder, lower), _edge_vertices(recorder, upper), strict=True):
            edges.append(Element("edge", recorder.mesh.edge_between(start.id, end.id)))
    recorder.mark_sharp(*edges, blade.bottom, blade.top)


def _edge_vertices(recorder: Recorder, ring: Ring) -> tuple[Element, Element]:
    """Return the vertices of a section that lie on the blade's edges, the one towards +x first."""
    in_order = sorted(ring, key=lambda vertex: float(recorder.positions(vertex)[0, 0]))
    return in_order[-1], in_order[0]


def _ridge_vertex(recorder: Recorder, ring: Ring) -> Element:
    """Return the vertex of a section in the middle of one side of the blade."""
    return max(ring, key=lambda vertex: float(recorder.positions(vertex)[0, 1]))


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
