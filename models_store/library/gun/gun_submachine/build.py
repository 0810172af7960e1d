"""Models a submachine gun or assault rifle: a receiver with pistol grip, magazine, handguard and one of several stocks.

The receiver begins at x = 0; everything hangs on one of its sections. Alternatives (stocks, magazines, what is mounted
above and below) are parts that choices select.
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
from shapewright.modeling import Element, ProceduralModel, Recorder, Target, when

RECEIVER_LENGTH, RECEIVER_HEIGHT, WIDTH = 0.24, 0.062, 0.042
GUARD_LENGTH, HANDGUARD_HEIGHT = 0.20, 0.052
BARREL_LENGTH, BARREL_DIAMETER = 0.20, 0.017
GRIP_LENGTH, GRIP_PLACE, GRIP_RAKE_DEG = 0.105, 0.040, 20.0
MAGAZINE_PLACE = 0.035
STOCK_LENGTH, STOCK_HEIGHT, STOCK_DROP_DEG = 0.26, 0.115, 2.0
SOLID, SKELETON, FOLDING, NO_STOCK = 1, 2, 3, 4
SCOPE, SCOPE_ON_HANDLE, HANDLE = 2, 3, 4
FRONT_GRIP, LAUNCHER, BIPOD = 2, 3, 4


def build() -> ProceduralModel:
    """Model the gun."""
    recorder = Recorder("gun_submachine", "gun", unit_m=1.0, description="A submachine gun or assault rifle.")
    _declare(recorder)
    receiver = _receiver(recorder)
    handguard, barrel, *before = _front(recorder, receiver)
    grip = _grip(recorder, receiver)
    magazines = _magazines(recorder, receiver)
    stocks = _stocks(recorder, receiver)
    above = _above(recorder, receiver)
    below = _below(recorder, handguard)
    anchor = lower(recorder, receiver, 1, 2)
    guard = trigger_guard(recorder, anchor, 0.066, 0.046)
    lever = trigger(recorder, anchor, 0.030, along=-0.004)
    bodies = whole(receiver, handguard, barrel, *before, grip, *magazines, *stocks, *above, *below, guard, lever)
    recorder.scale(bodies, 1.0, "v", size="thickness")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    stocked = (when("stock", SOLID, FOLDING),)
    scoped = (when("above", SCOPE, SCOPE_ON_HANDLE),)
    below = (when("below", FRONT_GRIP, BIPOD),)
    recorder.choice("magazine", "Magazine", ("straight or curved", "drum"))
    recorder.choice("stock", "Stock", ("solid", "skeleton", "folding", "without"))
    recorder.choice("above", "On the receiver", ("sight", "scope", "scope on a carrying handle", "carrying handle"))
    recorder.choice("below", "Under the handguard", ("nothing", "front grip", "grenade launcher", "bipod"))
    recorder.choice("gas_tube", "Gas tube above the barrel", ("with", "without"))
    recorder.choice("front_sight", "Front sight", ("with", "without"))
    recorder.parameter("receiver_length", "Receiver length", 0.75, 1.6, unit="m", base_value=RECEIVER_LENGTH)
    recorder.parameter("receiver_height", "Receiver height", 0.7, 1.7, unit="m", base_value=RECEIVER_HEIGHT)
    recorder.parameter("handguard_length", "Handguard length", 0.25, 1.7, unit="m", base_value=GUARD_LENGTH)
    recorder.parameter("handguard_height", "Handguard height", 0.6, 1.7, unit="m", base_value=HANDGUARD_HEIGHT)
    recorder.parameter("handguard_taper", "Handguard height at its front (share)", 0.6, 1.1, base_value=0.9)
    recorder.parameter(
        "barrel_length", "Barrel length before the handguard", 0.2, 1.9, unit="m", base_value=BARREL_LENGTH
    )
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 2.0, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter("muzzle", "Muzzle diameter (share of the barrel)", 0.7, 1.5, base_value=1.3)
    recorder.parameter(
        "sight_height",
        "Front sight height",
        0.5,
        1.4,
        unit="m",
        base_value=0.036,
        active_when=(when("front_sight", 1),),
    )
    recorder.parameter("grip_length", "Grip length", 0.7, 1.3, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_depth", "Grip depth", 0.7, 1.4, unit="m", base_value=0.038)
    recorder.parameter("grip_width", "Grip width", 0.6, 1.5, unit="m", base_value=0.032)
    recorder.parameter("grip_place", "Place of grip and trigger", 0.4, 2.2, unit="m", base_value=GRIP_PLACE)
    recorder.parameter("grip_rake", "Grip rake (deg)", 0.0, 2.0, base_value=GRIP_RAKE_DEG, kind="angle")
    recorder.parameter("magazine_length", "Magazine length or diameter", 0.5, 1.4, unit="m", base_value=0.17)
    recorder.parameter("magazine_width", "Magazine width", 0.6, 1.5, unit="m", base_value=0.055)
    recorder.parameter("magazine_curve", "Magazine curve", 0.0, 2.0, active_when=(when("magazine", 1),))
    recorder.parameter(
        "magazine_rake",
        "Magazine rake forward (deg)",
        -0.5,
        2.5,
        base_value=8.0,
        active_when=(when("magazine", 1),),
        kind="angle",
    )
    recorder.parameter("magazine_place", "Place of the magazine", -0.3, 2.0, unit="m", base_value=MAGAZINE_PLACE)
    recorder.limit("magazine_place", maximum=("receiver_length", -1.0, 2.4))
    recorder.parameter("stock_length", "Stock length", 0.4, 1.4, unit="m", base_value=STOCK_LENGTH, active_when=stocked)
    recorder.parameter("stock_height", "Stock height", 0.6, 1.4, unit="m", base_value=STOCK_HEIGHT, active_when=stocked)
    recorder.parameter(
        "stock_front",
        "Height of the solid stock's front (share of its butt)",
        0.5,
        1.8,
        base_value=0.5,
        active_when=(when("stock", SOLID),),
    )
    recorder.parameter(
        "plate_length",
        "Length of the butt plate",
        0.7,
        6.0,
        unit="m",
        base_value=0.024,
        active_when=(when("stock", SKELETON, FOLDING),),
    )
    recorder.parameter(
        "stock_drop", "Drop of the stock (deg)", -1.0, 5.0, base_value=STOCK_DROP_DEG, active_when=stocked, kind="angle"
    )
    recorder.parameter(
        "handle_length",
        "Length of the carrying handle",
        0.7,
        1.4,
        unit="m",
        base_value=0.14,
        active_when=(when("above", SCOPE_ON_HANDLE, HANDLE),),
    )
    recorder.parameter(
        "scope_place", "Place of the scope", -0.8, 2.5, unit="m", base_value=SCOPE_PLACE, active_when=scoped
    )
    recorder.parameter("scope_length", "Scope length", 0.5, 1.5, unit="m", base_value=0.22, active_when=scoped)
    recorder.parameter("scope_diameter", "Scope diameter", 0.8, 1.5, unit="m", base_value=0.032, active_when=scoped)
    recorder.parameter("scope_height", "Scope height", 0.0, 1.6, active_when=scoped, kind="length")
    recorder.parameter(
        "below_length", "Length of what is under the handguard", 0.6, 1.4, active_when=below, kind="length"
    )
    recorder.parameter("guard_length", "Trigger guard length", 0.75, 1.3, kind="length")
    recorder.parameter("guard_height", "Trigger guard height", 0.75, 1.3, kind="length")
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.5, kind="length")


def _receiver(recorder: Recorder) -> Loft:
    """Rings: rear, grip, magazine, front."""
    places = ((0.0, 0.75, 0.004), (0.015, 1.0, 0.0), (0.105, 1.0, 0.0), (RECEIVER_LENGTH, 0.95, 0.0))
    sections = [Section(place, WIDTH, RECEIVER_HEIGHT * share, (0.0, shift)) for place, share, shift in places]
    receiver = beam(recorder, "+x", sections, crease="all")
    recorder.drag([*receiver.sections(1), *receiver.sections(2)], rho=GRIP_PLACE, length="grip_place")
    recorder.scale(receiver.body(hinge=0), 1.0, "u", size="receiver_length")
    recorder.scale(receiver.body(), 1.0, "z", size="receiver_height")
    return receiver


def _front(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """Handguard, barrel with its muzzle, gas tube, front sight."""
    height = HANDGUARD_HEIGHT * 1.1
    sections = [
        Section(-0.02, 0.9 * WIDTH, 0.9 * height),
        Section(0.01, WIDTH, height),
        Section(0.9 * GUARD_LENGTH, WIDTH, height),
        Section(GUARD_LENGTH, 0.9 * WIDTH, 0.95 * height),
    ]
    handguard = beam(recorder, "+x", sections, sides=8, anchors=at(recorder, receiver, 3))
    recorder.scale(handguard.body(hinge=0), 1.0, "u", size="handguard_length")
    recorder.scale(handguard.body(), 1.0, "z", size="handguard_height")
    recorder.scale(handguard.sections(2, 3), 0.9, "z", size="handguard_taper")
    front = at(recorder, handguard, 3)
    profile = [(-0.15, 1.0), (0.35, 1.0), (0.55, 1.0), (0.78, 1.0), (0.8, 1.0), (1.0, 1.0)]
    barrel = tube(recorder, front, [(p * BARREL_LENGTH, d * BARREL_DIAMETER) for p, d in profile], bore=0.5)
    recorder.scale(barrel.body(hinge=0), 1.0, "u", size="barrel_length")
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    recorder.scale(barrel.sections(4, 5), 1.3, "vz", size="muzzle")
    gas = tube(recorder, upper(recorder, handguard, 3), [(-0.04, 0.016), (0.45 * BARREL_LENGTH, 0.014)], rise=-0.009)
    recorder.scale(gas.body(hinge=0), 1.0, "u", size="barrel_length")
    sight = post(recorder, upper(recorder, barrel, 1, 2), (0.034, 0.008, 0.036), sink=0.3, top=0.3)
    recorder.scale(sight.body(hinge=0), 1.0, "z", size="sight_height")
    recorder.part("gas tube", components(gas), present_when=(when("gas_tube", 1),))
    recorder.part("front sight", components(sight), present_when=(when("front_sight", 1),))
    return [handguard, barrel, gas, sight]


def _grip(recorder: Recorder, receiver: Loft) -> Loft:
    profile = ((-0.2, 1.1), (0.1, 1.0), (0.5, 0.9), (1.0, 1.1))
    sections = [Section(place * GRIP_LENGTH, 0.038 * share, 0.032) for place, share in profile]
    grip = beam(recorder, "-z", sections, anchors=lower(recorder, receiver, 1))
    recorder.scale(grip.body(hinge=0), 1.0, "z", size="grip_length")
    recorder.scale(grip.body(), 1.0, "u", size="grip_depth")
    recorder.scale(grip.body(), 1.0, "v", size="grip_width")
    recorder.rotate(grip.body(hinge=0), GRIP_RAKE_DEG, "v", angle="grip_rake")
    return grip


def _magazines(recorder: Recorder, receiver: Loft) -> list[Loft]:
    anchor = lower(recorder, receiver, 2)
    long = curved_magazine(recorder, anchor, 0.17, 0.055, 0.026)
    recorder.rotate(long.body(hinge=0), -8.0, "v", angle="magazine_rake")
    pan = drum(recorder, anchor, 0.15, 0.055)
    recorder.drag([*long.body(), *pan.body()], rho=MAGAZINE_PLACE, length="magazine_place")
    recorder.part("long magazine", components(long), present_when=(when("magazine", 1),))
    recorder.part("drum magazine", components(pan), present_when=(when("magazine", 2),))
    return [long, pan]


def _stocks(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """A solid wedge; an open triangle of bars; a thin bar with a plate. All turn about the receiver's rear."""
    rear = at(recorder, receiver, 0)
    length, height, width = STOCK_LENGTH, STOCK_HEIGHT, 0.9 * WIDTH
    sections = [
        Section(-0.02, width, 0.72 * height),
        Section(0.25 * length, width, height, (0.0, -0.006)),
        Section(length, width, height, (0.0, -0.030)),
    ]
    solid = beam(recorder, "-x", sections, crease="all", anchors=rear)
    recorder.scale(solid.sections(0, 1), 0.5, "z", size="stock_front")
    bar = [Section(-0.02, 0.4 * width, 0.18 * height), Section(length, 0.4 * width, 0.16 * height)]
    top = beam(recorder, "-x", bar, crease="all", offset=(0.0, 0.0, 0.006), anchors=rear)
    strut = beam(recorder, "-x", bar, crease="all", offset=(0.0, 0.0, 0.002), anchors=rear)
    plate = beam(
        recorder,
        "-z",
        [Section(-0.25 * height, 0.022, 0.8 * width), Section(0.75 * height, 0.026, 0.8 * width)],
        crease="all",
        offset=(-length + 0.008, 0.0, 0.0),
        anchors=rear,
    )
    back = at(recorder, plate, (0, 1), (-1.0, 0.0, 0.0)).elements
    recorder.scale(_about(plate, back), 1.0, "u", size="plate_length")
    recorder.drag(strut.sections(1), -0.62 * height)
    stocks = [solid, top, strut, plate]
    hinge = rear.elements
    for axes, name in (("u", "stock_length"), ("z", "stock_height")):
        recorder.scale([_about(body, hinge) for body in stocks], 1.0, axes, size=name)
    recorder.rotate([_about(body, hinge) for body in stocks], -STOCK_DROP_DEG, "v", angle="stock_drop")
    recorder.part("solid stock", components(solid), present_when=(when("stock", SOLID),))
    recorder.part("upper bar and plate", components(top, plate), present_when=(when("stock", SKELETON, FOLDING),))
    recorder.part("lower bar", components(strut), present_when=(when("stock", SKELETON),))
    return stocks


def _above(recorder: Recorder, receiver: Loft) -> list[Loft]:
    """The rear sight, the carrying handle, a scope on the receiver and one on the handle."""
    middle = upper(recorder, receiver, 1, 2)
    sight = post(recorder, upper(recorder, receiver, 2), (0.030, 0.014, 0.016), top=0.5)
    legs = [post(recorder, middle, (0.026, 0.014, 0.040), along=side * 0.055, top=0.9) for side in (-1.0, 1.0)]
    sections = [
        Section(-0.072, 0.018, 0.012),
        Section(0.060, 0.018, 0.012),
        Section(0.075, 0.018, 0.006, (0.0, -0.003)),
    ]
    bar = beam(recorder, "+x", sections, crease="all", offset=(0.0, 0.0, 0.040), anchors=middle)
    for body in (*legs, bar):
        recorder.scale(_about(body, middle.elements), 1.0, "u", size="handle_length")
    low = scope(recorder, middle, 0.22, 0.032, 0.042)
    high = scope(recorder, upper(recorder, bar, 0, 1), 0.22, 0.032, 0.034)
    recorder.part("rear sight", components(sight), present_when=(when("above", 1),))
    handled = (when("above", SCOPE_ON_HANDLE, HANDLE),)
    recorder.part("carrying handle", components(*legs, bar), present_when=handled)
    recorder.part("scope", components(*low), present_when=(when("above", SCOPE),))
    recorder.part("scope on the handle", components(*high), present_when=(when("above", SCOPE_ON_HANDLE),))
    return [sight, *legs, bar, *low, *high]


def _below(recorder: Recorder, handguard: Loft) -> list[Loft]:
    front_grip = beam(
        recorder,
        "-z",
        [Section(-0.012, 0.030, 0.028), Section(0.05, 0.026, 0.026), Section(0.095, 0.030, 0.028)],
        sides=8,
        anchors=lower(recorder, handguard, 1, 2),
    )
    launcher = tube(
        recorder,
        lower(recorder, handguard, 1, 2),
        [(-0.09, 0.036), (-0.085, 0.04), (0.17, 0.04)],
        rise=-0.012,
        bore=0.8,
    )
    legs = bipod(recorder, lower(recorder, handguard, 3), 0.20)
    recorder.scale(front_grip.body(hinge=0), 1.0, "z", size="below_length")
    recorder.scale(launcher.body(hinge=0), 1.0, "u", size="below_length")
    recorder.scale(legs.body(hinge=0), 1.0, "vz", size="below_length")
    recorder.part("front grip", components(front_grip), present_when=(when("below", FRONT_GRIP),))
    recorder.part("launcher", components(launcher), present_when=(when("below", LAUNCHER),))
    recorder.part("bipod", components(legs), present_when=(when("below", BIPOD),))
    return [front_grip, launcher, legs]


def _about(body: Loft, pivot: tuple[Element, ...]) -> Target:
    return Target((body.component.whole,), "world", (), pivot)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
