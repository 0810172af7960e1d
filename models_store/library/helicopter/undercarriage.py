"""Parts that the models of helicopters share: skids on struts, and wheels on legs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from models_store.library.aids.beam import at, beam, lower
from models_store.library.aids.loft import Loft, Section, loft
from shapewright.modeling import Component, Condition, Element, Mirror, Recorder, Target, when

WHEEL_SIDES = 8
BAR_SIDES = 6
SKID_CURL_DEG = 30.0


@dataclass(frozen=True)
class Gear:
    """A choice of undercarriages.

    Attributes:
        options: out of "skids", "nose wheel" (and a pair behind it), "tail wheel" (and a pair before it) and "none",
            which is the last.
        height: from the belly to the axles or the bars; ``track`` is how far they lie out from where they are fixed.
        sunk: how far struts reach into the belly.
    """

    options: tuple[str, ...]
    height: float
    track: float
    sunk: float
    skid_length: float = 3.0
    skid_thickness: float = 0.12
    wheel_diameter: float = 0.5
    skid_front: float = 0.6
    height_range: tuple[float, float] = (0.3, 1.8)

    def present(self, *options: str) -> tuple[Condition, ...]:
        """What holds where one of some options, which lie beside each other, is chosen."""
        numbers = [number for number, option in enumerate(self.options, 1) if option in options]
        return (when("gear", numbers[0], numbers[-1]),)

    @property
    def there(self) -> tuple[Condition, ...]:
        """What holds unless there is none."""
        return self.present(*(option for option in self.options if option != "none"))


def corners(recorder: Recorder, body: Loft, section: int) -> tuple[Target, Target]:
    """Return anchors at the left and the right lower edge of a section."""
    left, right = (at(recorder, body, section, (0.0, y, -1.0)) for y in (1.0, -1.0))
    return left, replace(right, image=(Mirror("y"),))


def undercarriage(
    recorder: Recorder, gear: Gear, body: Loft, front: int, rear: int, *, nose: int, tail: int, lengthens: Sequence[str]
) -> None:
    """Model all that a gear may be, below four sections of a body.

    Args:
        lengthens: parameters that move the front and rear sections apart, and make skids longer.
    """
    recorder.choice("gear", "Undercarriage", gear.options)
    recorder.parameter(
        "gear_height",
        "Undercarriage height",
        *gear.height_range,
        base_value=gear.height,
        active_when=gear.there,
        unit="m",
    )
    recorder.parameter(
        "gear_track", "Undercarriage spread", 0.0, 2.2, base_value=gear.track, active_when=gear.there, unit="m"
    )
    pairs = {place: corners(recorder, body, place) for place in (front, rear)}
    if "skids" in gear.options:
        _skids(recorder, gear, pairs[front], pairs[rear], lengthens)
    wheels = [option for option in ("nose wheel", "tail wheel") if option in gear.options]
    if wheels:
        wheeled = gear.present(*wheels)
        recorder.parameter(
            "wheel_diameter", "Wheel diameter", 0.5, 1.9, base_value=gear.wheel_diameter, active_when=wheeled, unit="m"
        )
    for option, pair, single in (("nose wheel", rear, nose), ("tail wheel", front, tail)):
        if option in gear.options:
            middle = lower(recorder, body, single)
            components = [*_wheels(recorder, gear, pairs[pair]), *_wheels(recorder, gear, (middle,))]
            recorder.part(option, components, present_when=gear.present(option))


def _strut(recorder: Recorder, gear: Gear, anchors: Sequence[Target], width: float) -> Loft:
    """Legs downwards from inside the belly; their feet move out with the track."""
    sections = [Section(-gear.sunk, width, width), Section(0.0, width, width), Section(gear.height, width, width)]
    strut = beam(recorder, "-z", sections, anchors=anchors)
    recorder.scale(strut.beyond(1, hinge=1), 1.0, "z", size="gear_height")
    if len(anchors) > 1:
        recorder.drag(strut.sections(2), rho=gear.track, phi_deg=90.0, length="gear_track")
    return strut


def _skids(
    recorder: Recorder,
    gear: Gear,
    front: tuple[Target, Target],
    rear: tuple[Target, Target],
    lengthens: Sequence[str],
) -> None:
    there = gear.present("skids")
    recorder.parameter(
        "skid_length", "Skid length", 0.75, 1.4, base_value=gear.skid_length, active_when=there, unit="m"
    )
    recorder.parameter(
        "skid_thickness", "Skid thickness", 0.5, 3.0, base_value=gear.skid_thickness, active_when=there, unit="m"
    )
    struts = [_strut(recorder, gear, anchors, gear.skid_thickness * 0.9) for anchors in (front, rear)]
    feet = [
        Target(struts[0].rings[2][copy] + struts[1].rings[2][copy], "world", struts[0].images[copy]) for copy in (0, 1)
    ]
    length, wide = gear.skid_length, gear.skid_thickness
    places = (-0.5, -0.1, 0.3, 0.42, 0.55)
    bars = loft(
        recorder,
        "x",
        [Section(place * length, wide, wide) for place in places],
        sides=BAR_SIDES,
        offset=(gear.skid_front - 0.1 * length, 0.0, 0.0),
        anchors=feet,
    )
    recorder.mark_sharp(*(end for component in bars.components for end in (component.bottom, component.top)))
    recorder.scale(bars.sections(*range(len(places))), 1.0, "vz", size="skid_thickness")
    for name in ("skid_length", *lengthens):
        recorder.scale(bars.body(), 1.0, "u", size=name)
    for joint in (2, 3):
        recorder.rotate(bars.beyond(joint + 1, hinge=joint), -SKID_CURL_DEG / 2, "v")
    recorder.part("skids", [c for made in (*struts, bars) for c in made.components], present_when=there)


def _wheels(recorder: Recorder, gear: Gear, anchors: Sequence[Target]) -> list[Component | Element]:
    """A leg with a wheel for each anchor."""
    leg = _strut(recorder, gear, anchors, gear.wheel_diameter * 0.3)
    width = gear.wheel_diameter * 0.35
    hubs = [Target(ring, "world", image) for ring, image in zip(leg.rings[2], leg.images, strict=True)]
    sections = [
        Section(y * width, gear.wheel_diameter * d, gear.wheel_diameter * d) for y, d in ((-0.5, 0.9), (0.5, 0.9))
    ]
    wheel = loft(recorder, "y", sections, sides=WHEEL_SIDES, anchors=hubs)
    recorder.mark_sharp(*(end for component in wheel.components for end in (component.bottom, component.top)))
    recorder.scale(wheel.body(), 1.0, size="wheel_diameter")
    return [*leg.components, *wheel.components]
