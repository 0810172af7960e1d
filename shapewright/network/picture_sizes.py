"""Which pictures a network takes."""

from dataclasses import dataclass

SIZE_STEP = 32
"""A backbone halves its picture five times; other sizes would shift its pixels or leave out a row."""


@dataclass(frozen=True)
class PictureSizes:
    """Sizes of pictures: :data:`SIZE_STEP` · n + ``remainder`` pixels a side.

    Args:
        usual: pixels a side that the network was trained for.
        smallest: pixels a side at least.
        remainder: what is left of a size after whole steps.
    """

    usual: int
    smallest: int = SIZE_STEP
    remainder: int = 0

    def fit(self, size: int) -> bool:
        """Whether pictures of this size are taken."""
        return size >= self.smallest and size % SIZE_STEP == self.remainder

    def __str__(self) -> str:
        first = range(self.smallest, self.smallest + 3 * SIZE_STEP, SIZE_STEP)
        return f"one of {', '.join(map(str, first))}, …, {self.usual}, …"
