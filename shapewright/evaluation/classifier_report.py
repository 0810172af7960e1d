"""The page of a classifier's evaluation: figures, confusion, precision and recall, a picture of every miss."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import cycle
from typing import Any, Final

from shapewright.classification.evidence import OTHER
from shapewright.evaluation.classified import Judged, JudgedDataset
from shapewright.evaluation.datasets import Skipped, load_each
from shapewright.evaluation.report import PICTURE_SIZE, Picture, png_uri, templates
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering import render_mesh, three_quarter_view

MOST_OTHERS: Final = 60
"""Others that were taken for a class, the surest first, that are shown at most."""

_COLORS: Final = ("#1d6fd1", "#d1661d", "#3c9d4e", "#8a4fc4", "#777777", "#b8a000", "#00a0a8")
_WIDTH, _HEIGHT = 420, 260


@dataclass(frozen=True)
class Curve:
    """A curve of precision over recall as points of an SVG polyline."""

    title: str
    color: str
    points: str
    average_precision: float


def classifier_report(
    dataset: JudgedDataset,
    titles: Mapping[str, str],
    *,
    figures: Mapping[str, Mapping[str, Any]],
    curves: Mapping[str, Mapping[str, Any]],
    progress: Progress = NULL_PROGRESS,
) -> str:
    """Write the page.

    Args:
        dataset: what was judged.
        titles: words for each kind of evidence.
        figures: of :class:`shapewright.evaluation.classification_figures.ClassificationFigures`, by evidence.
        curves: of :class:`shapewright.evaluation.retrieval_metrics.RetrievalFigures`, by evidence.
        progress: told of every picture; may cancel.

    Raises:
        RenderingError: no headless OpenGL.
    """
    inside = [one for one in dataset.judged if one.label != OTHER]
    misses = [one for one in inside if one.found.class_name != one.label]
    refused = [one for one in inside if one.found.answer not in (one.label, one.found.class_name)]
    taken = [one for one in dataset.judged if one.label == OTHER and one.found.answer == one.found.class_name]
    surest = sorted(taken, key=lambda one: -(one.found.known or 0.0))[:MOST_OTHERS]
    pictures = _pictures([*misses, *refused, *surest], progress)

    def shown(chosen: list[Judged]) -> list[Picture]:
        return [pictures[one.item.file] for one in chosen if one.item.file in pictures]

    return (
        templates()
        .get_template("classifier.html")
        .render(
            n=len(inside),
            n_other=len(dataset.judged) - len(inside),
            class_names=dataset.class_names,
            titles=titles,
            figures=figures,
            curves=[_curve(titles[name], color, one) for color, (name, one) in zip(cycle(_COLORS), curves.items())],
            width=_WIDTH,
            height=_HEIGHT,
            misses=shown(misses),
            refused=shown(refused),
            taken=shown(surest),
            taken_count=len(taken),
            skipped=dataset.skipped,
        )
    )


def _curve(title: str, color: str, figures: Mapping[str, Any]) -> Curve:
    precision = figures["precision_at_recall"]
    points = " ".join(
        f"{_WIDTH * level / (len(precision) - 1):.1f},{_HEIGHT * (1.0 - value):.1f}"
        for level, value in enumerate(precision)
    )
    return Curve(title, color, points, float(figures["average_precision"]))


def _pictures(chosen: list[Judged], progress: Progress) -> dict[str, Picture]:
    by_item = {one.item: one for one in chosen}
    drawn = {}
    for number, (item, mesh) in enumerate(load_each(list(by_item))):
        progress.report(number / len(by_item), f"pictures: {number} of {len(by_item)}")
        if isinstance(mesh, Skipped):
            continue
        found = by_item[item].found
        known = "" if found.known is None else f", known {found.known:.0%}"
        uri = png_uri(render_mesh(mesh, rotation=three_quarter_view("z"), size=PICTURE_SIZE))
        words = f"{item.class_name}, taken for {found.class_name} ({found.probability:.0%}{known})"
        drawn[item.file] = Picture(uri, item.file, words)
    return drawn
