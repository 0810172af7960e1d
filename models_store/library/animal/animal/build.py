"""Models a four-legged animal, head towards +x: the trunk is one box that grows to head and tail; the legs hang on it.

The legs are modelled one after another, fore and hind, left and right.
"""

from pathlib import Path

from models_store.library.aids.sketching import grow, push, put
from models_store.library.annotations import AnnotatingRecorder, publish_annotated
from shapewright.modeling import Element, ProceduralModel, when

TRUNK, WIDTH, DEPTH = 0.60, 0.40, 0.46
NECK, NECK_DEG = 0.30, 42.0
HEAD, HEAD_DEG, MUZZLE = 0.30, 18.0, 0.16
UPPER, LOWER, PAW, LEG = 0.38, 0.32, 0.09, 0.15
KNEE = 0.06
TAIL, TAIL_DEG = 0.45, 35.0
EAR, HORN = 0.17, 0.22


def model() -> AnnotatingRecorder:
    """Model the animal."""
    r = AnnotatingRecorder(
        "animal", "animal", unit_m=1.0, description="A standing four-legged animal: dog, horse, pig, cow, giraffe."
    )
    r.parameter("trunk_length", "Trunk length", 0.6, 1.9, unit="m", base_value=TRUNK)
    r.parameter("trunk_width", "Trunk width", 0.6, 1.6, unit="m", base_value=WIDTH)
    r.parameter("trunk_depth", "Trunk depth", 0.7, 1.5, unit="m", base_value=DEPTH)
    r.parameter("belly", "Belly (of the chest)", 0.7, 1.3, base_value=0.95)
    r.parameter("neck_length", "Neck length", 0.2, 3.0, unit="m", base_value=NECK)
    r.parameter("neck_angle", "Neck raised by", -0.3, 1.6, unit="deg", base_value=NECK_DEG)
    r.parameter("neck_thickness", "Neck thickness (of the base animal's)", 0.7, 1.4, base_value=1.0)
    r.parameter("head_size", "Head size", 0.65, 1.5, unit="m", base_value=HEAD)
    r.parameter("head_angle", "Head lowered by", -0.6, 3.0, unit="deg", base_value=HEAD_DEG)
    r.parameter("muzzle_length", "Muzzle length", 0.3, 2.0, unit="m", base_value=MUZZLE)
    r.parameter("muzzle_width", "Muzzle width (of the head's)", 0.6, 1.5, base_value=0.62)
    r.parameter("leg_length", "Leg length", 0.35, 1.7, unit="m", base_value=UPPER + LOWER)
    r.parameter("leg_thickness", "Leg thickness", 0.55, 1.8, unit="m", base_value=LEG)
    r.limit("leg_thickness", maximum=("trunk_width", 0.3, 1.0))
    r.parameter("leg_bend", "Hind leg bend", -0.3, 2.2, unit="m", base_value=KNEE)
    r.parameter("paw_length", "Paw length", 0.2, 2.0, unit="m", base_value=PAW)
    r.switch("tail", "Tail")
    tailed = [when("tail", 1)]
    r.parameter("tail_length", "Tail length", 0.3, 1.8, unit="m", base_value=TAIL, active_when=tailed)
    r.parameter("tail_angle", "Tail lowered by", -1.3, 1.8, unit="deg", base_value=TAIL_DEG, active_when=tailed)
    r.choice("ears", "Ears", ("upright", "drooping", "none"))
    r.parameter("ear_length", "Ear length", 0.4, 2.0, unit="m", base_value=EAR, active_when=[when("ears", 1, 2)])
    r.choice("horns", "Horns", ("none", "two"))
    r.parameter("horn_length", "Horn length", 0.4, 2.0, unit="m", base_value=HORN, active_when=[when("horns", 2)])
    rump, hips, chest, neck_end = _trunk(r)
    for label, ring in (("fore", chest), ("hind", hips)):
        for side in (-1, 1):
            _leg(r, ring, side, label)
    _tail(r, rump)
    _head(r, neck_end)
    r.symmetry(mirrors=("y",))
    return r


def build() -> ProceduralModel:
    """Return the procedural model."""
    return model().build()


def _trunk(r: AnnotatingRecorder) -> tuple[list[Element], list[Element], list[Element], list[Element]]:
    """Rump, belly, chest and neck; returns the rings at the tail, the hips, the chest and the end of the neck."""
    body = r.box(0.22, 1.0, 1.0, offset=(-0.42, 0.0, -0.5))
    front, rear = body.sides[1], body.sides[3]
    hips = r.vertices_of(rear)
    r.judge("trunk length", important=True)
    r.extrude(front, TRUNK / 2, length="trunk_length")
    belly = r.vertices_of(front)
    r.extrude(front, TRUNK / 2, length="trunk_length")
    chest = r.vertices_of(front)
    for face, label in ((rear, "buttocks"), (front, "breast")):
        r.judge(f"length of the {label}", important=False)
        r.extrude(face, 0.10)
        r.judge(f"slimness of the {label}", important=False)
        r.scale(face, 0.62, "uv")
    rump, shoulder = r.vertices_of(rear), r.vertices_of(front)
    r.judge("trunk width", important=True)
    r.scale(put(body.whole), WIDTH, "v", size="trunk_width")
    r.judge("trunk depth", important=True)
    r.scale(put(body.whole), DEPTH, "z", size="trunk_depth")
    r.judge("belly", important=True)
    r.scale(put(*belly), 0.95, "vz", size="belly")
    r.judge("neck length", important=True)
    r.extrude(front, NECK, length="neck_length")
    r.judge("neck thickness", important=True)
    r.scale(front, 0.75, "uv", size="neck_thickness")
    neck_end = r.vertices_of(front)
    r.judge("neck raised", important=True)
    r.rotate(put(*neck_end, pivot=tuple(shoulder)), -NECK_DEG, "v", angle="neck_angle")
    return rump, hips, chest, neck_end


def _leg(r: AnnotatingRecorder, ring: list[Element], side: int, label: str) -> None:
    """A leg that starts within the trunk, of thickness 1 first: thigh, shin and paw."""
    spread = sorted(ring, key=lambda vertex: float(r.positions(vertex)[0] @ (0.0, side, -1.0)))
    leg = r.box(1.0, 0.8, 0.06, offset=(0.0, 0.02 * side, -0.03), anchor=put(*spread[1:]))
    end = leg.bottom
    r.judge("slimness of the hip joint", important=False)
    r.scale(leg.top, 0.6, "uv")
    r.judge("leg length", important=True)
    r.extrude(end, UPPER, length="leg_length")
    r.judge("slimness of the shin", important=False)
    r.scale(end, 0.62, "uv")
    knee = r.vertices_of(end)
    r.judge("leg length", important=True)
    r.extrude(end, LOWER, length="leg_length")
    r.judge("slimness of the paw", important=False)
    r.scale(end, 0.9, "uv")
    r.judge("leg thickness", important=True)
    r.scale(put(leg.whole), LEG, "uv", size="leg_thickness")
    if label == "hind":
        r.judge("hind leg bend", important=False)
        push(r, knee, (-KNEE, 0.0, 0.0), length="leg_bend")
    r.judge("height of the paw", important=False)
    r.extrude(end, 0.07)
    toe = max(r.new_sides(end), key=lambda face: float(r.normal(face)[0]))
    r.judge("paw length", important=False)
    r.extrude(toe, PAW, length="paw_length")
    r.mark_sharp(end)


def _tail(r: AnnotatingRecorder, rump: list[Element]) -> None:
    """A tail of three pieces, drawn straight and then lowered."""
    upper = sorted(rump, key=lambda vertex: float(r.positions(vertex)[0, 2]))[2:]
    tail = r.box(0.1, 0.1, 0.1, offset=(0.06, 0.0, -0.10), anchor=put(*upper))
    root = tuple(r.vertices_of(tail.sides[1]))
    for share, size in ((0.3, 0.75), (0.4, 0.9), (0.3, 0.7)):
        r.judge("tail length", important=True)
        r.extrude(tail.sides[3], share * TAIL, length="tail_length")
        r.judge("slimness of the tail", important=False)
        r.scale(tail.sides[3], size, "uv")
    r.judge("tail lowered", important=True)
    r.rotate(put(tail.whole, pivot=root), -TAIL_DEG, "v", angle="tail_angle")
    r.part("tail", [tail], [when("tail", 1)])


def _head(r: AnnotatingRecorder, neck_end: list[Element]) -> None:
    """Skull, muzzle, ears and horns of a head of size 1, which then is sized and nods as one."""
    place = put(*neck_end)
    skull = r.box(0.9, 0.8, 0.95, offset=(0.12, 0.0, -0.45), anchor=place)
    front = skull.sides[1]
    r.judge("length of the cheeks", important=False)
    r.extrude(front, 0.22)
    r.judge("width of the cheeks", important=False)
    r.scale(front, 0.8, "uv")
    r.judge("muzzle length", important=True)
    r.extrude(front, MUZZLE / HEAD, length="muzzle_length")
    r.judge("muzzle width", important=True)
    r.scale(front, 0.62, "uv", size="muzzle_width")
    r.judge("drop of the muzzle", important=False)
    push(r, front, (0.0, 0.0, -0.14))
    upright, drooping, horns = [], [], []
    for side in (-1, 1):
        ears = [
            r.box(0.12, 0.26, 0.26, offset=(-0.12, 0.22 * side, 0.1), anchor=place),
            r.box(0.22, 0.26, 0.14, offset=(-0.08, 0.18 * side, 0.2), anchor=place),
        ]
        tips = [ears[0].top, ears[1].sides[1 + side]]
        r.judge("ear length", important=True, direction="ear direction")
        grow(r, tips[0], (0.0, 0.2 * side, EAR / HEAD), length="ear_length")
        grow(r, tips[1], (0.0, 0.8 * EAR / HEAD * side, -0.7 * EAR / HEAD), length="ear_length")
        r.judge("slimness of the ears", important=False)
        r.scale([put(tip) for tip in tips], 0.45, "uv")
        upright.append(ears[0])
        drooping.append(ears[1])
        horn = r.box(0.16, 0.16, 0.2, offset=(0.08, 0.14 * side, 0.2), anchor=place)
        for out, share in ((0.8, 0.75), (0.2, 0.4)):
            r.judge("horn length", important=True, direction="horn direction")
            grow(r, horn.top, (0.0, out * side * 0.5 * HORN / HEAD, 0.5 * HORN / HEAD), length="horn_length")
            r.judge("slimness of the horns", important=False)
            r.scale(put(horn.top), share, "uv")
        horns.append(horn)
    everything = [part.whole for part in (skull, *upright, *drooping, *horns)]
    r.judge("head size", important=True)
    r.scale(put(*everything, pivot=tuple(neck_end)), HEAD, "uvz", size="head_size")
    r.judge("head lowered", important=True)
    r.rotate(put(*everything, pivot=tuple(neck_end)), HEAD_DEG, "v", angle="head_angle")
    r.part("upright ears", upright, [when("ears", 1)])
    r.part("drooping ears", drooping, [when("ears", 2)])
    r.part("horns", horns, [when("horns", 2)])


if __name__ == "__main__":
    publish_annotated(model(), Path(__file__).parent)
