"""Models a semi-automatic pistol.

The slide (or a receiver with a bare barrel) lies along +x; frame, grip and guard hang below it. The grip is sketched
straight down and then raked, bent and flared.
"""

from pathlib import Path

from models_store.library.aids.beam import at, beam, lower, upper
from models_store.library.aids.loft import Loft, Section
from models_store.library.author import publish
from models_store.library.gun.gun_parts import components, post, square_off, trigger, trigger_guard, tube, whole
from shapewright.modeling import Component, Mirror, ProceduralModel, Recorder, Target, when

SLIDE_LENGTH, SLIDE_HEIGHT, SLIDE_WIDTH = 0.19, 0.027, 0.025
DUST_COVER = 0.065
TANG = 0.012
GRIP_LENGTH, GRIP_DEPTH, GRIP_WIDTH = 0.100, 0.046, 0.028
GRIP_RAKE_DEG, GRIP_BEND_DEG = 16.0, 6.0
GUARD_LENGTH, GUARD_HEIGHT = 0.056, 0.040
BARREL_LENGTH, BARREL_DIAMETER = 0.085, 0.017
IN_SLIDE, BARE, TOGGLE = 1, 2, 3


def build() -> ProceduralModel:
    """Model the pistol."""
    recorder = Recorder("gun", "gun", unit_m=1.0, description="A semi-automatic pistol, with a slide or a bare barrel.")
    _declare(recorder)
    slide = _slide(recorder)
    frame = _frame(recorder, slide)
    grip = _grip(recorder, frame)
    barrels = _barrels(recorder, slide)
    details = _details(recorder, slide, frame)
    recorder.scale(whole(slide, frame, grip, *barrels, *details), 1.0, "v", size="thickness")
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _declare(recorder: Recorder) -> None:
    bare = (when("action", BARE, TOGGLE),)
    recorder.choice("action", "Barrel", ("in a slide", "bare", "bare, with toggle knobs"))
    recorder.choice("hammer", "Hammer", ("outside", "hidden"))
    recorder.choice("sights", "Sights", ("with", "without"))
    recorder.choice("light", "Light under the barrel", ("without", "with"))
    recorder.parameter("slide_length", "Slide length", 0.62, 1.3, unit="m", base_value=SLIDE_LENGTH)
    recorder.parameter("slide_height", "Slide height", 0.7, 1.6, unit="m", base_value=SLIDE_HEIGHT)
    recorder.parameter("slide_front", "Slide height at the muzzle (share)", 0.55, 1.05, base_value=1.0)
    recorder.parameter("slide_rear", "Slide height at the rear (share)", 0.75, 1.8, base_value=0.8)
    recorder.parameter(
        "barrel_length", "Length of the bare barrel", 0.3, 1.7, unit="m", base_value=BARREL_LENGTH, active_when=bare
    )
    recorder.parameter(
        "barrel_diameter",
        "Diameter of the bare barrel",
        0.7,
        1.5,
        unit="m",
        base_value=BARREL_DIAMETER,
        active_when=bare,
    )
    recorder.parameter(
        "muzzle", "Muzzle diameter (share of the bare barrel)", 0.75, 1.4, base_value=1.15, active_when=bare
    )
    recorder.parameter("frame_height", "Frame height", 0.6, 1.6, kind="length")
    recorder.parameter("dust_cover", "Frame length before the guard", 0.05, 1.6, unit="m", base_value=DUST_COVER)
    recorder.limit("dust_cover", maximum=("slide_length", -1.5, 2.8))
    recorder.parameter("tang", "Tang behind the grip", 0.2, 2.5, unit="m", base_value=TANG)
    recorder.parameter("tang_height", "Height of the tang (share of the frame)", 0.5, 3.5, base_value=0.5)
    recorder.parameter("grip_length", "Grip length", 0.6, 1.4, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_depth", "Grip depth", 0.75, 1.35, unit="m", base_value=GRIP_DEPTH)
    recorder.parameter("grip_base", "Grip depth at its base (share)", 0.75, 1.5, base_value=1.0)
    recorder.parameter("grip_middle", "Grip depth at its middle (share)", 0.8, 1.3, base_value=0.95)
    recorder.parameter("grip_rake", "Grip rake (deg)", 0.1, 2.5, base_value=GRIP_RAKE_DEG, kind="angle")
    recorder.parameter("grip_bend", "Grip bend (deg)", -1.0, 2.5, base_value=GRIP_BEND_DEG, kind="angle")
    recorder.parameter("grip_width", "Grip width", 0.6, 1.5, unit="m", base_value=GRIP_WIDTH)
    recorder.parameter(
        "grip_corners", "Corners of the grip's sections, from oval to square", 0.65, 1.07, base_value=1.5
    )
    recorder.parameter("magazine", "Magazine below the grip", 0.1, 3.0, unit="m", base_value=0.008)
    recorder.parameter("guard_length", "Trigger guard length", 0.75, 1.5, unit="m", base_value=GUARD_LENGTH)
    recorder.parameter("guard_height", "Trigger guard height", 0.7, 1.5, unit="m", base_value=GUARD_HEIGHT)
    recorder.parameter("thickness", "Overall thickness", 0.55, 1.5, kind="length")


def _slide(recorder: Recorder) -> Loft:
    """Its rear end at x = 0; ring 3 is the muzzle end."""
    places = ((0.0, 1.0), (0.012, 1.0), (0.15, 1.0), (SLIDE_LENGTH, 0.97))
    sections = [Section(place, SLIDE_WIDTH, SLIDE_HEIGHT * share) for place, share in places]
    slide = beam(recorder, "+x", sections, crease="all")
    recorder.scale(slide.body(hinge=0), 1.0, "u", size="slide_length")
    recorder.scale(slide.body(), 1.0, "z", size="slide_height")
    recorder.scale(slide.sections(0), 0.8, "z", size="slide_rear")
    recorder.scale(slide.sections(2, 3), 1.0, "z", size="slide_front")
    return slide


def _frame(recorder: Recorder, slide: Loft) -> Loft:
    """Rings: tang, rear and front of the grip, front of the guard, end of the dust cover."""
    height = 0.020
    places = ((-0.004, 1.0), (0.004, 1.0), (0.052, 1.0), (0.105, 0.85), (0.108, 0.8))
    sections = [Section(place, SLIDE_WIDTH * 1.06, height * share, (0.0, -0.3 * height)) for place, share in places]
    frame = beam(recorder, "+x", sections, crease="all", anchors=lower(recorder, slide, 0))
    recorder.scale(frame.body(), 1.0, "z", size="frame_height")
    recorder.scale(frame.sections(0), 0.5, "z", size="tang_height")
    recorder.drag(frame.beyond(4), rho=DUST_COVER, length="dust_cover")
    recorder.drag(frame.sections(0), rho=TANG, phi_deg=180.0, length="tang")
    return frame


def _grip(recorder: Recorder, frame: Loft) -> Loft:
    shares = ((-0.1, 1.0), (0.0, 1.0), (0.35, 0.97), (0.7, 1.02), (1.0, 1.05))
    sections = [
        Section(place * GRIP_LENGTH, GRIP_DEPTH * share, GRIP_WIDTH * (0.92 if place <= 0 else 1.0))
        for place, share in shares
    ]
    grip = beam(recorder, "-z", sections, sides=8, anchors=lower(recorder, frame, 1, 2))
    square_off(recorder, grip, range(5), 1.5, "uv", "grip_corners")
    base = grip.component.bottom
    recorder.extrude(base, 0.0)
    recorder.scale(base, 0.86, "uv")
    recorder.mark_sharp(base)
    recorder.extrude(base, 0.008, length="magazine")
    recorder.mark_sharp(base)
    recorder.scale(grip.body(hinge=1), 1.0, "z", size="grip_length")
    recorder.scale(grip.body(), 1.0, "u", size="grip_depth")
    recorder.scale(grip.body(), 1.0, "v", size="grip_width")
    recorder.scale(grip.sections(2, 3), 0.95, "u", size="grip_middle")
    foot = Target((*grip.rings[4][0], *recorder.vertices_of(base)), "world")
    recorder.scale(foot, 1.0, "u", size="grip_base")
    recorder.rotate(_below(recorder, grip, 2), GRIP_BEND_DEG, "v", angle="grip_bend")
    recorder.rotate(grip.body(hinge=1), GRIP_RAKE_DEG, "v", angle="grip_rake")
    return grip


def _below(recorder: Recorder, grip: Loft, number: int) -> Target:
    """Return a grip from a section on, its magazine included, hinged there."""
    above = {vertex for rings in grip.rings[:number] for vertex in rings[0]}
    rest = [vertex for vertex in recorder.vertices_of(grip.component.whole) if vertex not in above]
    return Target(tuple(rest), "world", (), grip.rings[number][0])


def _barrels(recorder: Recorder, slide: Loft) -> list[Loft]:
    """The bare barrel, from the slide to a swollen muzzle; the muzzle of one in the slide; the sight of the first."""
    muzzle = at(recorder, slide, 3)
    profile = [(-0.02, 1.25), (0.006, 1.25), (0.014, 1.0), (0.86, 0.9), (0.88, 1.0), (1.0, 1.0)]
    places = [(place if place < 0.02 else place * BARREL_LENGTH, share * BARREL_DIAMETER) for place, share in profile]
    barrel = tube(recorder, muzzle, places, bore=0.55)
    stub = tube(recorder, muzzle, [(-0.02, 0.014), (0.003, 0.014)], bore=0.6)
    recorder.scale(barrel.body(), 1.0, "vz", size="barrel_diameter")
    recorder.scale(barrel.sections(4, 5), 1.15, "vz", size="muzzle")
    recorder.scale(barrel.body(hinge=0), 1.0, "u", size="barrel_length")
    blade = post(recorder, upper(recorder, barrel, 4, 5), (0.009, 0.003, 0.006), sink=0.5)
    recorder.part("bare barrel", components(barrel, blade), present_when=(when("action", BARE, TOGGLE),))
    recorder.part("muzzle", components(stub), present_when=(when("action", IN_SLIDE),))
    return [barrel, stub, blade]


def _details(recorder: Recorder, slide: Loft, frame: Loft) -> list[Loft | Component]:
    below = lower(recorder, frame, 2, 3)
    guard = trigger_guard(recorder, below, GUARD_LENGTH, GUARD_HEIGHT, along=-0.002)
    lever = trigger(recorder, below, 0.024, along=-0.008)
    hammer = beam(
        recorder,
        "-x",
        [
            Section(-0.010, 0.008, 0.018),
            Section(0.006, 0.008, 0.014, (0.0, 0.004)),
            Section(0.016, 0.009, 0.008, (0.0, 0.011)),
        ],
        anchors=at(recorder, slide, 0),
    )
    front = post(recorder, upper(recorder, slide, 3), (0.010, 0.004, 0.006), along=-0.008, sink=1.0)
    rear = post(recorder, upper(recorder, slide, 1), (0.010, 0.018, 0.006), along=0.006, sink=1.0, top=0.8)
    light = beam(
        recorder,
        "+x",
        [Section(-0.030, 0.022, 0.024), Section(0.030, 0.024, 0.026)],
        crease="all",
        offset=(0.0, 0.0, -0.009),
        anchors=lower(recorder, frame, 3, 4),
    )
    knobs = _knobs(recorder, slide)
    recorder.part("hammer", components(hammer), present_when=(when("hammer", 1),))
    recorder.part("rear sight", components(rear), present_when=(when("sights", 1),))
    recorder.part("front sight", components(front), present_when=(when("sights", 1), when("action", IN_SLIDE)))
    recorder.part("light", components(light), present_when=(when("light", 2),))
    recorder.part("toggle", components(knobs), present_when=(when("action", TOGGLE),))
    return [guard, lever, hammer, front, rear, light, knobs]


def _knobs(recorder: Recorder, slide: Loft) -> Loft:
    """The toggle of a Luger: a round knob on either side, above the rear of the receiver."""
    top = upper(recorder, slide, 1).elements
    anchors = [Target(top, "world"), Target(top, "world", (Mirror("y"),))]
    sections = [Section(0.0, 0.026, 0.026), Section(0.012, 0.026, 0.026), Section(0.017, 0.018, 0.018)]
    return beam(recorder, "+y", sections, sides=8, offset=(0.012, 0.002, 0.0), anchors=anchors)


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
