"""A dataset: a folder of labelled meshes.

``labels.csv`` has the columns ``file`` and ``class``, others are ignored. Files are looked up below the folder, or
below its folder ``meshes``; a path that leads out of it is refused.
"""

import csv
import reprlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from shapewright.errors import EvaluationError, MeshFileError
from shapewright.mesh import TriangleMesh
from shapewright.mesh.file import load_meshes

LABELS: Final = "labels.csv"


@dataclass(frozen=True)
class LabelledFile:
    """One row of ``labels.csv``."""

    file: str
    class_name: str
    path: Path


@dataclass(frozen=True)
class Skipped:
    """A mesh that was left out, and why."""

    file: str
    reason: str


def read_dataset(folder: str | Path) -> tuple[LabelledFile, ...]:
    """Read the labels of a folder, in their order.

    Raises:
        EvaluationError: no ``labels.csv``, a column is missing, no row, or a row without a class or a file below the
            folder.
    """
    root = Path(folder)
    source = root / LABELS
    try:
        with source.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.DictReader(file)
            missing = {"file", "class"} - set(reader.fieldnames or ())
            if missing:
                raise EvaluationError(f"the column {sorted(missing)[0]!r} is missing", where=str(source))
            rows = [
                (reader.line_num, str(row["file"] or "").strip(), str(row["class"] or "").strip()) for row in reader
            ]
    except (UnicodeDecodeError, csv.Error) as error:
        raise EvaluationError(f"no table of comma-separated values: {error}", where=str(source)) from None
    except OSError as error:
        raise EvaluationError(f"a dataset is a folder with {LABELS}: {error.strerror}", where=str(source)) from None
    if not rows:
        raise EvaluationError("the dataset has no meshes", where=str(source))
    for line, name, class_name in rows:
        if not name or not class_name:
            raise EvaluationError("a row needs a file and a class", where=f"{source}: line {line}")
        if Path(name).is_absolute() or ".." in Path(name).parts or "\0" in name:
            raise EvaluationError(f"{reprlib.repr(name)} is no path below the folder", where=f"{source}: line {line}")
    return tuple(LabelledFile(name, class_name, _located(root, name)) for _, name, class_name in rows)


def of_classes(items: Iterable[LabelledFile], class_names: Iterable[str]) -> tuple[LabelledFile, ...]:
    """Keep the meshes of these classes."""
    wanted = set(class_names)
    return tuple(item for item in items if item.class_name in wanted)


def spread(items: Sequence[LabelledFile], limit: int | None) -> tuple[LabelledFile, ...]:
    """Take at most ``limit`` meshes, as equally many of each class as there are, evenly spaced within a class.

    The choice depends on the items only, and their order is kept.
    """
    if limit is None or limit >= len(items):
        return tuple(items)
    rows: dict[str, list[int]] = {}
    for index, item in enumerate(items):
        rows.setdefault(item.class_name, []).append(index)
    quota = dict.fromkeys(rows, 0)
    left = limit
    while left:
        for name in [name for name in quota if quota[name] < len(rows[name])][:left]:
            quota[name] += 1
            left -= 1
    chosen = [rows[name][(2 * i + 1) * len(rows[name]) // (2 * n)] for name, n in quota.items() for i in range(n)]
    return tuple(items[index] for index in sorted(chosen))


def load_each(items: Sequence[LabelledFile], *, jobs: int = 1) -> Iterator[tuple[LabelledFile, TriangleMesh | Skipped]]:
    """Read meshes in child processes with limits; see :func:`shapewright.mesh.file.load_meshes`."""
    for item, read in zip(items, load_meshes([item.path for item in items], jobs=jobs), strict=True):
        yield item, Skipped(item.file, read.message) if isinstance(read, MeshFileError) else read


def _located(root: Path, name: str) -> Path:
    direct, below = root / name, root / "meshes" / name
    try:
        return below if not direct.exists() and below.exists() else direct
    except OSError:  # a name too long for the file system; whoever opens it is told
        return direct
