"""`shapewright models`: the procedural models that ship, and files of your own."""

import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.report import conditions_text, model_table, symmetry_text
from cli.sources import load_model
from models_store.library.shipped import list_shipped, load_shipped
from shapewright.errors import ShapewrightError
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

if TYPE_CHECKING:
    from shapewright.modeling import Parameter, ProceduralModel

_Request = tuple[str, int, int]
"""A file or name, how many variations, their seed."""

app = typer.Typer(rich_markup_mode="rich")


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
    """List the procedural models that ship, by class.

    Example:  [bold]shapewright models list --json[/]
    """
    found = sorted((load_shipped(name) for name in list_shipped()), key=lambda model: (model.class_name, model.name))
    if as_json:
        print_json({"models": [_summary(model) for model in found]})
        return
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    table.add_column("class", no_wrap=True, style="bold")
    table.add_column("name", no_wrap=True)
    table.add_column("parameters", justify="right", no_wrap=True)
    table.add_column("operations", justify="right", no_wrap=True)
    table.add_column("digest", no_wrap=True, style="dim")
    above = None
    for model in found:
        class_name = "" if model.class_name == above else model.class_name
        above = model.class_name
        counts = (str(len(model.parameters)), str(len(model.operations)))
        table.add_row(class_name, model.name, *counts, model.digest[:12])
    stdout().print(table)
    stdout().print("\n[dim]shapewright models show NAME tells more about one.[/]")


@app.command("show")
def show_model(
    model: Annotated[str, typer.Argument(help="Name of a shipped model, or a JSON file.", show_default=False)],
    as_json: AsJson = False,
) -> None:
    """Show one procedural model: its parameters, their ranges, units and options, its optional parts and symmetry.

    A value x is relative: 1 is the base model, and the measure shown is x times the base value. A parameter that
    depends on others counts only where it says so.

    Examples:  [bold]shapewright models show table[/]   [bold]shapewright models show my-model.json --json[/]
    """
    loaded = load_model(model)
    if as_json:
        parts = [
            {"name": part.name, "present_when": [asdict(condition) for condition in part.present_when]}
            for part in loaded.parts
        ]
        symmetry = {"mirrors": loaded.symmetry.mirrors, "axis": loaded.symmetry.axis, "order": loaded.symmetry.order}
        parameters = [_parameter(parameter) for parameter in loaded.parameters]
        print_json({**_summary(loaded), "parameters": parameters, "parts": parts, "symmetry": symmetry})
        return
    console = stdout()
    console.print(f"[bold]{loaded.name}[/] · class {loaded.class_name} · {len(loaded.operations)} operations")
    if loaded.description:
        console.print(loaded.description, markup=False)
    console.print(model_table(loaded))
    for part in loaded.parts:
        console.print(f"part {part.name}: only if {conditions_text(part.present_when, loaded)}", markup=False)
    console.print(f"symmetry {symmetry_text(loaded.symmetry)}")
    console.print(f"digest {loaded.digest}")


@app.command("validate")
def validate_models(
    files: Annotated[
        list[str] | None, typer.Argument(help="JSON files (or names of shipped models).", show_default=False)
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Check every model that ships.")] = False,
    variations: Annotated[int, typer.Option(min=0, help="Random variations of each model.")] = 1000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the variations.")] = 0,
    jobs: Annotated[int, typer.Option(min=1, max=256, help="Models that are checked at once.")] = 1,
    as_json: AsJson = False,
) -> None:
    """Check procedural models: the document, replay, topology, symmetry, random variations, effect of parameters.

    Variations must be finite, without faces of no area, no component inside out or floating apart, of a sane extent.
    Exit status 2 if one of the models is not valid.

    Examples:

      [bold]shapewright models validate my-model.json[/]
      [bold]shapewright models validate --all --jobs 4[/]
    """
    if every == bool(files):
        raise typer.BadParameter("name models, or take --all", param_hint="FILES")
    chosen = [(file, variations, seed) for file in (list_shipped() if every else files or [])]
    results = []
    with shown_progress("validating") as progress, _validating(chosen, min(jobs, len(chosen)), progress) as validated:
        for result in validated:
            results.append(result)
            if not as_json:
                _print_validation(result)
    if as_json:
        print_json({"files": results})
    if not all(result["valid"] for result in results):
        raise typer.Exit(2)


@contextmanager
def _validating(requests: Sequence[_Request], jobs: int, progress: Progress) -> Iterator[Iterator[dict[str, Any]]]:
    """Yield the results, one after another or by processes."""
    count = len(requests)
    if jobs == 1:
        parts = (PartialProgress(progress, number / count, (number + 1) / count) for number in range(count))
        yield map(_validate, requests, parts)
        return
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    def told(results: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
        for number, result in enumerate(results, start=1):
            progress.report(number / count, result["file"])
            yield result

    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        yield told(pool.map(_validate, requests))


def _validate(request: _Request, progress: Progress = NULL_PROGRESS) -> dict[str, Any]:
    import numpy as np

    from shapewright.modeling.validation import CHECKS, validate_model

    file, variations, seed = request
    started_s = time.monotonic()
    try:
        loaded = load_model(file)
        shipped = list_shipped().get(file)
        text = None if shipped is None else shipped.read_text(encoding="utf-8")
        rng = np.random.default_rng(seed)
        findings = validate_model(loaded, variations=variations, rng=rng, document=text, progress=progress)
    except ShapewrightError as error:
        return {"file": file, "valid": False, "error": error.message, "where": error.where, "findings": []}
    failed = {finding.check for finding in findings}
    return {
        "file": file,
        "valid": not findings,
        "model": loaded.name,
        "class_name": loaded.class_name,
        "parameters": len(loaded.parameters),
        "digest": loaded.digest,
        "variations": variations,
        "checks": {check: check not in failed for check in CHECKS},
        "findings": [asdict(finding) for finding in findings],
        "seconds": round(time.monotonic() - started_s, 3),
    }


def _print_validation(result: dict[str, Any]) -> None:
    if "error" in result:
        place = result["where"] or result["file"]  # a place begins with the file, as far as there is one
        typer.echo(f"shapewright: {place}: {result['error']}", err=True)
        return
    checks = " ".join(check if good else check.upper() + "!" for check, good in result["checks"].items())
    count = len(result["findings"])
    verdict = "valid" if result["valid"] else f"{count} finding{'s' if count > 1 else ''}"
    counts = f"{result['parameters']} parameters, {result['variations']} variations"
    typer.echo(f"{result['file']}: {verdict} ({counts}; {checks}; {result['seconds']:.1f} s)")
    for finding in result["findings"]:
        place = f"{finding['check']}: {finding['where']}" if finding["where"] else finding["check"]
        typer.echo(f"shapewright: {result['file']}: {place}: {finding['message']}", err=True)


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


def _parameter(parameter: "Parameter") -> dict[str, Any]:
    fields = ("name", "label", "unit", "base_value", "minimum", "maximum")
    return {
        **{field: getattr(parameter, field) for field in fields},
        "options": [{"value": x, "name": option} for x, option in parameter.named_options()],
        "active_when": [asdict(condition) for condition in parameter.active_when],
        "limits": [asdict(limit) for limit in parameter.limits],
    }
