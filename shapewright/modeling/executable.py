"""Executables: programs made ready for the kernel. What is the same for every instance is done ahead."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from shapewright.modeling.opcodes import ALWAYS_BIT, HEADER
from shapewright.modeling.program import SCRATCH, Instruction, Program, Rows

_ALWAYS = np.int64(1) << ALWAYS_BIT


@dataclass(frozen=True, eq=False)
class Executable:
    """What the kernel needs (:mod:`shapewright.modeling.program_kernels`).

    Attributes:
        start: what the rows of every instance begin with.
        code: the instructions.
        constants: numbers that they look at.
        slots: the quantities at x = 1.
        changes: (how, slot, column) a row: what parameters do to the slots.
        angles: (slot of degrees, first of two slots) a row.
        wanted: the rows that make the answer.
    """

    start: Float[np.ndarray, "R 3"]
    code: Int[np.ndarray, " C"]
    constants: Float[np.ndarray, " K"]
    slots: Float[np.ndarray, " S"]
    changes: Int[np.ndarray, "H 3"]
    angles: Int[np.ndarray, "A 2"]
    wanted: Rows

    def run(self, values: Float[np.ndarray, "B P"], present: Bool[np.ndarray, "B N"]) -> Float[np.ndarray, "B V 3"]:
        """Return the wanted rows for each row of settled values, and of which parts there are."""
        from shapewright.modeling import program_kernels

        points = np.empty((len(values), len(self.wanted), 3))
        program_kernels.run(
            *(self.start, self.code, self.constants, self.slots, self.changes, self.angles, self.wanted),
            *(np.ascontiguousarray(values), present, points),
        )
        return points


def multiply(
    matrix: sparse.csr_array, points: Float[np.ndarray, "B V 3"], products: Float[np.ndarray, "B W 3"]
) -> None:
    """Write ``matrix @ points`` (W, 3) of each instance to ``products``."""
    from shapewright.modeling import program_kernels

    starts, columns = (numbers.astype(np.int32, copy=False) for numbers in (matrix.indptr, matrix.indices))
    program_kernels.multiply(starts, columns, matrix.data.astype(np.float64, copy=False), points, products)


def carry_out(program: Program, positions: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "R 3"]:
    """Return what a program makes of the positions at x = 1: the vertices, then the scratch rows."""
    return _carried_out(program, _numbered(program.instructions, len(positions)), positions)


def link(program: Program, part_of: Rows, wanted: Rows) -> Executable:
    """Do what is the same for every instance, and leave out what nobody looks at.

    Args:
        program: of a model.
        part_of: the part of every vertex that was ever created; negative for none.
        wanted: the vertices that are looked at.
    """
    n_vertices = len(part_of)
    n_rows = n_vertices + program.n_scratch
    fixed, varying = _split(_numbered(program.instructions, n_vertices), n_rows)
    start = _carried_out(program, fixed, np.zeros((n_vertices, 3)))
    varying, guards = _guarded(varying, n_rows, part_of, wanted)
    new_row, old_rows = _compacted(varying, n_vertices, program)
    return _executable(program, varying, guards, start[old_rows], wanted, new_row)


def _numbered(instructions: Sequence[Instruction], n_vertices: int) -> list[Instruction]:
    """Put the scratch rows after the vertices."""

    def numbered(rows: Rows) -> Rows:
        is_scratch = rows >= SCRATCH
        return np.where(is_scratch, rows - SCRATCH + n_vertices, rows) if is_scratch.any() else rows

    return [replace(one, sources=numbered(one.sources), targets=numbered(one.targets)) for one in instructions]


def _carried_out(
    program: Program, instructions: Sequence[Instruction], positions: Float[np.ndarray, "V 3"]
) -> Float[np.ndarray, "R 3"]:
    start = np.concatenate([positions, np.zeros((program.n_scratch, 3))])
    every_row = np.arange(len(start))
    executable = _executable(program, instructions, [_ALWAYS] * len(instructions), start, every_row, every_row)
    plain = replace(executable, changes=executable.changes[:0], angles=executable.angles[:0])
    return plain.run(np.ones((1, 0)), np.ones((1, 0), dtype=bool))[0]


def _executable(
    program: Program,
    instructions: Sequence[Instruction],
    guards: Sequence[np.int64],
    start: Float[np.ndarray, "R 3"],
    wanted: Rows,
    new_row: Rows,
) -> Executable:
    lengths = [HEADER + len(one.numbers) + len(one.sources) + len(one.targets) for one in instructions]
    code = np.empty(sum(lengths), dtype=np.int64)
    at = 0
    for one, guard, length in zip(instructions, guards, lengths, strict=True):
        header = [one.opcode, length, int(guard), one.slot, len(one.numbers), len(one.sources), *one.numbers]
        targets = at + length - len(one.targets)
        code[at : at + len(header)] = header
        code[at + len(header) : targets] = new_row[one.sources]
        code[targets : at + length] = new_row[one.targets]
        at += length
    return Executable(
        start=start,
        code=code,
        constants=np.array(program.constants, dtype=np.float64),
        slots=np.array(program.slots, dtype=np.float64),
        changes=np.array(program.changes, dtype=np.int64).reshape(-1, 3),
        angles=np.array(program.angles, dtype=np.int64).reshape(-1, 2),
        wanted=wanted,
    )


def _split(instructions: Sequence[Instruction], n_rows: int) -> tuple[list[Instruction], list[Instruction]]:
    """Tell instructions that are the same for every instance, and can be done before the others, from the others.

    Such a one has no parameter, reads nothing that one of the others before it wrote, and writes nothing that one of
    them wrote or read.
    """
    fixed, varying = [], []
    read, written = np.zeros(n_rows, dtype=bool), np.zeros(n_rows, dtype=bool)
    for one in instructions:
        depends = one.varied or one.part is not None or written[one.sources].any() or written[one.targets].any()
        if depends or read[one.targets].any():
            varying.append(one)
            read[one.sources] = True
            written[one.targets] = True
        else:
            fixed.append(one)
    return fixed, varying


def _guarded(
    instructions: Sequence[Instruction], n_rows: int, part_of: Rows, wanted: Rows
) -> tuple[list[Instruction], list[np.int64]]:
    """Leave out what has no say in a wanted vertex, and tell of the others for which parts alone they are done.

    What is done for one part alone need not be done where that part is absent and drawn together in the end.
    """
    bits = np.array([np.int64(1) << part if 0 <= part < ALWAYS_BIT else _ALWAYS for part in part_of], dtype=np.int64)
    asked = np.zeros(n_rows, dtype=np.int64)
    """For each row, on the way back from the end: the parts for whose sake it is looked at."""
    asked[wanted] = _ALWAYS
    kept, guards = [], []
    for one in reversed(instructions):
        for_whom = np.bitwise_or.reduce(asked[one.targets])
        if not for_whom:
            continue
        kept.append(one)
        guards.append(for_whom)
        if one.part is not None:
            asked[one.targets] = np.where(asked[one.targets] != 0, bits[one.targets], 0)
        elif one.fresh:
            asked[one.targets] = 0
        asked[one.sources] |= for_whom
    return kept[::-1], guards[::-1]


def _compacted(instructions: Sequence[Instruction], n_vertices: int, program: Program) -> tuple[Rows, Rows]:
    """Give scratch rows new numbers: those that are filled ahead keep a row each, operations share the others.

    Returns:
        The new number of every row, and of every new row one that it had before.
    """
    n_rows = n_vertices + program.n_scratch
    read, written = np.zeros(n_rows, dtype=bool), np.zeros(n_rows, dtype=bool)
    for one in instructions:
        read[one.sources] = True
        written[one.targets] = True
    scratch = np.arange(n_vertices, n_rows)
    filled = scratch[read[scratch] & ~written[scratch]]
    shared = scratch[written[scratch]]
    operation = np.searchsorted(np.array(program.operations), shared - n_vertices, side="right")
    rank = np.arange(len(shared)) - np.searchsorted(operation, operation)
    new_row = np.zeros(n_rows, dtype=np.int64)
    new_row[:n_vertices] = np.arange(n_vertices)
    new_row[filled] = n_vertices + np.arange(len(filled))
    new_row[shared] = n_vertices + len(filled) + rank
    old_rows = np.concatenate([np.arange(n_vertices), filled, shared[:0]])
    if len(shared):
        old_rows = np.concatenate([old_rows, np.full(rank.max() + 1, shared[0])])
    return new_row, old_rows
