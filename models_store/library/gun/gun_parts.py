"""Parts that the models of guns share: barrels, trigger and guard, sights, scopes, magazines.

The muzzle points to +x. Every part hangs on an anchor and reaches a little into the body that bears it.
"""

from collections.abc import Iterable

from models_store.library.aids.beam import beam
from models_store.library.aids.loft import Loft, Section
from shapewright.modeling import Component, Mirror, Recorder, Target, group

ROUND = 1.1
"""A control octagon must be wider by this than the round section that it becomes."""
SCOPE_PLACE = 0.03


def tube(
    recorder: Recorder, anchor: Target, profile: list[tuple[float, float]], *, rise: float = 0.0, bore: float = 0.0
) -> Loft:
    """A round body along +x of (place, diameter) pairs; ``bore`` sinks a hole of this share into its front."""
    sections = [Section(place, diameter * ROUND, diameter * ROUND) for place, diameter in profile]
    made = beam(recorder, "+x", sections, sides=8, offset=(0.0, 0.0, rise), anchors=anchor)
    if bore > 0.0:
        front = made.component.top
        recorder.extrude(front, 0.0)
        recorder.scale(front, bore, "uv")
        recorder.mark_sharp(front)
        recorder.extrude(front, -min(profile[-1][1], 0.55 * (profile[-1][0] - profile[0][0])))
        recorder.mark_sharp(front)
    return made


def square_off(recorder: Recorder, body: Loft, numbers: Iterable[int], share: float, across: str, size: str) -> None:
    """Draw the diagonal vertices of octagonal sections away from their centers: an oval becomes a rounded box.

    A share of 1.0 keeps the oval, 1.4 puts the vertices into the corners of the box around it, 1.6 sharpens these.
    """
    for number in numbers:
        recorder.scale(Target(body.rings[number][0][1::2], "world"), share, across, size=size)


def trigger_guard(recorder: Recorder, anchor: Target, length: float, height: float, *, along: float = 0.0) -> Component:
    """A flat loop that hangs under its anchor, its upper side sunk into what is above."""
    loop = recorder.base("ring", (length, height, height / 8), sides=8, offset=(along, 0.0, 0.0), anchors=anchor)[0]
    whole = Target((loop.whole,), "world")
    recorder.rotate(whole, 90.0, "u")
    recorder.drag(whole, -height * 0.4)
    recorder.scale(whole, 1.6, "v")
    rims = {edge for face in loop.faces for edge in recorder.edges_of(face)[::2]}  # not those around the strip
    recorder.mark_sharp(*sorted(rims))
    hinge = Target((loop.whole,), "world", (), anchor.elements)
    recorder.scale(hinge, 1.0, "z", size="guard_height")
    recorder.scale(whole, 1.0, "u", size="guard_length")
    return loop


def trigger(recorder: Recorder, anchor: Target, length: float, *, along: float = 0.0) -> Loft:
    """A thin lever that hangs under its anchor and bends forward."""
    return beam(
        recorder,
        "-z",
        [
            Section(-0.3 * length, 0.3 * length, 0.22 * length),
            Section(0.3 * length, 0.3 * length, 0.22 * length, (-0.08 * length, 0.0)),
            Section(0.7 * length, 0.2 * length, 0.22 * length, (0.0, 0.0)),
            Section(length, 0.12 * length, 0.22 * length, (0.2 * length, 0.0)),
        ],
        offset=(along, 0.0, 0.0),
        anchors=anchor,
    )


def post(
    recorder: Recorder,
    anchor: Target,
    size: tuple[float, float, float],
    *,
    along: float = 0.0,
    sink: float = 0.3,
    top: float = 0.6,
) -> Loft:
    """A block on its anchor (sights, mounts): extents along x, y, z; ``top`` is the share of its length at its top."""
    length, width, height = size
    sections = [Section(-sink * height, length, width), Section(height, length * top, width)]
    return beam(recorder, "+z", sections, offset=(along, 0.0, 0.0), anchors=anchor)


def scope(recorder: Recorder, anchor: Target, length: float, diameter: float, height: float) -> list[Loft]:
    """A telescopic sight on two mounts, its middle ``height`` above the anchor and ``SCOPE_PLACE`` before it."""
    half = length / 2
    profile = [
        (-half, 1.35),
        (-0.62 * half, 1.3),
        (-0.5 * half, 0.8),
        (0.3 * half, 0.8),
        (0.62 * half, 1.5),
        (half, 1.55),
    ]
    low, spare = 0.7 * height, 0.3 * height
    body = tube(recorder, anchor, [(place, share * diameter) for place, share in profile], rise=low)
    recorder.scale(body.body(), 1.0, "u", size="scope_length")
    recorder.scale(body.body(), 1.0, "vz", size="scope_diameter")
    mounts = [
        post(recorder, anchor, (0.12 * length, 0.4 * diameter, low), along=side * 0.25 * half, top=0.9)
        for side in (-1.0, 1.0)
    ]
    everything = whole(body, *mounts)
    recorder.drag(everything, rho=SCOPE_PLACE, phi_deg=180.0)
    recorder.drag(everything, rho=SCOPE_PLACE, length="scope_place")
    raised = [body.component.whole, *(vertex for mount in mounts for vertex in mount.rings[1][0])]
    recorder.drag(group(*raised, frame="world"), spare, height="scope_height")
    return [body, *mounts]


def curved_magazine(recorder: Recorder, anchor: Target, length: float, width: float, thickness: float) -> Loft:
    """A magazine that hangs under its anchor and may bend forward; ``width`` is along x."""
    sections = [Section(share * length, width, thickness) for share in (-0.15, 0.25, 0.5, 0.75, 1.0)]
    made = beam(recorder, "-z", sections, anchors=anchor)
    recorder.scale(made.body(hinge=0), 1.0, "z", size="magazine_length")
    recorder.scale(made.body(), 1.0, "u", size="magazine_width")
    for number in (1, 2, 3):
        recorder.rotate(made.beyond(number, hinge=number), -9.0, "v", angle="magazine_curve")
    return made


def drum(recorder: Recorder, anchor: Target, diameter: float, thickness: float) -> Loft:
    """A flat round magazine whose upper rim is sunk into what bears it, flat sides to front and rear."""
    half = thickness / 2
    sections = [Section(place, diameter * ROUND, diameter * ROUND) for place in (-half, half)]
    made = beam(recorder, "+x", sections, sides=8, offset=(0.0, 0.0, -0.42 * diameter), anchors=anchor)
    recorder.scale(Target((made.component.whole,), "world", (), anchor.elements), 1.0, "vz", size="magazine_length")
    recorder.scale(made.body(), 1.0, "u", size="magazine_width")
    return made


def whole(*bodies: Loft | Component) -> Target:
    """Return bodies as one thing to move along the axes of the model."""
    return group(*(c.whole for body in bodies for c in _components(body)), frame="world")


def components(*bodies: Loft | Component) -> list[Component]:
    """Return the components of bodies."""
    return [component for body in bodies for component in _components(body)]


def _components(body: Loft | Component) -> tuple[Component, ...]:
    return body.components if isinstance(body, Loft) else (body,)


def bipod(recorder: Recorder, anchor: Target, length: float) -> Loft:
    """Two legs that hang under an anchor in the middle plane and spread to the sides."""
    anchors = [anchor, Target(anchor.elements, "world", (Mirror("y"),))]
    sections = [Section(-0.04 * length, 0.06 * length, 0.06 * length), Section(length, 0.05 * length, 0.05 * length)]
    legs = beam(recorder, "-z", sections, anchors=anchors)
    recorder.rotate(legs.body(hinge=0), 24.0, "u")
    return legs
