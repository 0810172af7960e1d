"""What the verbs print: results on stdout (tables, or one JSON document), progress and remarks on stderr."""

import inspect
import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

from shapewright.progress import CallbackProgress, Progress

if TYPE_CHECKING:
    from rich.console import Console

AsJson = Annotated[
    bool, typer.Option("--json", help="Print one JSON document on stdout and nothing else; progress on stderr.")
]
"""The option that every verb has."""

LINE_INTERVAL_S = 5.0


def flowing(docstring: str | None) -> str:
    """Join the lines of each paragraph, so that help texts fill the terminal; indented lines stay as they are."""
    paragraphs = inspect.cleandoc(docstring or "").split("\n\n")
    joined = (text if text.startswith(" ") else " ".join(text.split("\n")) for text in paragraphs)
    return "\n\n".join(joined)


def stdout() -> "Console":
    """Return a console for results."""
    from rich.console import Console

    return Console(highlight=False)


def stderr() -> "Console":
    """Return a console for progress and remarks."""
    from rich.console import Console

    return Console(stderr=True, highlight=False)


def print_json(document: Any) -> None:
    """Print one JSON document on stdout; arrays and numpy numbers become plain lists and numbers."""
    typer.echo(json.dumps(document, indent=2, ensure_ascii=False, default=_plain))


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in a JSON document")


@contextmanager
def shown_progress(title: str) -> Iterator[Progress]:
    """Show a bar on a terminal, a line every few seconds elsewhere; always on stderr."""
    if not sys.stderr.isatty():
        yield _line_progress(title)
        return
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (
        TextColumn("[bold]{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[message]}"),
    )
    with Bars(*columns, console=stderr(), transient=True) as bars:
        task = bars.add_task(title, total=1.0, message="")
        yield CallbackProgress(lambda fraction, message: bars.update(task, completed=fraction, message=message))


def _line_progress(title: str) -> Progress:
    last_s = time.monotonic()

    def report(fraction: float, message: str) -> None:
        nonlocal last_s
        if time.monotonic() - last_s >= LINE_INTERVAL_S:
            last_s = time.monotonic()
            print(f"{title}: {fraction:4.0%} {message}", file=sys.stderr, flush=True)

    return CallbackProgress(report)
