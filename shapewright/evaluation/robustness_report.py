"""The page of a robustness evaluation: figures by corruption and strength, and pictures of what was done to meshes."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from shapewright.evaluation.conditions import Condition
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.evaluation.datasets import Skipped, load_each
from shapewright.evaluation.report import Picture, png_uri, templates
from shapewright.evaluation.robustness import MeshVerdicts, Robustness, SkippedRun
from shapewright.evaluation.robustness_figures import SHARES, RobustnessFigures, mean_share
from shapewright.evaluation.verdict import Verdict
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.rendering import render_mesh, three_quarter_view

MOST_TURNED: Final = 6
"""Meshes that a corruption turned wrong, the surest first, that are shown at most for each corruption."""
STRENGTHS: Final = ("mild", "middle", "strong")
_TITLES: Final = {
    "accuracy": "right class",
    "accuracy_pictures": "right by pictures",
    "auroc_known": "AUROC",
    "accepted_known": "accepted",
    "refused_other": "others refused",
}
_SIZE: Final = 150
_POINT_RADIUS: Final = 0.006
"""Radius of the dot that shows a point of a cloud, as a share of the bounding box's diagonal."""
_OCTAHEDRON: Final = np.concatenate([np.eye(3), -np.eye(3)])
_OCTAHEDRON_FACES: Final = np.array(
    [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
)


@dataclass(frozen=True)
class CorruptionPart:
    """What the page shows of one corruption.

    Attributes:
        name: of the corruption.
        meaning: of its strength.
        strengths: that were measured, the mildest first.
        shares: each share at these strengths.
        example: the same mesh at these strengths.
        turned: meshes that are right clean and wrong at some strength; each at the mildest such strength.
        turned_count: how many there are of them.
    """

    name: str
    meaning: str
    strengths: Sequence[float]
    shares: Mapping[str, Sequence[float | None]]
    example: Sequence[Picture]
    turned: Sequence[Picture]
    turned_count: int


def robustness_report(
    measured: Robustness,
    figures: RobustnessFigures,
    *,
    title: str,
    seed: int,
    progress: Progress = NULL_PROGRESS,
) -> str:
    """Write the page.

    Args:
        measured: the answers about all meshes.
        figures: those of ``measured``.
        title: name of the dataset.
        seed: of the corruptions, as meshes are corrupted again to be drawn.
        progress: receives a report before every mesh that is drawn; may cancel.

    Raises:
        RenderingError: no headless OpenGL.
    """
    example = _example(measured)
    turned = {name: _turned(measured, name) for name in figures.by_corruption}
    wanted: dict[str, tuple[MeshVerdicts, list[Condition | None]]] = {}
    wanted[example.item.file] = (example, [None, *example.corrupted])
    for found in turned.values():
        for mesh, condition in found[:MOST_TURNED]:
            wanted.setdefault(mesh.item.file, (mesh, []))[1].append(condition)
    pictures = _pictures(wanted, seed, progress)

    def shown(chosen: Sequence[tuple[MeshVerdicts, Condition | None]]) -> list[Picture]:
        keys = [(mesh.item.file, condition) for mesh, condition in chosen]
        return [pictures[key] for key in keys if key in pictures]

    parts = [
        CorruptionPart(
            name=name,
            meaning=CORRUPTIONS[name].meaning,
            strengths=list(row),
            shares={share: [getattr(one, share) for one in row.values()] for share in SHARES},
            example=shown([(example, Condition(name, strength)) for strength in row]),
            turned=shown(turned[name][:MOST_TURNED]),
            turned_count=len(turned[name]),
        )
        for name, row in figures.by_corruption.items()
    ]
    accuracies = [value for part in parts for value in part.shares["accuracy"] if value is not None]
    return (
        templates()
        .get_template("robustness.html")
        .render(
            title=title,
            figures=figures,
            titles=_TITLES,
            strengths=STRENGTHS if len(parts[0].strengths) == len(STRENGTHS) else STRENGTHS[1:2],
            parts=parts,
            zip=zip,
            worst_first=sorted(parts, key=lambda part: mean_share(part.shares["accuracy"]) or 0.0),
            lowest=min(math.floor(10.0 * min(accuracies, default=0.0)), 9) / 10.0,
            clean_example=shown([(example, None)]),
            skipped=[Skipped(_named(run), run.reason) for run in measured.skipped],
        )
    )


def _example(measured: Robustness) -> MeshVerdicts:
    """Choose the mesh that is shown under every condition: the middle one by the number of its right answers."""
    candidates = [one for one in measured.meshes if not one.clean.is_other and one.clean.is_right] or measured.meshes
    ordered = sorted(candidates, key=lambda one: sum(verdict.is_right for verdict in one.corrupted.values()))
    return ordered[len(ordered) // 2]


def _turned(measured: Robustness, name: str) -> list[tuple[MeshVerdicts, Condition]]:
    """Find the meshes that are right clean and wrong under a corruption, the surest wrong answer first."""
    found = []
    for mesh in measured.meshes:
        if mesh.clean.is_other or not mesh.clean.is_right:
            continue
        wrong = [one for one, verdict in mesh.corrupted.items() if one.name == name and not verdict.is_right]
        if wrong:
            found.append((mesh, wrong[0]))
    return sorted(found, key=lambda entry: -entry[0].corrupted[entry[1]].probability)


def _pictures(
    wanted: Mapping[str, tuple[MeshVerdicts, Sequence[Condition | None]]], seed: int, progress: Progress
) -> dict[tuple[str, Condition | None], Picture]:
    """Read the meshes again, do to them what was done, and draw them."""
    drawn = {}
    items = [mesh.item for mesh, _ in wanted.values()]
    for number, (item, mesh) in enumerate(load_each(items)):
        progress.report(number / len(items), f"pictures: {number} of {len(items)}")
        if isinstance(mesh, Skipped):
            continue
        verdicts, conditions = wanted[item.file]
        for condition in conditions:
            query: TriangleMesh | PointCloud
            if condition is None:
                query, verdict, strength = mesh, verdicts.clean, ""
            else:
                query = condition.corrupted(mesh, seed=seed, file=item.file)
                verdict, strength = verdicts.corrupted[condition], f"{condition.strength:g}: "
            picture = render_mesh(_drawable(query), rotation=three_quarter_view("z"), size=_SIZE)
            drawn[item.file, condition] = Picture(png_uri(picture), item.file, strength + _answer(verdict))
    return drawn


def _answer(verdict: Verdict) -> str:
    known = "" if verdict.known is None else f", known {verdict.known:.0%}"
    words = f"{verdict.label} taken for " if not verdict.is_right and not verdict.is_other else ""
    return f"{words}{verdict.class_name} ({verdict.probability:.0%}{known})"


def _drawable(query: TriangleMesh | PointCloud) -> TriangleMesh:
    """Return what is drawn: the mesh, or a small octahedron at each point."""
    if isinstance(query, TriangleMesh):
        return query
    low, high = query.bounds
    radius = _POINT_RADIUS * float(np.linalg.norm(high - low))
    corners = query.points[:, None] + radius * _OCTAHEDRON
    starts = len(_OCTAHEDRON) * np.arange(len(query.points))
    faces = starts[:, None, None] + _OCTAHEDRON_FACES
    return TriangleMesh(corners.reshape(-1, 3), faces.reshape(-1, 3))


def _named(run: SkippedRun) -> str:
    return run.file if run.condition is None else f"{run.file}, {run.condition.name} {run.condition.strength:g}"
