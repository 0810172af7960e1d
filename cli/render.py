"""`shapewright render`: a picture of a mesh or of a procedural model."""

import math
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from cli.console import AsJson, print_json
from cli.picture import save_picture
from cli.sources import load_compiled, read_assignments
from models_store.library.shipped import list_shipped
from shapewright.errors import RenderingError


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
    size: Annotated[int, typer.Option(min=16, max=4096, help="Width and height in pixels.")] = 512,
    style: Annotated[Style, typer.Option(help="shaded for people; edges is what the classifier sees.")] = Style.shaded,
    up: Annotated[Up, typer.Option(help="The axis that points upwards; z for the models that ship.")] = Up.z,
    turn: Annotated[float, typer.Option(help="Degrees around the upright axis.")] = 35.0,
    tilt: Annotated[float, typer.Option(help="Degrees that the camera looks down.")] = 22.0,
    assignments: Annotated[
        list[str] | None, typer.Option("--set", "-s", metavar="NAME=X", help="A parameter value of a model.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Draw a mesh or a procedural model into a PNG file, with headless OpenGL.

    Examples:

      [bold]shapewright render chair.obj -o chair.png[/]
      [bold]shapewright render table --set leg_length=1.3 --turn 45 -o table.png[/]
    """
    if output.suffix.lower() != ".png":
        raise RenderingError("pictures are written as .png", where=str(output))
    from shapewright.mesh_file import load_mesh
    from shapewright.rendering import render_mesh, three_quarter_view

    if source in list_shipped() or source.endswith(".json"):
        compiled = load_compiled(source)
        mesh = compiled.instance(compiled.values_from_mapping(read_assignments(assignments, None)))
    else:
        mesh = load_mesh(source, in_child=True)
    view = three_quarter_view(up.value, azimuth_rad=math.radians(turn), elevation_rad=math.radians(tilt))
    pixels = render_mesh(mesh, rotation=view, size=size, style=style.value)
    output.parent.mkdir(parents=True, exist_ok=True)
    save_picture(pixels, output)
    if as_json:
        print_json({"file": str(output), "width": size, "height": size, "style": style.value})
    else:
        typer.echo(str(output))
