"""The page of an evaluation of estimations: figures, distributions of distances (Figure 9), examples (Figure 10)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from shapewright.estimation.result import Layer
from shapewright.evaluation.datasets import Skipped
from shapewright.evaluation.estimated import Estimated, EstimatedQueries
from shapewright.evaluation.estimation_cases import Cases
from shapewright.evaluation.estimation_figures import by_class, stage_distances
from shapewright.evaluation.report import Picture, png_uri, templates
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering import compose_side_by_side, three_quarter_view

EXAMPLES: Final = 8
"""Examples of each class, from the best to the worst."""
_SIZE: Final = 180
_WIDTH, _HEIGHT = 420, 220
_COLORS: Final = ("#777777", "#d1661d", "#3c9d4e", "#1d6fd1", "#8a4fc4", "#b8a000", "#00a0a8")


@dataclass(frozen=True)
class Chart:
    """How a distance is distributed after each stage: which share of the queries is below each distance."""

    title: str
    end: float
    threshold: float
    curves: tuple["Curve", ...]


@dataclass(frozen=True)
class Curve:
    """A stage as points of an SVG polyline, and its median."""

    title: str
    color: str
    points: str
    median: float


@dataclass(frozen=True)
class Example:
    """Query, fit and both in one picture, and the layer that the fit comes from."""

    picture: Picture
    layer: Layer


@dataclass(frozen=True)
class EstimatorPart:
    """What one estimator did: its figures, charts and examples by class."""

    name: str
    figures: Mapping[str, Any]
    charts: tuple[Chart, ...]
    examples: Mapping[str, Sequence[Example]]


def estimation_report(
    done: Mapping[str, EstimatedQueries],
    figures: Mapping[str, Mapping[str, Any]],
    cases: Cases,
    models: Mapping[str, CompiledModel],
    *,
    title: str,
    thresholds: Mapping[str, float],
    skipped: Sequence[Skipped],
    progress: Progress = NULL_PROGRESS,
) -> str:
    """Write the page.

    Args:
        done: the estimated queries of each estimator.
        figures: those of each estimator.
        cases: gives the meshes of the examples again.
        models: by name.
        title: what was estimated.
        thresholds: ``surface`` and ``zbuffer``, drawn into the charts.
        skipped: queries that were left out.
        progress: told of every picture; may cancel.

    Raises:
        RenderingError: no headless OpenGL.
    """
    shown = {name: _shown(queries.estimated) for name, queries in done.items()}
    names = {one.name for members in shown.values() for one in members}
    pictures: dict[tuple[str, str], Example] = {}
    for number, (query, mesh) in enumerate(_meshes(cases, names)):
        progress.report(number / len(names), f"pictures: {number} of {len(names)}")
        for estimator, members in shown.items():
            for one in members:
                if one.name == query:
                    pictures[estimator, query] = _example(one, mesh, models)
    parts = [
        EstimatorPart(
            name,
            figures[name],
            tuple(_charts(queries.estimated, thresholds)),
            {
                class_name: [pictures[name, one.name] for one in members if (name, one.name) in pictures]
                for class_name, members in by_class(shown[name]).items()
            },
        )
        for name, queries in done.items()
    ]
    page = templates().get_template("estimation.html")
    return page.render(title=title, parts=parts, width=_WIDTH, height=_HEIGHT, skipped=skipped)


def _shown(estimated: Sequence[Estimated]) -> list[Estimated]:
    """Choose the examples: evenly from the best to the worst of each class by z-buffer distance."""
    chosen = []
    for members in by_class(estimated).values():
        ordered = sorted(members, key=lambda one: one.answer.distances.zbuffer)
        places = np.unique(np.linspace(0, len(ordered) - 1, EXAMPLES).round().astype(int))
        chosen += [ordered[place] for place in places]
    return chosen


def _meshes(cases: Cases, names: set[str]) -> Iterator[tuple[str, TriangleMesh]]:
    for case in cases(names):
        if not isinstance(case, Skipped):
            yield case.name, case.query.mesh


def _example(one: Estimated, query: TriangleMesh, models: Mapping[str, CompiledModel]) -> Example:
    answer = one.answer
    pose = answer.pose
    fitted = models[answer.model].instance(answer.values).transformed(pose.rotation, pose.translation, pose.scale)
    upright = three_quarter_view("z") @ pose.rotation.T
    uri = png_uri(compose_side_by_side(query, fitted, rotation=upright, size=_SIZE))
    distances = f"z-buffer {answer.distances.zbuffer:.3f}, surface {answer.distances.surface:.3f}"
    words = f"{answer.model}, layer {answer.layer}, {distances}, {answer.seconds:.1f} s"
    return Example(Picture(uri, one.name, words), answer.layer)


def _charts(estimated: Sequence[Estimated], thresholds: Mapping[str, float]) -> Iterator[Chart]:
    stages = stage_distances(estimated)
    for name, title in (("surface", "surface distance"), ("zbuffer", "z-buffer distance")):
        values = {stage: np.sort(distances[name]) for stage, distances in stages.items()}
        largest = max((float(np.quantile(found, 0.95)) for found in values.values()), default=0.0)
        end = max(1.25 * thresholds[name], largest)
        curves = (
            Curve(stage, color, _points(found, end), float(np.median(found)))
            for color, (stage, found) in zip(_COLORS, values.items(), strict=False)
        )
        yield Chart(title, end, thresholds[name], tuple(curves))


def _points(values: "np.ndarray[Any, np.dtype[np.float64]]", end: float) -> str:
    """Rise by one step at each value, up to the end of the axis."""
    shares = np.arange(len(values) + 1) / len(values)
    corners = [(0.0, 0.0)]
    for value, below, above in zip(values, shares, shares[1:], strict=False):
        if value > end:
            break
        corners += [(value, below), (value, above)]
    corners.append((end, corners[-1][1]))
    return " ".join(f"{_WIDTH * x / end:.1f},{_HEIGHT * (1.0 - y):.1f}" for x, y in corners)
