"""`shapewright render`: a picture of a mesh or of a procedural model."""

import math
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.console import AsJson, print_json
from cli.picture import save_picture
from cli.sources import load_compiled, read_assignments
from models_store.library.shipped import list_shipped
from shapewright.errors import ParameterError, RenderingError

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Float, UInt8

    from shapewright.mesh import TriangleMesh


class Style(StrEnum):
    """How the surface is drawn."""

    shaded = "shaded"
    edges = "edges"


class Up(StrEnum):
    """The axis of the object that points upwards in the picture."""

    y = "y"
    z = "z"


def render(
    source: Annotated[
        str,
        typer.Argument(
            metavar="MESH|MODEL", help="A mesh file, a shipped model, or a model's JSON.", show_default=False
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="PNG file to write.", show_default=False)],
    size: Annotated[
        int | None,
        typer.Option(
            min=16,
            max=4096,
            help="Width and height in pixels (default: 512, or 192 for each picture of a sheet).",
            show_default=False,
        ),
    ] = None,
    style: Annotated[Style, typer.Option(help="shaded for people; edges is what the classifier sees.")] = Style.shaded,
    up: Annotated[Up, typer.Option(help="The axis that points upwards; z for the models that ship.")] = Up.z,
    turn: Annotated[float, typer.Option(help="Degrees around the upright axis.")] = 35.0,
    tilt: Annotated[float, typer.Option(help="Degrees that the camera looks down.")] = 22.0,
    assignments: Annotated[
        list[str] | None, typer.Option("--set", "-s", metavar="NAME=X", help="A parameter value of a model.")
    ] = None,
    sheet: Annotated[
        bool,
        typer.Option("--contact-sheet", help="Draw a model's base, each parameter at its ends, random variations."),
    ] = False,
    variations: Annotated[int, typer.Option(min=0, max=1000, help="Random variations on a contact sheet.")] = 24,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the variations.")] = 0,
    as_json: AsJson = False,
) -> None:
    """Draw a mesh or a procedural model into a PNG file, with headless OpenGL.

    Examples:

      [bold]shapewright render chair.obj -o chair.png[/]
      [bold]shapewright render table --set leg_length=1.3 --turn 45 -o table.png[/]
      [bold]shapewright render table --contact-sheet -o sheet.png[/]
    """
    if output.suffix.lower() != ".png":
        raise RenderingError("pictures are written as .png", where=str(output))
    if not (math.isfinite(turn) and math.isfinite(tilt)):
        raise RenderingError("an angle is not finite", where="--turn, --tilt")
    from shapewright.rendering import render_mesh, three_quarter_view

    view = three_quarter_view(up.value, azimuth_rad=math.radians(turn), elevation_rad=math.radians(tilt))
    if sheet:
        pixels = _contact_sheet(source, assignments, variations, seed, view, size or 192, style)
    else:
        pixels = render_mesh(_mesh(source, assignments), rotation=view, size=size or 512, style=style.value)
    output.parent.mkdir(parents=True, exist_ok=True)
    save_picture(pixels, output)
    if as_json:
        height, width = pixels.shape[:2]
        print_json({"file": str(output), "width": width, "height": height, "style": style.value})
    else:
        typer.echo(str(output))


def _is_model(source: str) -> bool:
    return source in list_shipped() or source.endswith(".json")


def _mesh(source: str, assignments: list[str] | None) -> "TriangleMesh":
    from shapewright.mesh.file import load_mesh

    if not _is_model(source):
        if assignments:
            raise ParameterError("only a model has parameters", where=f"--set {assignments[0]}")
        return load_mesh(source, in_child=True)
    compiled = load_compiled(source)
    return compiled.instance(compiled.values_from_mapping(read_assignments(compiled.model, assignments, None)))


def _contact_sheet(
    source: str,
    assignments: list[str] | None,
    variations: int,
    seed: int,
    view: "Float[np.ndarray, '3 3']",
    size: int,
    style: Style,
) -> "UInt8[np.ndarray, 'H W 3']":
    import numpy as np

    from shapewright.rendering import compose_contact_sheet

    if not _is_model(source):
        raise RenderingError("only a model has a contact sheet", where=source)
    compiled = load_compiled(source)
    return compose_contact_sheet(
        compiled,
        base=compiled.values_from_mapping(read_assignments(compiled.model, assignments, None)),
        variations=variations,
        rng=np.random.default_rng(seed),
        rotation=view,
        size=size,
        style=style.value,
    )
