"""A small model that has everything a class may need: options, what depends on what, optional parts, symmetry."""

from shapewright.modeling import ProceduralModel, Recorder, group, when


def armchair() -> ProceduralModel:
    """A seat on a leg with a ring around it; three kinds of back, armrests that may be there.

    The ring's height depends on the leg's length, the armrests' height is of interest only with armrests.
    """
    recorder = Recorder("armchair", "chair", description="a seat with armrests")
    recorder.choice("back", "Back", ("low back", "high back", "no back"))
    recorder.switch("armrests", "Armrests")
    recorder.parameter("leg_length", "Leg length", 0.5, 2.0, unit="m", base_value=0.4)
    recorder.parameter(
        "arm_height", "Armrest height", 0.5, 2.0, unit="m", base_value=0.2, active_when=[when("armrests", 1)]
    )
    recorder.parameter("ring_height", "Ring height", 0.2, 1.5, unit="m", base_value=0.3)
    recorder.limit("ring_height", maximum=("leg_length", 0.25, 0.75))
    seat = recorder.box(1.0, 1.0, 0.2)
    leg = recorder.box(0.2, 0.2, 0.8, anchor=seat.bottom)
    ring = recorder.box(0.5, 0.5, 0.05, offset=(0.0, 0.0, -0.6))
    low = recorder.box(0.1, 0.9, 0.4, offset=(-0.4, 0.0, 0.2))
    high = recorder.box(0.1, 0.9, 0.9, offset=(-0.4, 0.0, 0.45))
    arms = [recorder.box(0.7, 0.1, 0.3, offset=(0.0, side, 0.2)) for side in (0.45, -0.45)]
    recorder.scale(group(leg.whole, frame="world"), 1.0, "z", size="leg_length")
    recorder.scale(group(ring.whole, frame="world"), 1.0, "z", size="ring_height")
    recorder.scale(group(*(arm.whole for arm in arms), frame="world"), 1.0, "z", size="arm_height")
    recorder.part("low back", [low], [when("back", 1)])
    recorder.part("high back", [high], [when("back", 2)])
    recorder.part("armrests", arms, [when("armrests", 1)])
    recorder.symmetry(mirrors="y")
    return recorder.build()
