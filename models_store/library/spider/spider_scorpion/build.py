"""Models a scorpion: a flat body, eight low legs, a tail of beads that arches up to a sting, arms with pincers."""

from pathlib import Path

from models_store.library.aids.beam import beam
from models_store.library.aids.bulb import bulb
from models_store.library.aids.loft import Loft, Section, loft
from models_store.library.author import publish
from models_store.library.spider.arthropod import LegShape, Station, flanks, legs, resize
from shapewright.modeling import Mirror, ProceduralModel, Recorder, Target

LEGS = LegShape(
    length=1.3, thickness=0.09, raise_deg=25.0, knee_deg=60.0, ankle_deg=8.0, inset=0.16, raise_range=(0.0, 1.8)
)
HEADINGS_DEG = (40.0, 12.0, -18.0, -48.0)
BODY_LENGTH, BODY_WIDTH, BODY_HEIGHT = 1.9, 0.80, 0.42
TAIL_BEADS, BEAD_LENGTH, TAIL_WIDTH = 5, 0.42, 0.24
TAIL_NECK = 0.72  # width between two beads, as a share
TAIL_ARCH_DEG = 36.0
STING = (0.0, 0.26), (0.16, 0.24), (0.34, 0.08), (0.50, 0.03)
ARM_LENGTH = 1.0
ARM = ((0.0, 0.13), (0.35, 0.14), (0.65, 0.12), (1.0, 0.20))
ARM_HEADING_DEG, ELBOW_DEG = 58.0, 38.0
FINGER = ((-0.10, 0.16), (0.12, 0.24), (0.32, 0.15), (0.55, 0.04))
FINGER_OPEN_DEG = 14.0


def build() -> ProceduralModel:
    """Model the scorpion."""
    recorder = Recorder(
        "spider_scorpion", "spider", unit_m=0.01, description="A scorpion with its tail raised and two pincers."
    )
    body = loft(recorder, "x", bulb(BODY_LENGTH, BODY_WIDTH, BODY_HEIGHT, start=-1.2, count=8, peak=0.9))
    resize(recorder, body, "body", "Body", ((0.6, 1.5), (0.65, 1.5), (0.6, 1.8)), hinge=4)
    _tail(recorder, body)
    stations = [Station(flanks(recorder, body, 6 - i), heading) for i, heading in enumerate(HEADINGS_DEG)]
    legs(recorder, LEGS, stations)
    _arms(recorder, body)
    recorder.symmetry(mirrors=("y",))
    return recorder.build()


def _tail(recorder: Recorder, body: Loft) -> None:
    """Beads that lead backwards and bend upwards one after another; the last thins out to the sting."""
    sections = [Section(-0.12, TAIL_WIDTH, TAIL_WIDTH)]
    for bead in range(TAIL_BEADS):
        for share, wide in ((0.0, TAIL_NECK), (0.5, 1.0)):
            sections.append(Section((bead + share) * BEAD_LENGTH, TAIL_WIDTH * wide, TAIL_WIDTH * wide))
    end = TAIL_BEADS * BEAD_LENGTH
    sections += [Section(end + at, wide, wide) for at, wide in STING]
    tail = beam(recorder, "-x", sections, sides=6, anchors=Target(body.rings[0][0], "world"))
    last = len(sections)
    recorder.parameter("tail_length", "Tail length", 0.5, 1.5, base_value=end, unit="cm")
    recorder.scale(tail.body(hinge=0), 1.0, "u", size="tail_length")
    recorder.parameter("tail_thickness", "Tail thickness", 0.5, 1.8, base_value=TAIL_WIDTH, unit="cm")
    recorder.scale(tail.sections(*range(last)), 1.0, "vz", size="tail_thickness")
    recorder.parameter(
        "tail_arch", "Bend of the tail at each bead (deg)", 0.1, 1.35, base_value=TAIL_ARCH_DEG, kind="angle"
    )
    for joint in range(1, 2 * TAIL_BEADS, 2):
        recorder.rotate(tail.beyond(joint, hinge=joint), TAIL_ARCH_DEG / 2, "v", angle="tail_arch")
        recorder.rotate(tail.beyond(joint + 1, hinge=joint), TAIL_ARCH_DEG / 2, "v", angle="tail_arch")


def _arms(recorder: Recorder, body: Loft) -> None:
    """An arm at either side of the front, with two fingers at its end."""
    sections = [Section(at * ARM_LENGTH, wide, wide) for at, wide in ARM]
    shoulders = flanks(recorder, body, 6)
    arms = loft(recorder, "x", sections, sides=6, offset=(0.0, -0.14, 0.0), anchors=shoulders)
    recorder.parameter("arm_length", "Arm length", 0.6, 1.7, base_value=ARM_LENGTH, unit="cm")
    recorder.scale(arms.body(hinge=0), 1.0, "u", size="arm_length")
    ends = [Target(ring, "world", image) for ring, image in zip(arms.rings[3], arms.images, strict=True)]
    sections = [Section(at, wide, wide * 0.8) for at, wide in FINGER]
    fingers = [loft(recorder, "x", sections, sides=6, anchors=ends) for _ in range(2)]
    recorder.parameter("pincer_size", "Pincer size", 0.5, 1.8, base_value=FINGER[-1][0], unit="cm")
    recorder.scale([t for finger in fingers for t in finger.body(hinge=0)], 1.0, size="pincer_size")
    recorder.parameter(
        "pincer_open", "Opening of the pincers (deg)", 0.3, 2.0, base_value=2 * FINGER_OPEN_DEG, kind="angle"
    )
    for finger, way in zip(fingers, (1.0, -1.0), strict=True):
        recorder.rotate(finger.body(hinge=0), way * FINGER_OPEN_DEG, "z", angle="pincer_open")
    recorder.parameter("elbow_bend", "Bend of the elbows (deg)", 0.2, 2.0, base_value=ELBOW_DEG, kind="angle")
    recorder.rotate(_limbs(arms, fingers, 2), -ELBOW_DEG, "z", angle="elbow_bend")
    recorder.parameter("arm_heading", "Arms turned outwards (deg)", 0.4, 1.4, base_value=ARM_HEADING_DEG, kind="angle")
    recorder.rotate(_limbs(arms, fingers, 0), ARM_HEADING_DEG, "z", angle="arm_heading")


def _limbs(arms: Loft, fingers: list[Loft], joint: int) -> list[Target]:
    """Each arm beyond a joint, together with its fingers."""
    targets = []
    for copy, mirrors in enumerate(((), (Mirror("y"),))):
        arm = [vertex for ring in arms.rings[joint:] for vertex in ring[copy]]
        hands = [finger.components[copy].whole for finger in fingers]
        targets.append(Target((*arm, *hands), "world", mirrors, arms.rings[joint][copy]))
    return targets


if __name__ == "__main__":
    publish(build(), Path(__file__).parent)
