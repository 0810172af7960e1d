"""Programs: the operations of a model as a flat list of instructions, which a compiled kernel carries out.

An instruction reads and writes *rows*, one point of space each: the vertices of the control mesh by their ids, and
scratch rows for what an operation needs in between (a frame takes the rows of u, v and z, a pivot takes one). Numbers
that parameters change stand in *slots*.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from shapewright.modeling import opcodes

Rows = Int[np.ndarray, " _"]

SCRATCH = 2**32
"""Number of the first scratch row: nobody knows how many vertices there will be while a program is written."""


@dataclass(frozen=True, eq=False)
class Instruction:
    """One step of a program; :mod:`shapewright.modeling.opcodes` says what each needs.

    Attributes:
        opcode: what to do.
        sources: rows that have a say in everything that is written.
        targets: rows that are written, each from the sources and, if not ``fresh``, from itself.
        numbers: further operands.
        slot: the first slot that it looks at, or -1.
        fresh: whether the former content of the targets is of no account.
        varied: whether a parameter changes what it looks at in the slots.
        part: the part that is drawn together where it is absent, if that is what the instruction does.
    """

    opcode: int
    sources: Rows
    targets: Rows
    numbers: tuple[int, ...] = ()
    slot: int = -1
    fresh: bool = False
    varied: bool = False
    part: int | None = None


@dataclass(frozen=True)
class Change:
    """A parameter changes a quantity of an operation: a mode of Table 1 consists of such changes.

    Attributes:
        quantity: the name of the quantity.
        how: ``MULTIPLY``, ``HALF_TURNS`` or ``SLIDE``.
    """

    quantity: str
    how: int


Changes = Sequence[tuple[Change, int]]
"""Changes of an operation's quantities and the columns of the parameters, in the order in which they are made."""


class Program:
    """What a model's operations write, one after the other."""

    def __init__(self) -> None:
        self.instructions: list[Instruction] = []
        self.constants: list[float] = []
        self.slots: list[float] = []
        """The numbers in the slots as they are at x = 1."""
        self.changes: list[tuple[int, int, int]] = []
        """(how, slot, column): what parameters change, in this order."""
        self.angles: list[tuple[int, int]] = []
        """(slot of degrees, first of two slots): the cosine and the sine are taken when the changes are done."""
        self.n_scratch = 0
        self.operations: list[int] = []
        """The number of scratch rows at the start of each operation: what one left in them no other one looks at."""

    def begin_operation(self) -> None:
        """Say that what follows belongs to another operation."""
        self.operations.append(self.n_scratch)

    def add(
        self,
        opcode: int,
        sources: Sequence[int],
        targets: Sequence[int],
        numbers: Iterable[int] = (),
        *,
        fresh: bool = False,
        quantities: "SlottedQuantities | None" = None,
        part: int | None = None,
    ) -> None:
        """Append an instruction; see :class:`Instruction`."""
        self.instructions.append(
            Instruction(
                opcode,
                np.asarray(sources, dtype=np.int64),
                np.asarray(targets, dtype=np.int64),
                tuple(numbers),
                quantities.first if quantities else -1,
                fresh,
                quantities.varied if quantities else False,
                part,
            )
        )

    def scratch(self, count: int) -> range:
        """Return new rows for what is needed in between."""
        first = SCRATCH + self.n_scratch
        self.n_scratch += count
        return range(first, first + count)

    def keep(self, numbers: Iterable[float]) -> int:
        """Keep constants for an instruction; return where they begin."""
        first = len(self.constants)
        self.constants += numbers
        return first

    def constant_rows(self, points: Float[np.ndarray, "N 3"]) -> range:
        """Return scratch rows that hold these points."""
        rows = self.scratch(len(points))
        self.add(opcodes.SET, (), rows, (self.keep(points.ravel().tolist()),), fresh=True)
        return rows

    def mean(self, vertices: Sequence[int]) -> range:
        """Return the scratch row of the mean of some vertices."""
        row = self.scratch(1)
        self.add(opcodes.CENTRE, vertices, row, fresh=True)
        return row


class SlottedQuantities:
    """The procedure parameters (Table 1) of one operation, in slots that lie side by side.

    Attributes:
        first: slot of the first quantity.
        varied: whether a parameter changes any of them.
    """

    def __init__(self, program: Program, amounts: Mapping[str, float], changes: Changes, angle: str = "") -> None:
        """Lay them down.

        Args:
            program: that needs them.
            amounts: the quantities at x = 1, in the order of their slots.
            changes: what the columns of the parameters do to them, in order.
            angle: the quantity in degrees whose cosine and sine come after the others; "" if there is none.
        """
        self.first = len(program.slots)
        names = list(amounts)
        program.slots += amounts.values()
        changed = {change.quantity for change, _ in changes}
        program.changes += [(each.how, self.first + names.index(each.quantity), column) for each, column in changes]
        self.varied = bool(changed)
        self._amounts = amounts
        self._changed = changed
        if angle:
            angle_rad = np.radians(amounts[angle])
            if angle in changed:
                program.angles.append((self.first + names.index(angle), len(program.slots)))
            program.slots += [float(np.cos(angle_rad)), float(np.sin(angle_rad))]

    def always(self, name: str, amount: float) -> bool:
        """Tell whether a quantity has this amount in every instance."""
        return name not in self._changed and self._amounts[name] == amount
