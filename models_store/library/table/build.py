"""Models a rectangular table: a slab with an apron beneath, four legs at its corners.

The underside of the slab is drawn in to the apron's outline by fixed distances, so apron and legs follow the edges of
the top. The legs are components of their own, anchored at the slab's lower corners in mirrored frames.
"""

import math
from pathlib import Path

import numpy as np

from models_store.library.author import publish
from shapewright.modeling import Component, Element, Mirror, ProceduralModel, Recorder, Target, group

LENGTH, WIDTH, THICKNESS = 1.50, 0.80, 0.04
LEG_LENGTH, LEG_THICKNESS, LEG_INSET = 0.68, 0.07, 0.03
LEG_SEGMENTS = 5
LEG_TAPER = 0.20  # share of the thickness that is lost at the foot
LEG_SPLAY = 0.03
APRON_HEIGHT, APRON_THICKNESS = 0.09, 0.025
APRON_BEHIND_LEG = 0.015
TOLERANCE = 1e-9

Quadrant = tuple[bool, bool]
QUADRANTS: dict[Quadrant, tuple[Mirror, ...]] = {
    (True, True): (),
    (False, True): (Mirror("x"),),
    (False, False): (Mirror("x"), Mirror("y")),
    (True, False): (Mirror("y"),),
}
"""Towards +x and +y or not, and what maps the first one there."""


def build() -> ProceduralModel:
    """Model the table."""
    recorder = Recorder("table", "table", description="A rectangular table with an apron and four legs.")
    recorder.parameter("top_length", "Top length", 0.5, 1.6, base_value=LENGTH)
    recorder.parameter("top_width", "Top width", 0.5, 1.6, base_value=WIDTH)
    recorder.parameter("top_thickness", "Top thickness", 0.3, 2.5, base_value=THICKNESS)
    recorder.parameter("leg_length", "Leg length", 0.4, 1.5, base_value=LEG_LENGTH)
    recorder.parameter("leg_thickness", "Leg thickness", 0.35, 1.8, base_value=LEG_THICKNESS)
    recorder.parameter("leg_inset", "Leg inset from the edge", 0.0, 2.2, base_value=LEG_INSET)
    recorder.parameter("leg_taper", "Leg taper (share of thickness lost at the foot)", 0.0, 3.0, base_value=LEG_TAPER)
    recorder.parameter("leg_splay", "Leg splay (shift of the feet outwards)", -0.25, 2.5, base_value=LEG_SPLAY)
    recorder.parameter("apron_height", "Apron height", 0.05, 2.2, base_value=APRON_HEIGHT)
    slab, corners = _slab(recorder)
    _legs(recorder, corners)
    _apron(recorder, slab)
    return recorder.build()


def _slab(recorder: Recorder) -> tuple[Component, dict[Quadrant, Element]]:
    """A board with its underside at z = 0, long sides cut in four and short ones in two; frames spread over its top."""
    slab = recorder.box(1.0, 1.0, THICKNESS)
    recorder.mark_sharp(slab.bottom, slab.top, *slab.sides)
    lower, upper = (recorder.vertices_of(face) for face in (slab.bottom, slab.top))
    lower = [lower[0], *lower[:0:-1]]  # a bottom face is wound the other way round
    columns = list(zip(lower, upper, strict=True))
    for i in range(4):
        first, last = columns[i], columns[(i + 1) % 4]
        middle = _cut(recorder, first, last)
        if i % 2 == 0:
            _cut(recorder, first, middle)
            _cut(recorder, middle, last)
    whole = group(slab.whole, frame="world")
    recorder.scale(whole, LENGTH, "u", size="top_length")
    recorder.scale(whole, WIDTH, "v", size="top_width")
    recorder.scale(whole, 1.0, "z", pivot=slab.bottom, size="top_thickness")
    for share in (0.72, 0.55):
        recorder.extrude(slab.top, 0.0)
        recorder.scale(slab.top, share, "uv")
    return slab, {quadrant: found[0] for quadrant, found in _by_quadrant(recorder, lower).items()}


def _cut(recorder: Recorder, first: tuple[Element, Element], last: tuple[Element, Element]) -> tuple[Element, Element]:
    """Halve the part of a side between two columns (lower and upper vertex) by a new column."""
    edges = [Element("edge", recorder.mesh.edge_between(a.id, b.id)) for a, b in zip(first, last, strict=True)]
    lower, upper = recorder.insert_vertex(*edges)
    recorder.connect(lower, upper)
    return lower, upper


def _legs(recorder: Recorder, corners: dict[Quadrant, Element]) -> None:
    """One leg at each lower corner of the slab, of height 1 first, its outer corner at the slab's."""
    anchors = [Target((corners[quadrant],), "world", image) for quadrant, image in QUADRANTS.items()]
    segment = 1.0 / LEG_SEGMENTS
    half = LEG_THICKNESS / 2
    legs = recorder.base(
        "box", (LEG_THICKNESS, LEG_THICKNESS, segment), offset=(-half, -half, -segment), anchors=anchors
    )
    feet = [leg.bottom for leg in legs]
    recorder.mark_sharp(*(face for leg in legs for face in leg.faces))
    rings = [[recorder.vertices_of(foot) for foot in feet]]
    for _ in range(LEG_SEGMENTS - 1):
        recorder.extrude(feet, segment)
        rings.append([recorder.vertices_of(foot) for foot in feet])
        recorder.mark_sharp(*(side for foot in feet for side in recorder.new_sides(foot)))
    wholes = [group(leg.whole, frame="world") for leg in legs]
    recorder.scale(wholes, LEG_LENGTH, "z", pivot=corners[True, True], size="leg_length")

    diagonal = math.sqrt(2.0)
    for level, ring in enumerate(rings, start=1):
        inner = _by_quadrant(recorder, *ring)
        loss = LEG_THICKNESS * LEG_TAPER / 2 * level / LEG_SEGMENTS
        recorder.drag(_images(inner), rho=loss * diagonal, phi_deg=-135.0, length="leg_taper")
    for leg, corner in zip(legs, corners.values(), strict=True):
        recorder.scale(group(leg.whole, frame="world"), 1.0, "uv", pivot=corner, size="leg_thickness")
    for level, ring in enumerate(rings, start=1):
        moved = dict(zip(QUADRANTS, ring, strict=True))
        shift = LEG_SPLAY * level / LEG_SEGMENTS
        recorder.drag(_images(moved), rho=shift * diagonal, phi_deg=45.0, length="leg_splay")
    recorder.drag(
        _images({quadrant: [leg.whole] for quadrant, leg in zip(QUADRANTS, legs, strict=True)}),
        rho=LEG_INSET * diagonal,
        phi_deg=-135.0,
        length="leg_inset",
    )


def _apron(recorder: Recorder, slab: Component) -> None:
    """A frame beneath the slab, between the legs, drawn out of the slab's underside."""
    face = slab.bottom
    recorder.extrude(face, 0.0)
    _draw_in(recorder, face, LEG_INSET, length="leg_inset")
    _draw_in(recorder, face, APRON_BEHIND_LEG)
    recorder.mark_sharp(face, *_corner_edges(recorder, face))
    for depth in (APRON_HEIGHT, -APRON_HEIGHT):
        recorder.extrude(face, depth, length="apron_height")
        recorder.mark_sharp(face, *_corner_edges(recorder, face))
        if depth > 0:
            recorder.extrude(face, 0.0)
            _draw_in(recorder, face, APRON_THICKNESS)
            recorder.mark_sharp(face, *_corner_edges(recorder, face))
    for share in (0.72, 0.55):
        recorder.extrude(face, 0.0)
        recorder.scale(face, share, "uv")


def _draw_in(recorder: Recorder, face: Element, distance: float, *, length: str = "") -> None:
    """Move the four sides of a rectangle towards its middle; ``length`` names a parameter, if any."""
    vertices = recorder.vertices_of(face)
    points = np.array([recorder.positions(vertex)[0] for vertex in vertices])
    for column, mirror, phi_deg in ((0, Mirror("x"), 180.0), (1, Mirror("y"), -90.0)):
        far, near = (
            tuple(v for v, p in zip(vertices, points, strict=True) if abs(p[column] - end) < TOLERANCE)
            for end in (points[:, column].max(), points[:, column].min())
        )
        sides = [Target(far, "world"), Target(near, "world", (mirror,))]
        if length:
            recorder.drag(sides, rho=distance, phi_deg=phi_deg, length=length)
        else:
            recorder.drag(sides, rho=distance, phi_deg=phi_deg)


def _corner_edges(recorder: Recorder, face: Element) -> list[Element]:
    """Return the edges that lead to the corners of a rectangle that was just extruded.

    Sharp ones keep a narrow frame within its mitred corners: smoothed, it would fold over there.
    """
    vertices = recorder.vertices_of(face)
    points = np.array([recorder.positions(vertex)[0] for vertex in vertices])
    is_corner = np.all(np.abs(np.abs(points[:, :2]) - np.abs(points[:, :2]).max(axis=0)) < TOLERANCE, axis=1)
    outline = {e.id for e in recorder.edges_of(face)}
    return [
        Element("edge", e)
        for v, corner in zip(vertices, is_corner, strict=True)
        if corner
        for e in recorder.mesh.edges_of_vertex(v.id)
        if e not in outline
    ]


def _by_quadrant(recorder: Recorder, *loops: list[Element]) -> dict[Quadrant, list[Element]]:
    """Sort the corners of rectangles by where they lie, seen from the middle of each."""
    sorted_corners: dict[Quadrant, list[Element]] = {quadrant: [] for quadrant in QUADRANTS}
    for loop in loops:
        points = np.array([recorder.positions(vertex)[0] for vertex in loop])
        centre = points.mean(axis=0)
        for vertex, point in zip(loop, points, strict=True):
            sorted_corners[bool(point[0] > centre[0]), bool(point[1] > centre[1])].append(vertex)
    return sorted_corners


def _images(elements: dict[Quadrant, list[Element]]) -> list[Target]:
    """Return targets that move as mirror images of the first quadrant's, along the model's axes."""
    return [Target(tuple(elements[quadrant]), "world", image) for quadrant, image in QUADRANTS.items()]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
