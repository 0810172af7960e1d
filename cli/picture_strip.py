"""The picture strip of an estimated folder: meshes in the order of a parameter or a ratio."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from cli.picture import save_picture
from shapewright.errors import EstimationError

if TYPE_CHECKING:
    from shapewright.estimation.table.rows import TableRow
    from shapewright.estimation.table.sorting import SortKey
    from shapewright.modeling import CompiledModel
    from shapewright.rendering import Pair

MOST: Final = 60
"""Meshes on a strip; of more, so many are taken evenly through their order."""


def save_strip(
    rows: "Sequence[TableRow]",
    files: Mapping[str, Path],
    models: "Sequence[CompiledModel]",
    key: "SortKey | None",
    path: Path,
) -> None:
    """Write a PNG with queries above their fitted meshes, in the order of the rows, the value below each.

    Args:
        rows: sorted; those without an answer, or without the value, are left out.
        files: paths by the names of the rows.
        models: that the answers speak of.
        key: what the rows are sorted by; without it the z-buffer distance stands below.
        path: of the PNG.

    Raises:
        EstimationError: there is nothing to draw.
    """
    from shapewright.estimation.table.rows import cells_of
    from shapewright.estimation.table.sorting import SortKey
    from shapewright.rendering import compose_strip

    shown = key or SortKey("zbuffer")
    valued = [(row, shown.value(cells_of(row))) for row in rows if row.answer is not None]
    drawable = [(row, value) for row, value in valued if value is not None]
    if not drawable:
        raise EstimationError(f"no mesh has a value of {shown} to draw a strip of", where="--strip")
    count = min(MOST, len(drawable))
    chosen = [drawable[round(place * (len(drawable) - 1) / max(count - 1, 1))] for place in range(count)]
    some = "" if count == len(drawable) else f" ({count} of {len(drawable)}, evenly through the order)"
    order = f"by {shown}" if key is not None else "by file"
    pixels = compose_strip(_pairs(chosen, files, models), heading=f"{order}{some}")
    path.parent.mkdir(parents=True, exist_ok=True)
    save_picture(pixels, path)


def _pairs(
    chosen: "Sequence[tuple[TableRow, float]]", files: Mapping[str, Path], models: "Sequence[CompiledModel]"
) -> "Iterator[Pair]":
    """Read each query again, and generate what was fitted to it."""
    import numpy as np

    from shapewright.distances.alignment import Pose
    from shapewright.estimation.record import SHOWN_SUBDIVISION_STEPS
    from shapewright.mesh import TriangleMesh
    from shapewright.mesh.file import load_meshes
    from shapewright.rendering import Pair

    by_digest = {compiled.model.digest: compiled for compiled in models}
    queries = load_meshes([files[row.file] for row, _ in chosen])
    for (row, value), query in zip(chosen, queries, strict=True):
        if row.answer is None or not isinstance(query, TriangleMesh):
            continue
        compiled = by_digest[row.answer["model"]["id"]]
        found = row.answer["pose"]
        pose = Pose(np.array(found["rotation"]), np.array(found["translation"]), found["scale"])
        instance = compiled.instance(np.array(row.answer["values"]), SHOWN_SUBDIVISION_STEPS)
        fitted = TriangleMesh(pose.apply(instance.vertices), instance.faces)
        yield Pair(query, fitted, pose.rotation, Path(row.file).stem, f"{value:.3g}")
