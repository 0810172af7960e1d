"""`shapewright instance`: a mesh of a procedural model, with chosen or random parameter values."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.console import AsJson, print_json
from cli.sources import load_compiled, read_assignments
from shapewright.errors import MeshFileError, ParameterError

MESH_TYPES = ("glb", "obj", "off", "ply", "stl")


def instance(
    model: Annotated[str, typer.Argument(help="Name of a shipped model, or a JSON file.", show_default=False)],
    output: Annotated[
        Path,
        typer.Option("--output", "-o", help="Mesh file: .glb, .obj, .off, .ply or .stl.", show_default=False),
    ],
    assignments: Annotated[
        list[str] | None,
        typer.Option("--set", "-s", metavar="NAME=X", help="A parameter value; 1 is the base model. Repeatable."),
    ] = None,
    values: Annotated[Path | None, typer.Option(help='JSON file {"name": x} of parameter values.')] = None,
    random: Annotated[bool, typer.Option("--random", help="Random values for what --set leaves open.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random values.")] = 0,
    count: Annotated[
        int, typer.Option(min=1, max=10_000, help="How many variations; numbers are added to the file name.")
    ] = 1,
    subdivisions: Annotated[int, typer.Option(min=0, max=4, help="Steps of Catmull-Clark subdivision.")] = 2,
    as_json: AsJson = False,
) -> None:
    """Write a mesh of a procedural model.

    Examples:

      [bold]shapewright instance glass_with_stem -o glass.glb[/]                       the base model
      [bold]shapewright instance table --set leg_length=1.3 -o table.obj[/]            one value changed
      [bold]shapewright instance my-chair.json --set armrests=without -o chair.stl[/]  an option by its name
      [bold]shapewright instance sword --random --seed 7 --count 20 -o swords/s.ply[/]  s-000.ply … s-019.ply
    """
    if output.suffix.lower().lstrip(".") not in MESH_TYPES:
        raise MeshFileError(f"write one of .{', .'.join(MESH_TYPES)}", where=str(output))
    if count > 1 and not random:
        raise ParameterError("several meshes of the same values make no sense; add --random", where="--count")
    import numpy as np

    compiled = load_compiled(model)
    names = [parameter.name for parameter in compiled.model.parameters]
    fixed = read_assignments(compiled.model, assignments, values)
    if random:
        table = compiled.random_values(np.random.default_rng(seed), count, fixed)
    else:
        table = compiled.values_from_mapping(fixed)[None]
    output.parent.mkdir(parents=True, exist_ok=True)
    written: list[dict[str, Any]] = []
    for number, row in enumerate(table):
        path = output if count == 1 else output.with_stem(f"{output.stem}-{number:03d}")
        mesh = compiled.instance(row, steps=subdivisions)
        mesh.save(path)
        written.append(
            {
                "file": str(path),
                "values": dict(zip(names, row.tolist(), strict=True)),
                "vertex_count": len(mesh.vertices),
                "face_count": len(mesh.faces),
                "watertight": bool(mesh.is_watertight),
            }
        )
    if as_json:
        print_json({"model": compiled.model.name, "digest": compiled.model.digest, "instances": written})
        return
    for item in written:
        typer.echo(f"{item['file']}: {item['vertex_count']} vertices, {item['face_count']} triangles")
