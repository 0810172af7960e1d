"""Make goblet.ply, the sample mesh of the demo: a goblet as a careless scanner would hand it over.

It owes nothing to the procedural models: a hand-drawn profile is turned on a lathe, then spoiled the way meshes
from outside are: noise on the surface, holes, faces that exist twice, faces that look inward, an arbitrary
pose, place and scale.

    python examples/make_goblet.py            writes examples/goblet.ply
    python examples/make_goblet.py OTHER.ply

The random numbers come from Python's own generator, whose stream is the same in every version.
"""

import math
import random
import sys
from pathlib import Path

import numpy as np

SEED = 20_240_607
SEGMENTS = 56
NOISE = 0.0035  # standard deviation; the goblet is about 2.2 high
SCALE = 61.7
TURN_DEG = (112.0, -37.0, 23.0)  # about x, then y, then z
PLACE = (140.0, -35.5, 8.25)

# (radius, height) from the middle of the foot's underside, around the rim, to the bottom of the cup's inside
PROFILE = [
    (0.00, 0.000), (0.20, 0.004), (0.42, 0.004), (0.56, 0.010), (0.60, 0.030), (0.58, 0.052), (0.46, 0.080),
    (0.30, 0.115), (0.18, 0.160), (0.110, 0.220), (0.080, 0.300), (0.070, 0.390), (0.068, 0.480),
    (0.078, 0.540), (0.120, 0.580), (0.142, 0.620), (0.120, 0.660), (0.078, 0.700), (0.068, 0.770),
    (0.074, 0.850), (0.100, 0.910), (0.170, 0.960), (0.290, 1.020), (0.410, 1.100), (0.500, 1.200),
    (0.560, 1.320), (0.590, 1.460), (0.595, 1.600), (0.580, 1.760), (0.555, 1.920), (0.540, 2.060),
    (0.540, 2.160), (0.536, 2.176), (0.524, 2.180), (0.512, 2.172), (0.508, 2.060), (0.522, 1.920),
    (0.546, 1.760), (0.560, 1.600), (0.555, 1.460), (0.524, 1.330), (0.462, 1.220), (0.370, 1.130),
    (0.240, 1.070), (0.120, 1.040), (0.00, 1.030),
]  # fmt: skip

Triangle = tuple[int, int, int]


def lathe(chance: random.Random) -> tuple[np.ndarray, list[Triangle]]:
    """Turn the profile about the y axis; its two ends lie on the axis."""
    ring = PROFILE[1:-1]
    vertices = [(0.0, PROFILE[0][1], 0.0)]
    for radius, height in ring:
        for segment in range(SEGMENTS):
            angle = 2.0 * math.pi * segment / SEGMENTS
            vertices.append((radius * math.cos(angle), height, radius * math.sin(angle)))
    vertices.append((0.0, PROFILE[-1][1], 0.0))
    last = len(vertices) - 1

    def at(row: int, segment: int) -> int:
        return 1 + row * SEGMENTS + segment % SEGMENTS

    triangles: list[Triangle] = []
    for segment in range(SEGMENTS):
        triangles.append((0, at(0, segment), at(0, segment + 1)))
        triangles.append((last, at(len(ring) - 1, segment + 1), at(len(ring) - 1, segment)))
        for row in range(len(ring) - 1):
            a, b = at(row, segment), at(row, segment + 1)
            c, d = at(row + 1, segment + 1), at(row + 1, segment)
            triangles += [(a, d, c), (a, c, b)] if chance.random() < 0.5 else [(a, d, b), (b, d, c)]
    return np.array(vertices), triangles


def spoil(vertices: np.ndarray, triangles: list[Triangle], chance: random.Random) -> tuple[np.ndarray, list[Triangle]]:
    """Add noise, cut holes, double some faces and turn others inside out."""
    noise = [[chance.gauss(0.0, NOISE) for _ in range(3)] for _ in vertices]
    vertices = vertices + np.array(noise)
    centres = vertices[np.array(triangles)].mean(axis=1)
    torn = [(0.42, 1.75, 0.40, 0.17), (-0.58, 1.45, -0.05, 0.12), (0.35, 0.06, -0.30, 0.10)]  # x, y, z, radius
    kept = []
    for triangle, centre in zip(triangles, centres, strict=True):
        in_a_hole = any(math.dist(centre, hole[:3]) < hole[3] for hole in torn)
        if not in_a_hole and chance.random() >= 0.02:
            kept.append(triangle)
    doubled = [triangle for triangle in kept if chance.random() < 0.02]
    every = [(a, c, b) if chance.random() < 0.15 else (a, b, c) for a, b, c in kept + doubled]
    chance.shuffle(every)
    return vertices, every


def place(vertices: np.ndarray) -> np.ndarray:
    """Bring the goblet into its odd pose."""
    x, y, z = (math.radians(angle) for angle in TURN_DEG)
    about_x = np.array([[1, 0, 0], [0, math.cos(x), -math.sin(x)], [0, math.sin(x), math.cos(x)]])
    about_y = np.array([[math.cos(y), 0, math.sin(y)], [0, 1, 0], [-math.sin(y), 0, math.cos(y)]])
    about_z = np.array([[math.cos(z), -math.sin(z), 0], [math.sin(z), math.cos(z), 0], [0, 0, 1]])
    rotation = about_z @ about_y @ about_x
    return np.asarray(SCALE * vertices @ rotation.T + np.array(PLACE))


def goblet_ply() -> str:
    """Return the text of the PLY file."""
    chance = random.Random(SEED)
    vertices, triangles = spoil(*lathe(chance), chance)
    lines = [
        "ply", "format ascii 1.0", "comment made by examples/make_goblet.py",
        f"element vertex {len(vertices)}", "property float x", "property float y", "property float z",
        f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header",
    ]  # fmt: skip
    lines += [f"{x:.3f} {y:.3f} {z:.3f}" for x, y, z in place(vertices)]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("goblet.ply")
    target.write_text(goblet_ply(), encoding="ascii")
    print(f"{target}: {target.stat().st_size} bytes")
