"""The `shapewright` command: one file a verb, heavy imports only inside the verbs."""

import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import typer
from typer.core import TyperGroup

from cli import classify, demo, estimate, evaluate, instance, models, render, retrieve, serve, train
from cli.console import flowing
from shapewright.errors import Cancelled, ShapewrightError

EPILOG = (
    "Start here: [bold]shapewright models list[/], then [bold]shapewright instance table -o table.glb[/]. "
    "Every verb takes [bold]--json[/]: one JSON document on stdout, progress on stderr."
)


class OneLineErrors(TyperGroup):
    """Turns whatever was wrong with the input into one line on stderr and exit status 2."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        windows_expand_args: bool = True,
        **extra: Any,
    ) -> Any:
        """Run a command line; exits unless ``standalone_mode`` is false."""
        arguments = (args, prog_name, complete_var, False, windows_expand_args)
        if not standalone_mode:
            return super().main(*arguments, **extra)
        try:
            status = super().main(*arguments, **extra)
        except typer.TyperException as error:
            _refuse(" ".join(error.format_message().split()) + _help_hint(error))
        except Cancelled as error:
            _refuse(str(error), status=130)
        except ShapewrightError as error:
            _refuse(str(error))
        except OSError as error:
            _refuse(f"{error.filename}: {error.strerror}" if error.filename else str(error))
        except typer.Abort:
            _refuse("stopped", status=130)
        sys.exit(status if isinstance(status, int) else 0)


def _refuse(message: str, *, status: int = 2) -> NoReturn:
    print(f"shapewright: {message}", file=sys.stderr)
    sys.exit(status)


def _help_hint(error: typer.TyperException) -> str:
    path = getattr(getattr(error, "ctx", None), "command_path", None)
    return f" ({path} --help tells more)" if path else ""


app = typer.Typer(
    name="shapewright",
    cls=OneLineErrors,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=EPILOG,
)


@app.callback(invoke_without_command=True)
def shapewright(
    context: typer.Context, version: bool = typer.Option(False, "--version", help="Print the version.")
) -> None:
    """Tells what an unknown 3D mesh is and which parameter values rebuild it.

    The only training data are procedural models: JSON files that say how to model one class of objects.
    """
    if version:
        from importlib.metadata import version as installed_version

        typer.echo(installed_version("shapewright"))
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


app.add_typer(models.app, name="models")
app.add_typer(evaluate.app, name="evaluate")
for verb in (
    instance.instance,
    render.render,
    train.train,
    classify.classify,
    retrieve.retrieve,
    estimate.estimate,
    serve.serve,
    demo.demo,
):
    app.command(verb.__name__, help=flowing(verb.__doc__))(verb)


def main() -> None:
    """Entry point of the installed command."""
    # Idle OpenMP threads would spin until the next kernel, and slow down the code that runs in between.
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    app()
