"""Models a standing figure that looks towards +x, out of one box: trunk, neck, head, then arms and legs.

The arms are drawn straight to the sides and then lowered. Left follows right in operations of its own.
"""

from pathlib import Path

from models_store.library.aids.lathe import control_diameter
from models_store.library.aids.sketching import edge_towards, push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Component, Element, ProceduralModel, when

PELVIS = (0.24, 0.36, 0.18)
WAIST, CHEST, SHOULDERS = 0.20, 0.24, 0.12
NECK, HEAD = 0.09, 0.27
UPPER_ARM, FOREARM, HAND = 0.30, 0.26, 0.18
THIGH, SHIN, FOOT = 0.44, 0.42, 0.20
ARM_DEG, ELBOW_DEG, LEG_DEG = 65.0, 12.0, 5.0
SKIRT = 0.5


def model() -> AnnotatingRecorder:
    """Model the figure."""
    r = AnnotatingRecorder(
        "humanoid", "humanoid", unit_m=1.0, description="A standing human figure, arms out or hanging."
    )
    r.parameter("trunk_length", "Trunk length", 0.7, 1.5, unit="m", base_value=WAIST + CHEST)
    r.parameter("trunk_depth", "Trunk depth (of the pelvis's)", 0.65, 1.7, base_value=1.0)
    r.parameter("hip_width", "Hip width (of the base figure's)", 0.75, 1.5, base_value=1.0)
    r.parameter("waist_width", "Waist width (of the hips')", 0.6, 1.4, base_value=0.82)
    r.parameter("chest_width", "Chest width (of the hips')", 0.7, 1.5, base_value=1.05)
    r.parameter("shoulder_width", "Shoulder length", 0.3, 2.2, unit="m", base_value=0.10)
    r.parameter("neck_length", "Neck length", 0.5, 2.2, unit="m", base_value=NECK)
    r.parameter("head_size", "Head width (of the base figure's)", 0.75, 1.4, base_value=1.0)
    r.parameter("head_length", "Head height", 0.75, 1.5, unit="m", base_value=HEAD)
    r.parameter("arm_length", "Arm length", 0.55, 1.4, unit="m", base_value=UPPER_ARM + FOREARM)
    r.parameter("arm_thickness", "Arm thickness (of the base figure's)", 0.65, 1.5, base_value=1.0)
    r.parameter("arm_angle", "Arms lowered by", -0.6, 1.22, unit="deg", base_value=ARM_DEG)
    r.parameter("elbow_bend", "Elbow bend", -0.5, 4.0, unit="deg", base_value=ELBOW_DEG)
    r.parameter("hand_length", "Hand length", 0.5, 1.6, unit="m", base_value=HAND)
    r.parameter("leg_length", "Leg length", 0.4, 1.4, unit="m", base_value=THIGH + SHIN)
    r.parameter("leg_thickness", "Leg thickness (of the base figure's)", 0.65, 1.4, base_value=1.0)
    r.parameter("leg_spread", "Legs spread by", 0.0, 4.0, unit="deg", base_value=LEG_DEG)
    r.parameter("foot_length", "Foot length", 0.4, 1.8, unit="m", base_value=FOOT)
    r.choice("hat", "Hat", ("none", "brimmed", "cap"))
    r.choice("clothes", "Clothes", ("none", "skirt"))
    r.parameter("skirt_length", "Skirt length", 0.5, 1.5, unit="m", base_value=SKIRT, active_when=[when("clothes", 2)])
    r.limit("skirt_length", maximum=("leg_length", 0.0, 1.5))
    body, hips, crown, sides = _trunk(r)
    _arms(r, sides)
    _legs(r, body)
    _hats(r, crown)
    _skirt(r, hips)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _trunk(r: AnnotatingRecorder) -> tuple[Component, list[Element], Element, dict[int, Element]]:
    """Pelvis, waist, chest, neck and head; the hips' vertices, the face on top, and those from which the arms grow."""
    body = r.box(*PELVIS)
    top = body.top
    hips = r.vertices_of(body.whole)
    r.judge("trunk length", important=True)
    r.extrude(top, WAIST, length="trunk_length")
    waist = r.vertices_of(top)
    r.extrude(top, CHEST, length="trunk_length")
    chest = r.vertices_of(top)
    r.extrude(top, SHOULDERS, length="trunk_length")
    sides = {side: _towards(r, r.new_sides(top), side) for side in (-1, 1)}
    shoulders = r.vertices_of(top)
    r.judge("slope of the shoulders", important=False)
    r.extrude(top, 0.03)
    r.judge("neck thickness", important=False)
    r.scale(put(top), 0.42, "v")
    r.scale(put(top), 0.62, "u")
    r.judge("neck length", important=True)
    r.extrude(top, NECK, length="neck_length")
    head = []
    for rise, share in ((0.1, 1.75), (0.4, 1.1), (0.35, 0.9), (0.15, 0.6)):
        r.judge("head height", important=True)
        r.extrude(top, rise * HEAD, length="head_length")
        r.judge("roundness of the head", important=False)
        r.scale(top, share, "uv")
        head += r.vertices_of(top)
    r.judge("head width", important=True)
    r.scale(put(*head), 1.0, "uv", size="head_size")
    for label, rings, share, name in (
        ("waist", waist, 0.82, "waist_width"),
        ("chest", [*chest, *shoulders], 1.05, "chest_width"),
    ):
        r.judge(f"{label} width", important=True)
        r.scale(put(*rings), share, "v", size=name)
    r.judge("hip width", important=True)
    r.scale(put(*hips), 1.0, "v", size="hip_width")
    r.judge("trunk depth", important=True)
    r.scale(put(*hips, *waist, *chest, *shoulders), 1.0, "u", size="trunk_depth")
    r.judge("head forward", important=False)
    push(r, put(*head), (0.03, 0.0, 0.0))
    return body, hips, top, sides


def _towards(r: AnnotatingRecorder, faces: list[Element], side: int) -> Element:
    return max(faces, key=lambda face: float(r.normal(face)[1]) * side)


def _arms(r: AnnotatingRecorder, sides: dict[int, Element]) -> None:
    for side in (-1, 1):
        end = sides[side]
        r.judge("shoulder length", important=True)
        r.extrude(end, 0.10, length="shoulder_width")
        joint = tuple(r.vertices_of(end))
        r.judge("shoulder thickness", important=False)
        r.scale(end, 0.8, "uv")
        rings = []
        for label, length, name, share in (
            ("arm length", UPPER_ARM, "arm_length", 0.8),
            ("arm length", FOREARM, "arm_length", 0.75),
            ("hand length", 0.4 * HAND, "hand_length", 1.25),
            ("hand length", 0.6 * HAND, "hand_length", 0.6),
        ):
            r.judge(label, important=label == "arm length")
            r.extrude(end, length, length=name)
            r.judge("slimness of the arm" if name == "arm_length" else "shape of the hand", important=False)
            r.scale(end, share, "uv")
            rings.append(r.vertices_of(end))
        r.judge("arm thickness", important=True)
        thick = [put(*joint), *(put(*ring) for ring in rings[:2])]
        r.scale(thick, 1.0, "uz", size="arm_thickness")
        r.judge("elbow bend", important=True)
        beyond = [v for ring in rings[1:] for v in ring]
        r.rotate(put(*beyond, pivot=tuple(rings[0])), -side * ELBOW_DEG, "z", angle="elbow_bend")
        r.judge("arms lowered", important=True)
        arm = [v for ring in rings for v in ring]
        r.rotate(put(*arm, pivot=joint), -side * ARM_DEG, "u", angle="arm_angle")


def _legs(r: AnnotatingRecorder, body: Component) -> None:
    """Split the underside of the pelvis and grow a leg out of each half."""
    front, back = (edge_towards(r, body.bottom, (x, 0.0, 0.0)) for x in (1.0, -1.0))
    r.judge("middle between the legs", important=False)
    r.connect(*r.insert_vertex(front, back))
    below = [face for face in r.faces_of(body) if abs(r.positions(face)[:, 2]).max() < 1e-9]
    halves = sorted(below, key=lambda face: float(r.centre(face)[1]))
    for side, end in zip((-1, 1), halves, strict=True):
        r.judge("hip joint", important=False)
        r.extrude(end, 0.05)
        joint = tuple(r.vertices_of(end))
        rings = []
        for label, length, share in (("leg length", THIGH, 0.72), ("leg length", SHIN, 0.65)):
            r.judge(label, important=True)
            r.extrude(end, length, length="leg_length")
            r.judge("slimness of the leg", important=False)
            r.scale(end, share, "uv")
            rings.append(r.vertices_of(end))
        r.judge("height of the foot", important=False)
        r.extrude(end, 0.08)
        toe = max(r.new_sides(end), key=lambda face: float(r.normal(face)[0]))
        rings.append(r.vertices_of(end))
        r.judge("leg thickness", important=True)
        r.scale([put(*ring) for ring in rings], 1.0, "uv", size="leg_thickness")
        r.judge("foot length", important=True)
        r.extrude(toe, FOOT, length="foot_length")
        r.judge("flatness of the foot", important=False)
        r.scale(put(toe), 0.7, "z")
        r.mark_sharp(end)
        r.judge("legs spread", important=True)
        leg = [v for ring in rings for v in ring] + r.vertices_of(toe)
        r.rotate(put(*leg, pivot=joint), side * LEG_DEG, "u", angle="leg_spread")


def _hats(r: AnnotatingRecorder, crown: Element) -> None:
    """A hat with a brim and a tall cap, as wide as the head."""
    hats = []
    for brim, heights in ((1.9, ((0.02, 0.55), (0.14, 0.9))), (1.1, ((0.05, 1.0), (0.1, 0.8)))):
        hat = r.prism(8, control_diameter(0.22 * brim, 8), 0.02, offset=(0.0, 0.0, -0.07), anchor=put(crown))
        for rise, share in heights:
            r.judge("height of the hat", important=False)
            r.extrude(hat.top, rise)
            r.judge("width of the hat", important=False)
            r.scale(hat.top, share, "uv")
        r.mark_sharp(hat.top, hat.bottom)
        hats.append(hat)
    r.judge("width of the hat, following the head", important=False)
    r.scale([put(hat.whole) for hat in hats], 1.0, "uv", size="head_size")
    r.part("brimmed hat", hats[:1], [when("hat", 2)])
    r.part("cap", hats[1:], [when("hat", 3)])


def _skirt(r: AnnotatingRecorder, hips: list[Element]) -> None:
    """A bell around the hips."""
    skirt = r.prism(8, 1.0, 0.1, offset=(0.0, 0.0, 0.03), anchor=put(*hips))
    r.judge("width of the skirt's waist", important=False)
    r.scale(put(skirt.whole), 0.42, "uv", size="hip_width")
    r.judge("skirt length", important=True)
    r.extrude(skirt.bottom, SKIRT, length="skirt_length")
    r.judge("width of the hem", important=True)
    r.scale(put(skirt.bottom), 1.9, "uv")
    r.mark_sharp(skirt.bottom)
    r.part("skirt", [skirt], [when("clothes", 2)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
