"""Models a two-handed sword: a long grip, a long cross bar, and a sleeve over the blade's root that may bear hooks."""

from pathlib import Path

from models_store.library.aids.loft import Section, Vector, loft
from models_store.library.author import publish
from models_store.library.sword import blades, guards
from models_store.library.sword.tubes import tube
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target, when

BLADE_LENGTH, BLADE_WIDTH, BLADE_THICKNESS = 1.0, 0.044, 0.012
BLADE_SEGMENTS = 8
BLADE_TAPER = 0.25  # share of the width that is lost up to the tip
TIP_LENGTH = 0.08
BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG = 0.16, 0.018, 1.7, 10.0
SLEEVE_LENGTH, SLEEVE_WIDTH, SLEEVE_THICKNESS = 0.18, 0.044, 0.018
HOOK_LENGTH, HOOK_BEND_DEG, HOOK_DIAMETER = 0.085, 70.0, 0.026
GRIP_LENGTH, GRIP_DIAMETER, POMMEL = 0.34, 0.030, 0.054
HANDLE = (1.0, 1.05, 1.12, 1.2, 1.05, 0.95, 0.85, 0.8)
KNOB = (0.6, 1.04, 1.0, 0.5)


def build() -> ProceduralModel:
    """Model the sword."""
    recorder = Recorder(
        "sword_greatsword", "sword", unit_m=1.0, description="A two-handed sword with a long grip and cross bar."
    )
    recorder.parameter("blade_length", "Blade length (without tip)", 0.6, 1.3, unit="m", base_value=BLADE_LENGTH)
    recorder.parameter("blade_width", "Blade width", 0.55, 2.0, unit="m", base_value=BLADE_WIDTH)
    recorder.parameter("blade_thickness", "Blade thickness", 0.25, 2.6, unit="m", base_value=BLADE_THICKNESS)
    recorder.parameter("blade_taper", "Blade taper (share of width lost)", -0.6, 2.8, base_value=BLADE_TAPER)
    recorder.parameter("tip_length", "Tip length", 0.25, 2.5, unit="m", base_value=TIP_LENGTH)
    recorder.parameter("bar_length", "Cross bar length (each arm)", 0.5, 1.4, unit="m", base_value=BAR_LENGTH)
    recorder.parameter("bar_thickness", "Cross bar thickness", 0.55, 1.6, unit="m", base_value=BAR_DIAMETER)
    recorder.parameter("bar_end", "Cross bar knobs (relative)", 0.6, 1.4, base_value=BAR_END)
    recorder.parameter("bar_bend", "Cross bar bend", -4.0, 6.0, unit="deg", base_value=BAR_BEND_DEG)
    recorder.choice("sleeve", "Sleeve on the blade's root", ("none", "plain", "with hooks"))
    sleeve_there, hooks_there = (when("sleeve", 2, 3),), (when("sleeve", 3),)
    length, width, thickness = "Sleeve length", "Sleeve width", "Sleeve thickness"
    recorder.parameter("sleeve_length", length, 0.4, 1.6, unit="m", base_value=SLEEVE_LENGTH, active_when=sleeve_there)
    recorder.parameter("sleeve_width", width, 0.7, 1.3, unit="m", base_value=SLEEVE_WIDTH, active_when=sleeve_there)
    recorder.limit("sleeve_width", minimum=("blade_width", 0.1, 0.6))
    recorder.parameter(
        "sleeve_thickness", thickness, 0.8, 1.5, unit="m", base_value=SLEEVE_THICKNESS, active_when=sleeve_there
    )
    recorder.parameter("hook_size", "Hook length", 0.5, 1.4, unit="m", base_value=HOOK_LENGTH, active_when=hooks_there)
    recorder.parameter(
        "hook_bend", "Hook bend", -1.2, 1.3, unit="deg", base_value=HOOK_BEND_DEG, active_when=hooks_there
    )
    recorder.parameter("grip_length", "Grip length", 0.55, 1.5, unit="m", base_value=GRIP_LENGTH)
    recorder.parameter("grip_thickness", "Grip thickness", 0.6, 1.6, unit="m", base_value=GRIP_DIAMETER)
    recorder.parameter("pommel_width", "Pommel width", 0.5, 1.5, unit="m", base_value=POMMEL)
    recorder.parameter("pommel_length", "Pommel length", 0.4, 1.8, unit="m", base_value=POMMEL)

    grip = blades.grip(recorder, GRIP_LENGTH, GRIP_DIAMETER, HANDLE, POMMEL, KNOB)
    guards.bar(recorder, grip, BAR_LENGTH, BAR_DIAMETER, BAR_END, BAR_BEND_DEG)
    blade = blades.blade(recorder, grip.top, BLADE_LENGTH, TIP_LENGTH, root=0.006, segments=BLADE_SEGMENTS)
    losses = [BLADE_TAPER / 2 * min((i + 1) / BLADE_SEGMENTS, 1.0) for i in range(len(blade.rings) - 1)]
    blades.hone(recorder, blade, losses, length="blade_taper")
    blades.give_size(recorder, blade, BLADE_WIDTH, BLADE_THICKNESS)
    blades.point(recorder, blade, (0.66, 0.10))

    places = ((0.0, 0.9), (0.12, 1.1), (0.85, 1.1), (0.97, 1.3), (1.03, 1.1))
    sections = [Section(at * SLEEVE_LENGTH, w * SLEEVE_WIDTH, w * SLEEVE_THICKNESS) for at, w in places]
    sleeve = loft(recorder, "z", sections, anchors=[grip.top])
    recorder.scale(sleeve.body(hinge=0), 1.0, "z", size="sleeve_length")
    recorder.scale(sleeve.body(hinge=0), 1.0, "u", size="sleeve_width")
    recorder.scale(sleeve.body(hinge=0), 1.0, "v", size="sleeve_thickness")
    recorder.part("sleeve", sleeve.components, sleeve_there)
    root = sleeve.rings[3][0]
    sides = [Target(root, "world"), Target(root, "world", (Mirror("x"),))]
    path: list[Vector] = [(share * HOOK_LENGTH, 0.0, 0.0) for share in (0.0, 0.25, 0.45, 0.65, 0.85, 1.0)]
    widths = [HOOK_DIAMETER * share for share in (1.1, 1.1, 1.0, 0.8, 0.5, 0.1)]
    hooks = tube(recorder, path, widths, normal="z", anchors=sides)
    for level in range(1, 5):
        recorder.rotate(hooks.beyond(level + 1, hinge=level), -HOOK_BEND_DEG / 4, "v", angle="hook_bend")
    copies = zip(hooks.components, hooks.images, strict=True)
    whole = [Target((component.whole,), "world", image, root) for component, image in copies]
    recorder.scale(whole, 1.0, size="hook_size")
    recorder.scale(whole, 0.55, "v")
    recorder.part("hooks", hooks.components, hooks_there)
    recorder.symmetry(mirrors=("x", "y"))
    return recorder.build()


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
