"""Reports of evaluations: one HTML file each that needs no other file."""

import base64
import io
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import UInt8
from jinja2 import Environment, PackageLoader, StrictUndefined

from shapewright.estimation.rotation_like import rotation_like
from shapewright.evaluation.coverage import Coverage, Neighbour
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each
from shapewright.evaluation.metrics import ClassCoverage, meshes_of, nearest_class
from shapewright.mesh import TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering import render_mesh, three_quarter_view

PICTURE_SIZE = 200


@dataclass(frozen=True)
class Picture:
    """A picture as a data URI, and the words below it."""

    uri: str
    title: str
    caption: str


@dataclass(frozen=True)
class Pair:
    """A mesh, the nearest variation of its class, and that of another class where it is nearer."""

    pictures: tuple[Picture, ...]


@cache
def templates() -> Environment:
    """Return the templates of the reports; what is filled in is escaped."""
    return Environment(
        loader=PackageLoader("shapewright.evaluation"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def png_uri(pixels: UInt8[np.ndarray, "H W 3"]) -> str:
    """Write a picture into an address that an HTML page can show."""
    from PIL import Image

    png = io.BytesIO()
    Image.fromarray(pixels).save(png, format="PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(png.getvalue()).decode()


def coverage_report(
    coverage: Coverage,
    summed: Mapping[str, ClassCoverage],
    *,
    title: str,
    worst: int = 6,
    jobs: int = 1,
    progress: Progress = NULL_PROGRESS,
) -> str:
    """Write the page of a coverage evaluation: the table, and the worst covered meshes of each class.

    Args:
        coverage: what was measured.
        summed: its figures by class.
        title: name of the dataset.
        worst: meshes of each class that are shown.
        jobs: meshes that are read at once.
        progress: told what is going on; may cancel.

    Raises:
        RenderingError: no headless OpenGL.
    """
    shown = {name: list(meshes_of(coverage, name))[:worst] for name in summed}
    items = [coverage.queries[index].item for found in shown.values() for index, _ in found]
    pairs: dict[LabelledFile, Pair] = {}
    neighbours = {coverage.queries[index].item: near for found in shown.values() for index, near in found}
    for number, (item, mesh) in enumerate(load_each(items, jobs=jobs)):
        progress.report(number / len(items), f"pictures: {number} of {len(items)}")
        if not isinstance(mesh, Skipped):
            pairs[item] = _pair(coverage, item, mesh, neighbours[item])
    compared = sorted({name for figures in summed.values() for name in figures.medians})
    worst_pairs = {
        name: [pairs[item] for item in (coverage.queries[index].item for index, _ in found) if item in pairs]
        for name, found in shown.items()
    }
    return (
        templates()
        .get_template("coverage.html")
        .render(
            title=title,
            summed=summed,
            compared=compared,
            worst=worst_pairs,
            skipped=coverage.skipped,
            n=len(coverage.queries),
            samples=_samples(coverage),
        )
    )


def _samples(coverage: Coverage) -> int:
    totals: dict[str, int] = {}
    for request in coverage.requests.values():
        name = request.compiled.model.class_name
        totals[name] = totals.get(name, 0) + request.samples
    return max(totals.values())


def _pair(coverage: Coverage, item: LabelledFile, mesh: TriangleMesh, near: dict[str, Neighbour]) -> Pair:
    view = three_quarter_view("z")
    own = near[item.class_name]
    best = near[nearest_class(near)]
    variations = [own] if best == own else [own, best]
    meshes = [coverage.requests[one.model].compiled.instance(coverage.values(one)) for one in variations]
    turned = view @ rotation_like(mesh, meshes[0], np.random.default_rng(0))
    pictures = [Picture(png_uri(render_mesh(mesh, rotation=turned, size=PICTURE_SIZE)), item.file, "mesh")]
    for one, variation in zip(variations, meshes, strict=True):
        uri = png_uri(render_mesh(variation, rotation=view, size=PICTURE_SIZE))
        pictures.append(Picture(uri, one.model, f"{one.distance:.4f}"))
    return Pair(tuple(pictures))
