"""What rows are sorted by: a column, or the ratio of two (paper Figure 11)."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from shapewright.errors import EstimationError
from shapewright.estimation.table.rows import Cell, column_of, number, quotient

Item = TypeVar("Item")

NUMBERS: Final = ("layer", "panorama", "surface", "zbuffer", "zbuffer_raw", "seconds")
"""Fixed columns that rows can be sorted by."""
_COLUMN: Final = r"(?:parameter\.)?[a-z][a-z0-9_]{0,63}(?:\.low|\.high)?"
KEY_PATTERN: Final = f"^{_COLUMN}(/{_COLUMN})?$"


@dataclass(frozen=True)
class SortKey:
    """A column of numbers, or the ratio of two.

    Attributes:
        numerator: a column.
        denominator: another one, for a ratio.
    """

    numerator: str
    denominator: str | None = None

    @classmethod
    def parse(cls, text: str) -> "SortKey":
        """Read ``stem_length`` or ``stem_length/bowl_depth``.

        Raises:
            EstimationError: not of that form.
        """
        parts = [part.strip() for part in text.split("/")]
        if not re.fullmatch(KEY_PATTERN, "/".join(parts)):
            raise EstimationError(f"expected a parameter or a ratio like stem_length/bowl_depth, got {text!r}")
        return cls(*parts)

    def check(self, parameters: Iterable[str]) -> None:
        """Refuse a column that no row can have.

        Args:
            parameters: names of those that are numbers, of all models that are tried.

        Raises:
            EstimationError: there is no such column of numbers.
        """
        known = [*NUMBERS, *dict.fromkeys(column_of(name) for name in parameters)]
        for column in self.columns:
            if column.removesuffix(".low").removesuffix(".high") not in known:
                raise EstimationError(f"no column of numbers (these are: {', '.join(known)})", where=column)

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that it is made of."""
        return (self.numerator,) if self.denominator is None else (self.numerator, self.denominator)

    def value(self, cells: Mapping[str, Cell]) -> float | None:
        """Return the value of a row; ``None`` if it has none."""
        if self.denominator is None:
            return number(cells.get(self.numerator))
        return quotient(cells, self.numerator, self.denominator)

    def __str__(self) -> str:
        return "/".join(self.columns)


def sort_by(
    key: SortKey, items: Sequence[Item], cells: Sequence[Mapping[str, Cell]], *, descending: bool = False
) -> list[Item]:
    """Sort items by the values of their cells; those without a value come last, equal ones keep their order."""
    values = [key.value(one) for one in cells]
    order = sorted((value, place) for place, value in enumerate(values) if value is not None)
    if descending:
        order.sort(key=lambda one: (-one[0], one[1]))
    without = [place for place, value in enumerate(values) if value is None]
    return [items[place] for place in [*(place for _, place in order), *without]]
