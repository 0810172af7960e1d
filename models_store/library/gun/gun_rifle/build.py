"""Models a rifle or carbine with a wooden stock.

The stock runs from the wrist (x = 0) back to the butt and forward to the end of the fore-end; receiver and barrel lie
on it. The butt is sketched straight and then dropped.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import (
    SCOPE_PLACE,
    bipod,
    components,
    curved_magazine,
    drum,
    post,
    scope,
    trigger,
    trigger_guard,
    tube,
    whole,
)
from shapewright.modeling import Component, ProceduralModel, Recorder, when

BUTT_LENGTH, BUTT_HEIGHT, BUTT_DROP_DEG = 0.36, 0.115, 5.0
FORE_LENGTH, FORE_HEIGHT, STOCK_WIDTH = 0.45, 0.046, 0.040
RECEIVER_LENGTH, RECEIVER_DIAMETER = 0.20, 0.032
BARREL_LENGTH, BARREL_DIAMETER = 0.52, 0.018
JACKET_LENGTH = 0.30
MAGAZINE_PLACE, WRIST_SWELL = 0.03, 0.012
BOX, CURVED, DRUM = 2, 3, 4


def build() -> ProceduralModel:
    """Model the rifle."""
    recorder = Recorder("gun_rifle", "gun", unit_m=1.0, description="A rifle or carbine with a one-piece stock.")
    _declare(recorder)
    fore = _fore_end(recorder)
    butt = _butt(recorder, fore)
    receiver = _receiver(recorder, fore)
    barrel, *on_barrel = _barrel(recorder, receiver)
    magazines = _magazines(recorder, fore)
    details = _details(recorder, fore, receiver)
    handle = _bolt(recorder, receiver)
    bodies = (fore, butt, receiver, barrel, *on_barrel, *magazines, *details, handle)
    recorder.scale(whole(*bodies), 1.0, "v", pivot=receiver.component.whole, size="thickness")
    recorder.symmetry(mirrors=("y",), apart=components(handle))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    magazine = (when("magazine", BOX, DRUM),)
    scoped = (when("scope", 2),)
    recorder.choice("magazine", "Magazine", ("inside", "box", "curved", "drum"))
    recorder.choice("scope", "Scope", ("without", "with"))
    recorder.choice("bolt", "Bolt handle", ("with", "without"))
    recorder.choice("sights", "Sights", ("with", "without"))
    recorder.choice("jacket", "Barrel jacket", ("without", "with"))
    recorder.choice("bipod", "Bipod", ("without", "with"))
    recorder.parameter("butt_length", "Butt length", 0.6, 1.3, unit="m", base_value=BUTT_LENGTH)
    recorder.parameter("butt_height", "Butt height", 0.6, 1.4, unit="m", base_value=BUTT_HEIGHT)
    recorder.parameter("butt_drop", "Drop of the butt (deg)", 0.0, 2.8, base_value=BUTT_DROP_DEG, kind="angle")
    recorder.parameter("wrist_height", "Wrist height", 0.7, 1.4, unit="m", base_value=0.044)
    recorder.parameter("wrist_swell", "Swell below the wrist", 0.3, 4.0, unit="m", base_value=WRIST_SWELL)
    recorder.parameter("barrel_length", "Barrel length", 0.45, 1.7, unit="m", base_value=BARREL_LENGTH)
    recorder.parameter("fore_length", "Fore-end length", 0.5, 1.5, unit="m", base_value=FORE_LENGTH)
    recorder.parameter("fore_height", "Stock height at the fore-end", 0.7, 1.6, unit="m", base_value=FORE_HEIGHT)
    recorder.parameter("receiver_length", "Receiver length", 0.7, 1.5, unit="m", base_value=RECEIVER_LENGTH)
    recorder.parameter("receiver_height", "Receiver height", 0.8, 1.5, unit="m", base_value=RECEIVER_DIAMETER)
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 1.8, unit="m", base_value=BARREL_DIAMETER)
    recorder.limit("fore_length", maximum=("barrel_length", 0.2, 1.15))
    recorder.parameter("muzzle", "Muzzle diameter (share of the barrel)", 0.9, 1.6, base_value=1.0)
    recorder.parameter(
        "jacket_length", "Jacket length", 0.5, 1.6, unit="m", base_value=JACKET_LENGTH, active_when=(when("jacket", 2),)
    )
    recorder.parameter(
        "magazine_length", "Magazine length or diameter", 0.5, 1.5, unit="m", base_value=0.15, active_when=magazine
    )
    recorder.parameter(
        "magazine_place", "Place of the magazine", -1.0, 3.0, unit="m", base_value=MAGAZINE_PLACE, active_when=magazine
    )
    recorder.parameter("magazine_width", "Magazine width", 0.6, 1.5, unit="m", base_value=0.045, active_when=magazine)
    recorder.parameter("magazine_curve", "Magazine curve", 0.3, 2.4, active_when=(when("magazine", CURVED),))
    recorder.parameter(
        "scope_place", "Place of the scope", -1.0, 3.0, unit="m", base_value=SCOPE_PLACE, active_when=scoped
    )
    recorder.parameter("scope_length", "Scope length", 0.6, 1.4, unit="m", base_value=0.26, active_when=scoped)
    recorder.parameter("scope_diameter", "Scope diameter", 0.7, 1.5, unit="m", base_value=0.030, active_when=scoped)
    recorder.parameter("scope_height", "Scope height", 0.0, 2.0, active_when=scoped, kind="length")
    recorder.parameter("guard_length", "Trigger guard length", 0.75, 1.5, kind="length")
    recorder.parameter("guard_height", "Trigger guard height", 0.7, 1.3, kind="length")
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.6, kind="length")


def _fore_end(recorder: Recorder) -> Loft:
    """Rings: wrist, behind and before the trigger, before the magazine, the end."""
    places = ((-0.010, 0.85), (0.020, 1.0), (0.090, 1.05), (0.170, 1.0), (0.21, 0.95))
    sections = [Section(place, STOCK_WIDTH, FORE_HEIGHT * share) for place, share in places]
    fore = beam(recorder, "+x", sections, offset=(0.0, 0.0, -0.5 * FORE_HEIGHT))
    end = fore.sections(4)
    recorder.scale(end, 0.85, "v")
    recorder.scale(end, 0.8, "z")
    recorder.scale(fore.body(), 1.0, "z", size="fore_height")
    recorder.drag(end, rho=FORE_LENGTH - 0.21, length="fore_length")
    return fore


def _butt(recorder: Recorder, fore: Loft) -> Loft:
    profile = ((-0.03, 0.9, 0.36, 0.0), (0.05, 0.8, 0.34, -0.004), (0.13, 0.9, 0.5, -0.014), (0.36, 1.0, 1.0, -0.030))
    sections = [
        Section(place, STOCK_WIDTH * width, BUTT_HEIGHT * height, (0.0, drop)) for place, width, height, drop in profile
    ]
    butt = beam(recorder, "-x", sections, anchors=at(recorder, fore, 0))
    recorder.scale(butt.body(hinge=0), 1.0, "u", size="butt_length")
    recorder.scale(butt.sections(2, 3), 1.0, "z", size="butt_height")
    recorder.scale(butt.sections(1), 1.0, "z", size="wrist_height")
    underside = lower(recorder, butt, 1)
    recorder.drag(underside, WRIST_SWELL)
    recorder.drag(underside, -WRIST_SWELL, height="wrist_swell")
    recorder.rotate(butt.beyond(1, hinge=1), -BUTT_DROP_DEG, "v", angle="butt_drop")
    recorder.rotate(butt.beyond(2, hinge=2), BUTT_DROP_DEG / 2, "v", angle="butt_drop")
    return butt


def _receiver(recorder: Recorder, fore: Loft) -> Loft:
    length, diameter = RECEIVER_LENGTH, RECEIVER_DIAMETER * 1.1
    sections = [
        Section(0.0, 0.8 * diameter, 0.7 * diameter, (0.0, -0.004)),
        Section(0.2 * length, diameter, diameter),
        Section(0.6 * length, diameter, diameter),
        Section(length, diameter, diameter * 0.95),
    ]
    anchor = upper(recorder, fore, 1)
    receiver = beam(recorder, "+x", sections, sides=8, offset=(-0.03, 0.0, -0.001), anchors=anchor)
    recorder.scale(receiver.body(hinge=0), 1.0, "u", size="receiver_length")
    recorder.scale(receiver.body(), 1.0, "z", size="receiver_height")
    return receiver


def _barrel(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """The barrel, its jacket, the front sight."""
    front = at(recorder, receiver, 3)
    profile = [(-0.02, 1.3), (0.03, 1.3), (0.10, 1.05), (0.95, 0.9), (0.951, 0.95), (1.0, 0.95)]
    barrel = tube(recorder, front, [(p * BARREL_LENGTH, d * BARREL_DIAMETER) for p, d in profile], bore=0.5)
    recorder.scale(barrel.body(hinge=0), 1.0, "u", size="barrel_length")
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    recorder.scale(barrel.sections(4, 5), 1.0, "vz", size="muzzle")
    wide = 1.9 * BARREL_DIAMETER
    jacket = tube(recorder, front, [(-0.01, wide), (0.9 * JACKET_LENGTH, wide), (JACKET_LENGTH, 0.8 * wide)])
    recorder.scale(jacket.body(hinge=0), 1.0, "u", size="jacket_length")
    recorder.scale(jacket.body(), 1.0, "vz", size="barrel_diameter")
    sight = post(recorder, upper(recorder, barrel, 3, 4), (0.020, 0.004, 0.020), sink=0.5, top=0.35)
    recorder.part("jacket", components(jacket), present_when=(when("jacket", 2),))
    recorder.part("front sight", components(sight), present_when=(when("sights", 1),))
    return [barrel, jacket, sight]


def _magazines(recorder: Recorder, fore: Loft) -> list[Loft]:
    anchor = lower(recorder, fore, 2, 3)
    sections = [Section(-0.02, 0.045, 0.024), Section(0.12, 0.045, 0.024)]
    box = beam(recorder, "-z", sections, crease="all", anchors=anchor)
    recorder.scale(box.body(hinge=0), 1.0, "z", size="magazine_length")
    recorder.scale(box.body(), 1.0, "u", size="magazine_width")
    curved = curved_magazine(recorder, anchor, 0.17, 0.038, 0.024)
    pan = drum(recorder, anchor, 0.15, 0.05)
    everything = whole(box, curved, pan)
    recorder.drag(everything, rho=MAGAZINE_PLACE, phi_deg=180.0)
    recorder.drag(everything, rho=MAGAZINE_PLACE, length="magazine_place")
    for number, name, body in ((BOX, "box", box), (CURVED, "curved", curved), (DRUM, "drum", pan)):
        recorder.part(f"{name} magazine", components(body), present_when=(when("magazine", number),))
    return [box, curved, pan]


def _details(recorder: Recorder, fore: Loft, receiver: Loft) -> list[Loft | Component]:
    below = lower(recorder, fore, 1, 2)
    guard = trigger_guard(recorder, below, 0.075, 0.045, along=-0.012)
    lever = trigger(recorder, below, 0.028, along=-0.016)
    glass = scope(recorder, upper(recorder, receiver, 1, 2), 0.26, 0.030, 0.045)
    rear = post(recorder, upper(recorder, receiver, 3), (0.020, 0.012, 0.012), along=-0.02, sink=0.6, top=0.4)
    legs = bipod(recorder, lower(recorder, fore, 4), 0.20)
    recorder.part("scope", components(*glass), present_when=(when("scope", 2),))
    recorder.part("rear sight", components(rear), present_when=(when("sights", 1),))
    recorder.part("bipod", components(legs), present_when=(when("bipod", 2),))
    return [guard, lever, *glass, rear, legs]


def _bolt(recorder: Recorder, receiver: Loft) -> Loft:
    """The handle on the right side, which no mirror image has."""
    side = at(recorder, receiver, 2, (0.0, -1.0, 0.0))
    sections = [
        Section(-0.008, 0.010, 0.010),
        Section(0.035, 0.009, 0.009),
        Section(0.04, 0.018, 0.018),
        Section(0.056, 0.018, 0.018),
    ]
    handle = beam(recorder, "-y", sections, sides=8, offset=(-0.03, 0.0, 0.0), anchors=side)
    recorder.rotate(handle.body(hinge=0), 30.0, "u")
    recorder.part("bolt handle", components(handle), present_when=(when("bolt", 1),))
    return handle


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
