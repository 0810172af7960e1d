"""`shapewright models`: the procedural models that ship, and files of your own."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, stdout
from cli.sources import load_compiled, load_model
from models_store.library.shipped import list_shipped, load_shipped
from shapewright.errors import ShapewrightError

if TYPE_CHECKING:
    from shapewright.modeling import ProceduralModel

app = typer.Typer(rich_markup_mode="rich")

VARIATIONS_TRIED = 16


@app.callback(invoke_without_command=True)
def models(context: typer.Context, as_json: AsJson = False) -> None:
    """List, show and validate procedural models; without more words it lists them.

    Examples:

      [bold]shapewright models[/]                      those that ship
      [bold]shapewright models show table --json[/]    ranges and units of one
      [bold]shapewright models validate mine.json[/]   what is wrong, and where
    """
    if context.invoked_subcommand is None:
        list_models(as_json)
    elif as_json:
        raise typer.BadParameter(f"write it after {context.invoked_subcommand}", param_hint="--json")


@app.command("list")
def list_models(as_json: AsJson = False) -> None:
    """List the procedural models that ship.

    Example:  [bold]shapewright models list --json[/]
    """
    found = [load_shipped(name) for name in list_shipped()]
    if as_json:
        print_json({"models": [_summary(model) for model in found]})
        return
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("name", no_wrap=True, style="bold")
    table.add_column("class", no_wrap=True)
    table.add_column("parameters", justify="right", no_wrap=True)
    table.add_column("operations", justify="right", no_wrap=True)
    table.add_column("digest", no_wrap=True, style="dim")
    for model in found:
        counts = (str(len(model.parameters)), str(len(model.operations)))
        table.add_row(model.name, model.class_name, *counts, model.digest[:12])
    stdout().print(table)
    stdout().print("\n[dim]shapewright models show NAME tells more about one.[/]")


@app.command("show")
def show_model(
    model: Annotated[str, typer.Argument(help="Name of a shipped model, or a JSON file.", show_default=False)],
    as_json: AsJson = False,
) -> None:
    """Show one procedural model: its parameters, their ranges and units.

    A value x is relative: 1 is the base model, and the measure shown is x times the base value.

    Examples:  [bold]shapewright models show table[/]   [bold]shapewright models show my-model.json --json[/]
    """
    loaded = load_model(model)
    if as_json:
        print_json({**_summary(loaded), "parameters": [_parameter(p) for p in loaded.parameters]})
        return
    from rich.table import Table

    console = stdout()
    console.print(f"[bold]{loaded.name}[/] · class {loaded.class_name} · {len(loaded.operations)} operations")
    if loaded.description:
        console.print(loaded.description)
    table = Table("parameter", "label", "range of x", "base value")
    for parameter in loaded.parameters:
        base = "" if parameter.base_value is None else f"{parameter.base_value:g} {parameter.unit or ''}"
        table.add_row(parameter.name, parameter.label, f"{parameter.minimum:g} … {parameter.maximum:g}", base)
    console.print(table)
    console.print(f"digest {loaded.digest}")


@app.command("validate")
def validate_models(
    files: Annotated[list[str], typer.Argument(help="JSON files (or names of shipped models).", show_default=False)],
    as_json: AsJson = False,
) -> None:
    """Check procedural models: the document, every operation, and that random variations are finite meshes.

    Exit status 2 if one of them is not valid.

    Example:  [bold]shapewright models validate my-model.json[/]
    """
    results = [_validate(file) for file in files]
    if as_json:
        print_json({"files": results})
    else:
        for result in results:
            if result["valid"]:
                typer.echo(f"{result['file']}: valid ({result['parameters']} parameters)")
            else:
                typer.echo(f"shapewright: {result['file']}: {result['error']}", err=True)
    if not all(result["valid"] for result in results):
        raise typer.Exit(2)


def _validate(file: str) -> dict[str, Any]:
    import numpy as np

    try:
        compiled = load_compiled(file)
        values = compiled.random_values(np.random.default_rng(0), VARIATIONS_TRIED)
        points = compiled.surface_points(np.vstack([compiled.base_values()[None], values]))
    except ShapewrightError as error:
        return {"file": file, "valid": False, "error": error.message, "where": error.where}
    if not np.isfinite(points).all():
        error_text = "some parameter values give coordinates that are not finite"
        return {"file": file, "valid": False, "error": error_text, "where": None}
    return {"file": file, "valid": True, "parameters": len(compiled.model.parameters), "digest": compiled.model.digest}


def _summary(model: "ProceduralModel") -> dict[str, Any]:
    return {
        "name": model.name,
        "class_name": model.class_name,
        "description": model.description,
        "closed": model.closed,
        "operation_count": len(model.operations),
        "parameter_count": len(model.parameters),
        "digest": model.digest,
    }


def _parameter(parameter: Any) -> dict[str, Any]:
    fields = ("name", "label", "unit", "base_value", "minimum", "maximum")
    return {field: getattr(parameter, field) for field in fields}
