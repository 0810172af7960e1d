"""The command as a whole: it teaches, it is fast to ask for help, and it refuses in one line."""

import subprocess
import sys
from pathlib import Path

import pytest
from command_line import shapewright

VERBS = ("models", "instance", "render", "train", "classify", "estimate", "evaluate", "serve", "demo")


def test_help_names_every_verb() -> None:
    outcome = shapewright("--help")
    assert outcome.status == 0
    for verb in VERBS:
        assert f" {verb} " in outcome.stdout


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_teaches_with_an_example_and_takes_json(verb: str) -> None:
    outcome = shapewright(verb, "--help")
    assert outcome.status == 0
    assert "Examples:" in outcome.stdout
    assert "--json" in outcome.stdout


@pytest.mark.parametrize("verb", ["list", "show", "validate"])
def test_the_verbs_about_models_do_too(verb: str) -> None:
    outcome = shapewright("models", verb, "--help")
    assert "Example" in outcome.stdout
    assert "--json" in outcome.stdout


def test_without_a_verb_it_helps() -> None:
    assert "instance" in shapewright().stdout
    assert "validate" in shapewright("models", "--help").stdout


def test_a_missing_option_is_one_line_that_says_where_help_is() -> None:
    message = shapewright("instance", "table").refused()
    assert "--output" in message
    assert "shapewright instance --help" in message


def test_an_unknown_verb_is_one_line() -> None:
    assert "instanze" in shapewright("instanze").refused()


def test_help_loads_nothing_heavy() -> None:
    heavy = ("numpy", "trimesh", "scipy", "torch", "numba", "onnxruntime", "moderngl", "fastapi", "celery")
    program = (
        "import sys\n"
        "sys.argv = ['shapewright', '--help']\n"
        "import contextlib, io\n"
        "from cli.app import main\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n"
        "    main()\n"
        f"print([name for name in {heavy!r} if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_installed_command_and_the_module_are_the_same_program(tmp_path: Path) -> None:
    installed = Path(sys.executable).with_name("shapewright")
    for command in ([installed], [sys.executable, "-m", "cli"]):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True, cwd=tmp_path)
        assert done.stdout.strip().count(".") == 2
        refused = subprocess.run([*command, "models", "show", "x"], capture_output=True, text=True, cwd=tmp_path)
        assert refused.returncode == 2
        assert refused.stderr.startswith("shapewright: 'x': neither a file nor a shipped model")
