"""Models a flintlock pistol: one piece of wood from the butt to the fore-end, the barrel on it, the lock on the right.

Butt and fore-end meet at x = 0. The butt is sketched straight backwards and then bent down.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import components, post, trigger, trigger_guard, tube, whole
from shapewright.modeling import Component, ProceduralModel, Recorder, when

BUTT_LENGTH, BUTT_DEPTH, BUTT_BEND_DEG = 0.150, 0.046, 17.0
FORE_LENGTH, STOCK_HEIGHT, STOCK_WIDTH = 0.16, 0.034, 0.034
BARREL_LENGTH, BARREL_DIAMETER = 0.24, 0.020
LOCK_PLACE = 0.010


def build() -> ProceduralModel:
    """Model the pistol."""
    recorder = Recorder("gun_flintlock", "gun", unit_m=1.0, description="A flintlock or percussion pistol.")
    _declare(recorder)
    fore = _fore_end(recorder)
    butt = _butt(recorder, fore)
    barrel, *on_barrel = _barrel(recorder, fore)
    below = lower(recorder, fore, 1, 2)
    guard = trigger_guard(recorder, below, 0.055, 0.036)
    lever = trigger(recorder, below, 0.024)
    rod = tube(recorder, lower(recorder, fore, 2), [(-0.02, 0.008), (0.8 * FORE_LENGTH, 0.008)], rise=0.003)
    recorder.scale(rod.body(hinge=0), 1.0, "u", size="fore_length")
    recorder.part("ramrod", components(rod), present_when=(when("ramrod", 1),))
    recorder.part("trigger guard", components(guard), present_when=(when("guard", 1),))
    lock = _lock(recorder, fore)
    bodies: tuple[Loft | Component, ...] = (fore, butt, barrel, *on_barrel, guard, lever, rod, *lock)
    recorder.scale(whole(*bodies), 1.0, "v", pivot=fore.component.whole, size="thickness")
    recorder.symmetry(mirrors=("y",), apart=components(*lock))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    recorder.choice("ramrod", "Ramrod", ("with", "without"))
    recorder.choice("lock", "Lock on the side", ("with", "without"))
    recorder.choice("guard", "Trigger guard", ("with", "without"))
    recorder.parameter("butt_length", "Butt length", 0.7, 1.4, unit="m", base_value=BUTT_LENGTH)
    recorder.parameter("butt_depth", "Butt depth", 0.7, 1.35, unit="m", base_value=BUTT_DEPTH)
    recorder.parameter(
        "butt_bend", "Bend of the butt (deg a section)", 0.5, 1.8, base_value=BUTT_BEND_DEG, kind="angle"
    )
    recorder.parameter("butt_cap", "Diameter of the butt's end (share)", 0.8, 1.7, base_value=1.0)
    recorder.parameter("fore_length", "Fore-end length", 0.6, 1.6, unit="m", base_value=FORE_LENGTH)
    recorder.parameter("stock_height", "Height of the wood", 0.7, 1.5, unit="m", base_value=STOCK_HEIGHT)
    recorder.parameter("barrel_length", "Barrel length", 0.5, 1.8, unit="m", base_value=BARREL_LENGTH)
    recorder.limit("barrel_length", minimum=("fore_length", 0.0, 0.7))
    recorder.parameter("barrel_diameter", "Barrel diameter", 0.7, 1.6, unit="m", base_value=BARREL_DIAMETER)
    recorder.parameter("muzzle", "Muzzle diameter (share of the barrel)", 0.8, 2.0, base_value=1.0)
    recorder.parameter(
        "lock_height", "Height of the cock", 0.5, 1.6, unit="m", base_value=0.045, active_when=(when("lock", 1),)
    )
    recorder.parameter(
        "lock_place", "Place of the lock", -1.0, 2.5, unit="m", base_value=LOCK_PLACE, active_when=(when("lock", 1),)
    )
    recorder.parameter(
        "guard_length", "Trigger guard length", 0.75, 1.5, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter(
        "guard_height", "Trigger guard height", 0.75, 1.4, active_when=(when("guard", 1),), kind="length"
    )
    recorder.parameter("thickness", "Overall thickness", 0.6, 1.5, kind="length")


def _fore_end(recorder: Recorder) -> Loft:
    places = ((-0.012, 1.0), (0.008, 1.05), (0.055, 0.95), (0.075, 0.85))
    sections = [Section(place, STOCK_WIDTH * 1.1, STOCK_HEIGHT * 1.1 * share) for place, share in places]
    fore = beam(recorder, "+x", sections, sides=8)
    recorder.scale(fore.sections(3), 0.8, "vz")
    recorder.scale(fore.body(), 1.0, "z", size="stock_height")
    recorder.drag(fore.sections(3), rho=FORE_LENGTH - 0.075, length="fore_length")
    return fore


def _butt(recorder: Recorder, fore: Loft) -> Loft:
    profile = ((-0.08, 0.75), (0.12, 0.78), (0.34, 0.74), (0.56, 0.8), (0.76, 0.92), (0.9, 1.1), (1.0, 0.7))
    sections = [
        Section(place * BUTT_LENGTH, STOCK_WIDTH * 1.1 * (1.0 if share < 1.0 else 1.1), BUTT_DEPTH * 1.1 * share)
        for place, share in profile
    ]
    butt = beam(recorder, "-x", sections, sides=8, anchors=at(recorder, fore, 0))
    recorder.mark_sharp(butt.component.bottom, sharp=False)
    recorder.scale(butt.body(hinge=0), 1.0, "u", size="butt_length")
    recorder.scale(butt.body(), 1.0, "z", size="butt_depth")
    recorder.scale(butt.sections(5, 6), 1.0, "vz", size="butt_cap")
    for number in range(1, 5):
        recorder.rotate(butt.beyond(number, hinge=number), -BUTT_BEND_DEG, "v", angle="butt_bend")
    return butt


def _barrel(recorder: Recorder, fore: Loft) -> list[Loft]:
    profile = [(-0.04, 1.15), (0.3, 1.05), (0.9, 0.9), (0.94, 0.92), (1.0, 0.95)]
    places = [(place * BARREL_LENGTH, share * BARREL_DIAMETER) for place, share in profile]
    barrel = tube(recorder, upper(recorder, fore, 1), places, bore=0.6)
    recorder.scale(barrel.body(hinge=0), 1.0, "u", size="barrel_length")
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    recorder.scale(barrel.sections(3, 4), 1.0, "vz", size="muzzle")
    bead = post(recorder, upper(recorder, barrel, 4), (0.010, 0.003, 0.005), along=-0.010, sink=0.8)
    return [barrel, bead]


def _lock(recorder: Recorder, fore: Loft) -> list[Loft]:
    """The plate on the right side, the cock and the frizzen that stand on it; no mirror image has them."""
    side = at(recorder, fore, (1, 2), (0.0, -1.0, 0.0))
    sections = [Section(-0.006, 0.070, 0.022), Section(0.004, 0.066, 0.018)]
    plate = beam(recorder, "-y", sections, offset=(-0.006, 0.0, 0.002), crease="all", anchors=side)
    cock = beam(
        recorder,
        "+z",
        [
            Section(-0.006, 0.012, 0.007),
            Section(0.012, 0.010, 0.007, (-0.008, 0.0)),
            Section(0.028, 0.010, 0.007, (-0.008, 0.0)),
            Section(0.038, 0.016, 0.010, (0.004, 0.0)),
            Section(0.045, 0.010, 0.008, (0.010, 0.0)),
        ],
        offset=(-0.022, -0.005, 0.0),
        anchors=side,
    )
    frizzen = beam(
        recorder,
        "+z",
        [Section(-0.004, 0.016, 0.010), Section(0.016, 0.010, 0.010), Section(0.036, 0.006, 0.012, (0.006, 0.0))],
        offset=(0.014, -0.004, 0.004),
        anchors=side,
    )
    for body in (cock, frizzen):
        recorder.scale(body.body(hinge=0), 1.0, "z", size="lock_height")
    everything = whole(plate, cock, frizzen)
    recorder.drag(everything, rho=LOCK_PLACE, phi_deg=180.0)
    recorder.drag(everything, rho=LOCK_PLACE, length="lock_place")
    recorder.part("lock", components(plate, cock, frizzen), present_when=(when("lock", 1),))
    return [plate, cock, frizzen]


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
