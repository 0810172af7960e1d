"""Options that every evaluation has, and what they choose."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shapewright.errors import EvaluationError

if TYPE_CHECKING:
    from shapewright.evaluation.datasets import LabelledFile

DatasetFolder = Annotated[
    Path, typer.Option("--dataset", help="Folder with labels.csv (columns file, class).", show_default=False)
]
ReportFile = Annotated[
    Path | None, typer.Option("--report", help="HTML file to write, with pictures inside.", show_default=False)
]
Limit = Annotated[
    int | None,
    typer.Option(min=1, help="Take this many meshes, spread over the classes.", show_default=False),
]
Classes = Annotated[
    str | None, typer.Option(metavar="A,B", help="Take meshes of these classes only.", show_default=False)
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all random choices.")]
Jobs = Annotated[
    int | None,
    typer.Option(
        min=1, max=256, help="Threads and processes (default: as many as there are cores).", show_default=False
    ),
]
ClassifierFile = Annotated[
    Path | None,
    typer.Option(
        "--classifier",
        "-c",
        help="The .onnx file of `shapewright train` (default: the classifier that ships).",
        show_default=False,
    ),
]
Threshold = Annotated[
    float,
    typer.Option(min=0.0, max=1.0, help="Answer `unknown` where `known` is below."),
]
CacheFolder = Annotated[
    Path | None,
    typer.Option(
        "--cache", help="Folder for what later runs can use again (default: in the user's cache).", show_default=False
    ),
]


def names_in(text: str | None) -> list[str] | None:
    """Split ``a,b``; ``None`` stays ``None``."""
    return None if text is None else [name.strip() for name in text.split(",") if name.strip()]


def chosen_meshes(
    items: "Sequence[LabelledFile]", classes: str | None, limit: int | None
) -> "tuple[LabelledFile, ...]":
    """Return the meshes of ``--classes a,b``, of all classes by default, and at most ``--limit`` of them.

    Raises:
        EvaluationError: no mesh has one of the classes.
    """
    from shapewright.evaluation.datasets import of_classes, spread

    wanted = names_in(classes)
    chosen = spread(items if wanted is None else of_classes(items, wanted), limit)
    if not chosen:
        raise EvaluationError("no mesh of the dataset has one of these classes", where="--classes")
    return chosen


def cache_folder(chosen: Path | None, purpose: str) -> Path:
    """Return the folder to keep things in: the chosen one, or one in the user's cache."""
    if chosen is not None:
        return chosen
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "shapewright" / purpose


@contextmanager
def threads(jobs: int | None) -> Iterator[int]:
    """Let compiled kernels use this many threads at most; yields how many they use."""
    import numba

    available = numba.get_num_threads()
    used = available if jobs is None else jobs
    numba.set_num_threads(min(used, available))
    try:
        yield used
    finally:
        numba.set_num_threads(available)
