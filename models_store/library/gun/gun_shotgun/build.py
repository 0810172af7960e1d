"""Models a shotgun: a pump gun with its magazine tube under the barrel, or a double barrel, with a stock or a grip.

The receiver begins at x = 0. The barrels are sketched one for each kind, at the same length.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import (
    SCOPE_PLACE,
    components,
    post,
    scope,
    trigger,
    trigger_guard,
    tube,
    whole,
)
from shapewright.modeling import Component, Mirror, ProceduralModel, Recorder, Target, when

RECEIVER_LENGTH, RECEIVER_HEIGHT, RECEIVER_WIDTH = 0.20, 0.060, 0.040
BARREL_LENGTH, BARREL_DIAMETER = 0.55, 0.024
TUBE_LENGTH = 0.45
PUMP_LENGTH, PUMP_DIAMETER, PUMP_PLACE = 0.20, 0.046, 0.08
STOCK_LENGTH, STOCK_HEIGHT, STOCK_DROP_DEG = 0.34, 0.12, 7.0
GRIP_LENGTH, GRIP_RAKE_DEG = 0.13, 42.0
PUMP, OVER_UNDER, SIDE_BY_SIDE = 1, 2, 3


def build() -> ProceduralModel:
    """Model the shotgun."""
    recorder = Recorder("gun_shotgun", "gun", unit_m=1.0, description="A pump gun or a double-barrelled shotgun.")
    _declare(recorder)
    receiver = _receiver(recorder)
    barrels = _barrels(recorder, receiver)
    fore = _fore_ends(recorder, receiver)
    rear = _stocks(recorder, receiver)
    details = _details(recorder, receiver)
    recorder.scale(whole(receiver, *barrels, *fore, *rear, *details), 1.0, "v", size="thickness")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    pump, scoped = (when("barrels", PUMP),), (when("scope", 2),)
    recorder.choice("barrels", "Barrels", ("over a magazine tube", "over and under", "side by side"))
    recorder.choice("rear", "Stock", ("stock", "pistol grip"))
    recorder.choice("guard", "Trigger guard", ("with", "without"))
    recorder.choice("scope", "Scope", ("without", "with"))
    recorder.parameter("receiver_length", "Receiver length", 0.5, 1.5, unit="m", base_value=RECEIVER_LENGTH)
    recorder.parameter("receiver_height", "Receiver height", 0.7, 1.6, unit="m", base_value=RECEIVER_HEIGHT)
    recorder.parameter("barrel_length", "Barrel length", 0.5, 1.5, unit="m", base_value=BARREL_LENGTH)
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 1.6, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter(
        "tube_length", "Magazine tube length (share of the barrel)", 0.5, 1.2, base_value=0.82, active_when=pump
    )
    recorder.parameter("fore_length", "Fore-end length", 0.6, 1.8, unit="m", base_value=PUMP_LENGTH)
    recorder.limit("fore_length", maximum=("barrel_length", 0.1, 1.6))
    recorder.parameter("fore_diameter", "Fore-end diameter", 0.75, 1.7, unit="m", base_value=PUMP_DIAMETER)
    recorder.parameter(
        "fore_place", "Place of the fore-end", 0.0, 3.0, unit="m", base_value=PUMP_PLACE, active_when=pump
    )
    recorder.limit("fore_place", maximum=("barrel_length", -0.9, 2.2))
    recorder.parameter(
        "stock_length", "Stock length", 0.6, 1.3, unit="m", base_value=STOCK_LENGTH, active_when=(when("rear", 1),)
    )
    recorder.parameter(
        "stock_height", "Stock height", 0.6, 1.4, unit="m", base_value=STOCK_HEIGHT, active_when=(when("rear", 1),)
    )
    recorder.parameter(
        "stock_drop",
        "Drop of the stock (deg)",
        0.0,
        2.2,
        base_value=STOCK_DROP_DEG,
        active_when=(when("rear", 1),),
        kind="angle",
    )
    recorder.parameter(
        "grip_length", "Grip length", 0.7, 1.8, unit="m", base_value=GRIP_LENGTH, active_when=(when("rear", 2),)
    )
    recorder.parameter("grip_depth", "Grip depth", 0.6, 1.5, unit="m", base_value=0.04, active_when=(when("rear", 2),))
    recorder.parameter(
        "grip_rake", "Grip rake (deg)", 0.3, 1.6, base_value=GRIP_RAKE_DEG, active_when=(when("rear", 2),), kind="angle"
    )
    recorder.parameter(
        "grip_bend", "Grip bend (deg)", -1.0, 3.0, base_value=8.0, active_when=(when("rear", 2),), kind="angle"
    )
    recorder.parameter(
        "guard_length", "Trigger guard length", 0.75, 1.4, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter(
        "guard_height", "Trigger guard height", 0.75, 1.3, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter(
        "scope_place", "Place of the scope", -1.0, 3.0, unit="m", base_value=SCOPE_PLACE, active_when=scoped
    )
    recorder.parameter("scope_length", "Scope length", 0.5, 1.3, unit="m", base_value=0.22, active_when=scoped)
    recorder.parameter("scope_diameter", "Scope diameter", 0.8, 1.6, unit="m", base_value=0.030, active_when=scoped)
    recorder.parameter("scope_height", "Scope height", 0.0, 1.6, active_when=scoped, kind="length")
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.6, kind="length")


def _receiver(recorder: Recorder) -> Loft:
    places = ((0.0, 0.75), (0.25, 1.0), (0.6, 1.0), (1.0, 1.0))
    sections = [Section(p * RECEIVER_LENGTH, RECEIVER_WIDTH, RECEIVER_HEIGHT * share) for p, share in places]
    receiver = beam(recorder, "+x", sections)
    recorder.scale(receiver.body(hinge=0), 1.0, "u", size="receiver_length")
    recorder.scale(receiver.body(), 1.0, "z", size="receiver_height")
    return receiver


def _barrels(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """The upper barrel (over the tube or under barrel), the tube, the under barrel, the pair."""
    front = at(recorder, receiver, 3)
    step = 0.55 * BARREL_DIAMETER
    profile = [(-0.03, BARREL_DIAMETER), (BARREL_LENGTH, BARREL_DIAMETER)]
    over = tube(recorder, front, profile, rise=step, bore=0.7)
    under = tube(recorder, front, profile, rise=-step, bore=0.7)
    magazine = tube(recorder, front, [(-0.03, 0.024), (TUBE_LENGTH - 0.02, 0.024), (TUBE_LENGTH, 0.026)], rise=-step)
    sections = [Section(place, diameter * 1.1, diameter * 1.1) for place, diameter in profile]
    sides = [front, Target(front.elements, "world", (Mirror("y"),))]
    two = beam(recorder, "+x", sections, sides=8, offset=(0.0, step, 0.1 * RECEIVER_HEIGHT), anchors=sides)
    for body in (over, under, magazine, two):
        recorder.scale(body.body(hinge=0), 1.0, "u", size="barrel_length")
        recorder.scale(body.body(), 1.0, "vz", size="barrel_diameter")
    recorder.scale(magazine.body(hinge=0), 1.0, "u", size="tube_length")
    bead = post(recorder, upper(recorder, over, 1), (0.012, 0.005, 0.010), along=-0.015, sink=1.0)
    recorder.part("upper barrel", components(over, bead), present_when=(when("barrels", PUMP, OVER_UNDER),))
    recorder.part("under barrel", components(under), present_when=(when("barrels", OVER_UNDER),))
    recorder.part("magazine tube", components(magazine), present_when=(when("barrels", PUMP),))
    recorder.part("barrels side by side", components(two), present_when=(when("barrels", SIDE_BY_SIDE),))
    return [over, under, magazine, two, bead]


def _fore_ends(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """The pump around the tube, and the fixed wooden one under two barrels."""
    front = at(recorder, receiver, 3)
    length, wide = PUMP_LENGTH, PUMP_DIAMETER
    profile = [(0.0, 0.8 * wide), (0.03, wide), (length - 0.03, wide), (length, 0.8 * wide)]
    pump = tube(recorder, front, profile, rise=-0.55 * BARREL_DIAMETER)
    sections = [Section(-0.02, 1.2 * wide, 0.9 * wide), Section(length, 0.9 * wide, 0.5 * wide, (0.0, 0.004))]
    wood = beam(recorder, "+x", sections, sides=8, offset=(0.0, 0.0, -0.3 * RECEIVER_HEIGHT), anchors=front)
    for body in (pump, wood):
        recorder.scale(body.body(hinge=0), 1.0, "u", size="fore_length")
        recorder.scale(body.body(), 1.0, "vz", size="fore_diameter")
    recorder.drag(pump.body(), rho=PUMP_PLACE, length="fore_place")
    recorder.part("pump", components(pump), present_when=(when("barrels", PUMP),))
    recorder.part("fixed fore-end", components(wood), present_when=(when("barrels", OVER_UNDER, SIDE_BY_SIDE),))
    return [pump, wood]


def _stocks(recorder: Recorder, receiver: Loft) -> list[Loft]:
    rear = at(recorder, receiver, 0)
    profile = ((-0.02, 0.9, 0.36, 0.0), (0.05, 0.85, 0.33, -0.002), (0.13, 0.9, 0.52, -0.012), (0.34, 1.0, 1.0, -0.02))
    sections = [
        Section(place, RECEIVER_WIDTH * width, STOCK_HEIGHT * height, (0.0, drop))
        for place, width, height, drop in profile
    ]
    stock = beam(recorder, "-x", sections, anchors=rear)
    recorder.scale(stock.body(hinge=0), 1.0, "u", size="stock_length")
    recorder.scale(stock.sections(2, 3), 1.0, "z", size="stock_height")
    recorder.rotate(stock.beyond(1, hinge=1), -STOCK_DROP_DEG, "v", angle="stock_drop")
    recorder.rotate(stock.beyond(2, hinge=2), STOCK_DROP_DEG / 2, "v", angle="stock_drop")
    depth, width = 0.044, 0.038
    shape = ((-0.2, 1.0), (0.15, 1.0), (0.4, 0.9), (0.7, 1.05), (0.9, 1.1), (1.0, 0.8))
    sections = [Section(place * GRIP_LENGTH, depth * share, width * min(share, 1.0)) for place, share in shape]
    grip = beam(recorder, "-z", sections, sides=8, offset=(0.008, 0.0, 0.0), anchors=rear)
    recorder.scale(grip.body(hinge=0), 1.0, "z", size="grip_length")
    recorder.scale(grip.body(), 1.0, "u", size="grip_depth")
    for number in (1, 2):
        recorder.rotate(grip.beyond(number, hinge=number), -8.0, "v", angle="grip_bend")
    recorder.rotate(grip.body(hinge=0), GRIP_RAKE_DEG, "v", angle="grip_rake")
    recorder.part("stock", components(stock), present_when=(when("rear", 1),))
    recorder.part("pistol grip", components(grip), present_when=(when("rear", 2),))
    return [stock, grip]


def _details(recorder: Recorder, receiver: Loft) -> list[Loft | Component]:
    below = lower(recorder, receiver, 1)
    guard = trigger_guard(recorder, below, 0.078, 0.046, along=0.005)
    lever = trigger(recorder, below, 0.030)
    glass = scope(recorder, upper(recorder, receiver, 1, 2), 0.22, 0.030, 0.045)
    recorder.part("trigger guard", components(guard), present_when=(when("guard", 1),))
    recorder.part("scope", components(*glass), present_when=(when("scope", 2),))
    return [guard, lever, *glass]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
