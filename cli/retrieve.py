"""`shapewright retrieve`: which of these meshes are of a class, like a model, like a mesh?"""

import time
from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.evaluation_options import ClassifierFile, Jobs, cache_folder, threads
from cli.kept_index import IndexedFiles, index_files
from cli.sources import chosen_classifier, classifier_line, classifier_name, find_meshes, load_class, load_compiled
from shapewright.errors import ClassifierError, MeshFileError, ModelError, RenderingError
from shapewright.progress import PartialProgress, Progress

if TYPE_CHECKING:
    from shapewright.estimation import InstanceGenerator, PanoramaBank
    from shapewright.modeling import CompiledModel
    from shapewright.retrieval import ClassQuery, RankedMesh


class EvidenceName(StrEnum):
    """What a ranking is made of."""

    probabilities = "probabilities"
    panorama = "panorama"
    combined = "combined"


SHEET_COLUMNS, SHEET_SIZE = 6, 192


def retrieve(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="FOLDER|MESH...", help="Files of meshes or point clouds, or folders with some.", show_default=False
        ),
    ],
    classifier: ClassifierFile = None,
    class_name: Annotated[
        str | None, typer.Option("--class", help="Find meshes of this class.", show_default=False)
    ] = None,
    model: Annotated[
        str | None,
        typer.Option("--model", "-m", help="Find meshes like this shipped model, or JSON file.", show_default=False),
    ] = None,
    mesh: Annotated[
        Path | None,
        typer.Option(
            "--mesh", dir_okay=False, help="Find meshes like this one, or this point cloud.", show_default=False
        ),
    ] = None,
    evidence: Annotated[
        EvidenceName | None,
        typer.Option(
            help="The classifier's word, panorama distances, or both (default: the classifier's word for a class, in "
            "which the geometry counts already, both for a model or a mesh).",
            show_default=False,
        ),
    ] = None,
    instances: Annotated[
        int,
        typer.Option(
            min=0,
            max=100_000,
            help="Random instances of the class or model that distances are measured to; 0: the base instances alone.",
        ),
    ] = 500,
    limit: Annotated[int, typer.Option(min=1, help="Show this many, the best first.")] = 20,
    index: Annotated[
        Path | None,
        typer.Option(
            "--index",
            help="File to keep what is found out about the meshes in (default: in the user's cache).",
            show_default=False,
        ),
    ] = None,
    sheet: Annotated[
        Path | None,
        typer.Option("--contact-sheet", help="Write a PNG with pictures of what is shown.", show_default=False),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random instances.")] = 0,
    jobs: Jobs = None,
    as_json: AsJson = False,
) -> None:
    """Find meshes: the most probable of a class, or those most like a procedural model or another mesh.

    Every mesh is looked at once; what is found out is kept by the content of the file, so the next query is quick.

    Examples:

      [bold]shapewright retrieve my-meshes --class sword --contact-sheet swords.png[/]
      [bold]shapewright retrieve my-meshes --model sword_katana --evidence panorama[/]
      [bold]shapewright retrieve my-meshes -c classifier.onnx --mesh this.off --limit 5 --json[/]
    """
    if sum(wanted is not None for wanted in (class_name, model, mesh)) != 1:
        raise typer.BadParameter("name one of a class, a model, a mesh", param_hint="--class, --model, --mesh")
    _check_sheet(sheet, limit, with_query=mesh is not None)
    from shapewright.classification import exemplars_file, files_digest, load_classifier
    from shapewright.retrieval import MeshQuery, rank
    from shapewright.retrieval.ranking import default_evidence

    chosen = evidence or EvidenceName(default_evidence(class_name))

    started_s = time.monotonic()
    files = find_meshes(sources, with_clouds=True)
    queried = [] if mesh is None else find_meshes([mesh])
    classifier_file = chosen_classifier(classifier)
    network = load_classifier(classifier_file)
    beside = exemplars_file(classifier_file)
    digest = files_digest(classifier_file.read_bytes(), beside if beside.is_file() else None)
    models = _models(class_name, model, network.class_names, chosen)
    with threads(jobs) as used, shown_progress("retrieving") as progress:
        indexed = index_files(
            list(dict.fromkeys([*files, *queried])),
            network,
            digest,
            kept_in=index,
            jobs=used,
            progress=PartialProgress(progress, 0.0, 0.8),
        )
        rows = indexed.index.rows_of([str(file) for file in files])
        if not rows:
            raise MeshFileError(f"there is no mesh to look through ({_first_reason(indexed, files)})")
        query: ClassQuery | MeshQuery
        if mesh is None:
            query = _class_query(models, chosen, instances, seed, PartialProgress(progress, 0.8, 0.95), class_name)
        else:
            row = indexed.index.rows_of([str(mesh)])
            if not row:
                raise MeshFileError(_first_reason(indexed, queried), where="--mesh")
            query = MeshQuery.of(indexed.index, row[str(mesh)])
        collection = indexed.index.taken(list(rows.values()))
        ranked = rank(collection, query, chosen.value, progress=PartialProgress(progress, 0.95, 1.0))
        shown = ranked[:limit]
        if sheet is not None:
            _draw(sheet, shown, mesh, f"of the class {class_name}" if class_name else f"like {model or 'the query'}")
    if as_json:
        print_json(
            {
                "classifier": classifier_name(classifier),
                "query": {"class": class_name, "model": model, "mesh": mesh and str(mesh)},
                "evidence": chosen.value,
                "n": len(ranked),
                "results": [_document(place, one) for place, one in enumerate(shown, 1)],
                "skipped_count": len(indexed.skipped),
                "skipped": [{"file": skipped.name, "reason": skipped.reason} for skipped in indexed.skipped],
                "index": str(indexed.kept_in),
                "contact_sheet": sheet and str(sheet),
                "seconds": round(time.monotonic() - started_s, 3),
            }
        )
        return
    _print(shown, len(ranked), indexed)
    typer.echo(classifier_line(classifier))
    if sheet is not None:
        typer.echo(str(sheet))


def _check_sheet(sheet: Path | None, limit: int, *, with_query: bool) -> None:
    """Refuse now what could not be written at the end."""
    from shapewright.rendering.sheet import check_sheet_size

    if sheet is None:
        return
    if sheet.suffix.lower() != ".png":
        raise RenderingError("pictures are written as .png", where=str(sheet))
    try:
        check_sheet_size([limit, *([1] if with_query else [])], SHEET_SIZE, SHEET_COLUMNS)
    except RenderingError as error:
        raise RenderingError(error.message, where=f"--limit {limit}") from None


def _models(
    class_name: str | None, model: str | None, known: tuple[str, ...], evidence: EvidenceName
) -> "list[CompiledModel]":
    """Load the models whose instances distances are measured to, and see that the classifier knows their class."""
    loaded = [] if model is None else [load_compiled(model)]
    wanted = loaded[0].model.class_name if loaded else class_name
    if wanted is not None and wanted not in known and evidence != "panorama":
        raise ClassifierError(
            f"the classifier does not know the class {wanted!r} (but: {', '.join(known)})",
            where="--model" if loaded else "--class",
        )
    if class_name is not None and evidence != "probabilities":
        try:
            return load_class(class_name)
        except ModelError as error:
            hint = "name one by --model, or take --evidence probabilities"
            raise ModelError(f"{error.message}; {hint}", where=f"--class {class_name}") from None
    return loaded


def _class_query(
    models: "list[CompiledModel]",
    evidence: EvidenceName,
    instances: int,
    seed: int,
    progress: Progress,
    class_name: str | None,
) -> "ClassQuery":
    from shapewright.classification import gather_instances, instances_of_each
    from shapewright.evaluation.descriptor_cache import BankRequest, DescriptorCache
    from shapewright.retrieval import ClassQuery

    wanted = class_name if class_name is not None else models[0].model.class_name
    if evidence == "probabilities":
        return ClassQuery(wanted)
    cache = DescriptorCache(cache_folder(None, "retrieval"))

    count = instances_of_each(models, instances)

    by_digest = {one.model.digest: one for one in models}

    def banks(generator: "InstanceGenerator", part: Progress) -> "PanoramaBank":
        return cache.bank(BankRequest(by_digest[generator.model.digest], count, seed), part)

    return ClassQuery(wanted, gather_instances(models, banks if count else None, progress=progress))


def _first_reason(indexed: IndexedFiles, files: list[Path]) -> str:
    names = {str(file) for file in files}
    return next(f"{one.name}: {one.reason}" for one in indexed.skipped if one.name in names)


def _draw(sheet: Path, shown: "list[RankedMesh]", mesh: Path | None, wanted: str) -> None:
    from cli.picture import save_picture
    from shapewright.mesh.file import MeshReader, load_query
    from shapewright.rendering import LabelledMesh, compose_mesh_sheet

    with MeshReader() as reader:
        found = (
            LabelledMesh(load_query(one.name, reader=reader), f"{place}. {Path(one.name).name}", one.caption)
            for place, one in enumerate(shown, 1)
        )
        sections: list[tuple[str, Iterable[LabelledMesh]]] = [(f"meshes {wanted}", found)]
        if mesh is not None:
            sections.insert(0, ("query", [LabelledMesh(load_query(mesh, reader=reader), mesh.name)]))
        pixels = compose_mesh_sheet(sections, size=SHEET_SIZE, columns=SHEET_COLUMNS)
    sheet.parent.mkdir(parents=True, exist_ok=True)
    save_picture(pixels, sheet)


def _document(place: int, one: "RankedMesh") -> dict[str, Any]:
    return {
        "rank": place,
        "file": one.name,
        "score": one.score,
        "probability": one.probability,
        "distance": one.distance,
    }


def _print(shown: "list[RankedMesh]", count: int, indexed: IndexedFiles) -> None:
    from rich.markup import escape
    from rich.table import Table

    columns = {
        "rank": [str(place) for place in range(1, len(shown) + 1)],
        "file": [one.name for one in shown],
        "score": [f"{one.score:.4f}" for one in shown],
        "probability": [f"{one.probability:.1%}" for one in shown if one.probability is not None],
        "distance": [f"{one.distance:.4f}" for one in shown if one.distance is not None],
    }
    told = {name: texts for name, texts in columns.items() if texts}
    table = Table(box=None, pad_edge=False)
    for name in told:
        table.add_column(name, justify="left" if name == "file" else "right", overflow="fold")
    for row in zip(*told.values(), strict=True):
        table.add_row(*(escape(text) for text in row))
    stdout().print(table)
    if count > len(shown):
        typer.echo(f"the first {len(shown)} of {count} meshes (--limit)")
    for skipped in indexed.skipped:
        typer.echo(f"skipped {skipped.name}: {skipped.reason}", err=True)
    if indexed.skipped:
        number = len(indexed.skipped)
        typer.echo("1 mesh was skipped" if number == 1 else f"{number} meshes were skipped", err=True)
