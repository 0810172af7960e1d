"""Numbers of the instructions that :mod:`shapewright.modeling.program_kernels` carries out, and their operands.

An instruction is ``HEADER`` whole numbers (its own number, its length, its guard, its first slot, how many numbers and
how many sources it has), then its numbers, its sources and its targets
(:class:`shapewright.modeling.program.Instruction`).

A compiled kernel keeps the numbers that it was compiled with, and numba's cache looks only at the date of the file in
which a kernel stands: whoever changes a number here touches that file too.
"""

from typing import Final

HEADER: Final = 6

ALWAYS_BIT: Final = 62
"""A guard has a bit for each of the first 62 parts, and this one for the other parts and for what is always there."""

SET: Final = 0
"""numbers: first constant. Targets take the constants, three each."""
FRAME: Final = 1
"""numbers: how many loops, and their lengths. sources: the ends of the first edge, the loops. targets: u, v, z."""
IMAGE: Final = 2
"""numbers: first of nine constants, a matrix. sources: u, v, z. targets: their images."""
CENTRE: Final = 3
"""sources: vertices. target: their mean."""
PLACE: Final = 4
"""numbers: first constant, three a point. sources: u, v, z, and perhaps a centre. targets: the points, placed there."""
DRAG: Final = 5
"""slots: rho, phi_deg, z, and the cosine and sine of phi. sources: u, v, z. targets: what moves."""
EXTRUDE: Final = 6
"""slots: as in a drag. sources: u, v, z, the old loop. targets: the new loop."""
BEND: Final = 7
"""numbers: first of twelve constants, the turn and the mean normal. slots: width, length. sources: u, v, z, the centre,
the old loop. targets: the new loop."""
INSERT: Final = 8
"""slot: lambda1. sources: start, end. target: the vertex between them."""
STRETCH: Final = 9
"""numbers: along x, y, z (0 or 1). slot: sigma. sources: the pivot. targets: what moves."""
SCALE: Final = 10
"""numbers: along u, v, z (0 or 1). slot: sigma. sources: the pivot, u, v, z. targets: what moves."""
ROTATE: Final = 11
"""numbers: 0, 1 or 2 for the axis u, v or z. slots: alpha_deg, its cosine and sine. sources: the pivot, u, v, z.
targets: what moves."""
COLLAPSE: Final = 12
"""numbers: the part. sources: where to. targets: the part's vertices, drawn there where the part is absent."""

MULTIPLY: Final = 0
"""How a parameter x changes a quantity q: into x q,"""
HALF_TURNS: Final = 1
"""into q + 180 (x - 1),"""
SLIDE: Final = 2
"""into x q, or from q >= 0.5 on the mirror image of that, 1 - (2 - x) (1 - q)."""
