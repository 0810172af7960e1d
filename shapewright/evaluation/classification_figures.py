"""Figures of a classification: how many are right, what is taken for what, and known against unknown."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from shapewright.classification.calibration import auroc
from shapewright.evaluation.classified import OTHER, Judged, JudgedDataset
from shapewright.evaluation.retrieval_metrics import RetrievalFigures, figures_of, mean_figures, relevance


@dataclass(frozen=True)
class ClassificationFigures:
    """How well classes are told apart and known meshes from others, by one kind of evidence.

    Attributes:
        n: meshes of the classes.
        accuracy: share of them whose most probable class is their own, whatever ``known`` says.
        per_class: number and accuracy by class.
        confusion: rows are true classes and ``other``, columns the most probable classes.
        auroc_known: area under the curve of meshes of the classes against others; ``None`` without others.
    """

    n: int
    accuracy: float
    per_class: dict[str, dict[str, float]]
    confusion: dict[str, dict[str, int]]
    auroc_known: float | None

    def to_dict(self) -> dict[str, Any]:
        """Plain values, ready for JSON."""
        return {
            "n": self.n,
            "accuracy": self.accuracy,
            "per_class": self.per_class,
            "confusion": self.confusion,
            "auroc_known": self.auroc_known,
        }


def figures_by(dataset: JudgedDataset, scores: Float[np.ndarray, "N C"]) -> ClassificationFigures:
    """Figures where the class is the one of the highest score, and the highest score says how known a mesh is."""
    names = dataset.class_names
    labels = np.array([one.label for one in dataset.judged])
    guesses = np.array(names)[scores.argmax(axis=1)]
    inside = labels != OTHER
    best = scores.max(axis=1)
    per_class = {}
    for name in names:
        own = labels == name
        if own.any():
            per_class[name] = {"n": int(own.sum()), "accuracy": float((guesses[own] == name).mean())}
    rows = [*per_class, *([OTHER] if (~inside).any() else [])]
    confusion = {
        truth: {guess: int(((labels == truth) & (guesses == guess)).sum()) for guess in names} for truth in rows
    }
    return ClassificationFigures(
        n=int(inside.sum()),
        accuracy=float((guesses == labels)[inside].mean()) if inside.any() else 0.0,
        per_class=per_class,
        confusion=confusion,
        auroc_known=auroc(best[inside], best[~inside]) if inside.any() and (~inside).any() else None,
    )


def evidence_scores(dataset: JudgedDataset) -> dict[str, Float[np.ndarray, "N C"]]:
    """Scores of every mesh by each kind of evidence and each baseline."""
    judged = dataset.judged
    tables = {
        "all": np.stack([one.scores for one in judged]),
        "pictures": np.stack([one.picture_scores for one in judged]),
        "panorama_to_default": -np.stack([one.base_distances for one in judged]),
    }
    fitted = [one.fitted_scores for one in judged if one.fitted_scores is not None]
    if fitted:
        tables["fitted"] = np.stack(fitted)
    for name in judged[0].baselines:
        tables[name] = np.stack([one.baselines[name] for one in judged])
    return tables


def unknown_figures(dataset: JudgedDataset) -> dict[str, float | None]:
    """What the answer ``unknown`` does: share of known meshes that get their class, of others that are refused."""
    if dataset.judged[0].found.known is None:
        return {"accepted_known": None, "right_of_known": None, "refused_other": None}
    inside = [one for one in dataset.judged if one.label != OTHER]
    outside = [one for one in dataset.judged if one.label == OTHER]

    def share(chosen: list[Judged], test: Any) -> float | None:
        return float(np.mean([test(one) for one in chosen])) if chosen else None

    return {
        "accepted_known": share(inside, lambda one: one.found.answer == one.found.class_name),
        "right_of_known": share(inside, lambda one: one.found.answer == one.label),
        "refused_other": share(outside, lambda one: one.found.answer != one.found.class_name),
    }


def retrieval_figures(
    dataset: JudgedDataset, scores: Float[np.ndarray, "N C"]
) -> tuple[RetrievalFigures, Mapping[str, RetrievalFigures]]:
    """Each class's ranking of all meshes, and the mean over the classes that have meshes (paper section 4.2)."""
    labels = np.array([one.label for one in dataset.judged])
    files = [one.item.file for one in dataset.judged]
    per_class = {
        name: figures_of(relevance(scores[:, number], labels == name, files))
        for number, name in enumerate(dataset.class_names)
        if (labels == name).any()
    }
    return mean_figures(per_class), per_class
