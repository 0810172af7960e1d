"""Runs the `shapewright` command inside the test process, and a small model to run it on."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

_PROGRESS = re.compile(r"\w+: +\d+% ")


@dataclass(frozen=True)
class Outcome:
    """Exit status and what was printed."""

    status: int
    stdout: str
    stderr: str

    @property
    def document(self) -> Any:
        """The one JSON document on stdout."""
        return json.loads(self.stdout)

    def refused(self) -> str:
        """The message of a refusal: exit status 2, nothing on stdout, one line on stderr.

        A slow machine reports its progress before.
        """
        assert self.status == 2, (self.status, self.stdout, self.stderr)
        assert self.stdout == ""
        lines = [line for line in self.stderr.strip().splitlines() if not _PROGRESS.match(line)]
        assert len(lines) == 1, self.stderr
        assert lines[0].startswith("shapewright: ")
        return lines[0].removeprefix("shapewright: ")


def shapewright(*arguments: str | Path) -> Outcome:
    """Run one command line."""
    from cli.app import app

    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return Outcome(result.exit_code, result.stdout, result.stderr)


def write_lamp_model(folder: Path) -> Path:
    """Write a model with two parameters: a box on whose top a post of variable length and width stands."""
    from shapewright.modeling import Recorder

    recorder = Recorder("lamp", "lamp", description="a post on a box")
    box = recorder.box(1.0, 1.0, 0.3)
    recorder.extrude(box.top, 0.05)
    recorder.scale(box.top, 0.3, size="post_width")
    recorder.extrude(box.top, 1.0, length="post_length")
    recorder.parameter("post_length", "length of the post", 0.5, 2.0, unit="mm", base_value=100.0)
    recorder.parameter("post_width", "width of the post", 0.5, 1.5)
    path = folder / "lamp.json"
    recorder.build().save(path)
    return path
