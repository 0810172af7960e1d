"""Figures of a classification: how many are right, what is taken for what, and known against unknown."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from shapewright.classification.evidence import OTHER, auroc
from shapewright.evaluation.classified import Judged, JudgedDataset, Said
from shapewright.evaluation.retrieval_metrics import RetrievalFigures, figures_of, mean_figures, relevance
from shapewright.retrieval.ranking import combined_scores


@dataclass(frozen=True, eq=False)
class Evidence:
    """One kind of evidence about all meshes of a dataset, a row a mesh; see :class:`Said`."""

    probabilities: Float[np.ndarray, "N C"]
    scores: Float[np.ndarray, "N C"]

    @classmethod
    def joined(cls, said: Sequence[Said]) -> "Evidence":
        """Of single meshes."""
        return cls(np.stack([one.probabilities for one in said]), np.stack([one.scores for one in said]))

    @classmethod
    def plain(cls, rows: Sequence[Float[np.ndarray, " C"]]) -> "Evidence":
        """Where one number serves for both."""
        return cls(np.stack(rows), np.stack(rows))


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


def figures_by(dataset: JudgedDataset, evidence: Evidence) -> ClassificationFigures:
    """Figures where the class is the most probable one, and the highest score says how known a mesh is."""
    scores = evidence.scores
    names = dataset.class_names
    labels = np.array([one.label for one in dataset.judged])
    guesses = np.array(names)[evidence.probabilities.argmax(axis=1)]
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


def evidence_of(dataset: JudgedDataset) -> dict[str, Evidence]:
    """What each kind of evidence and each baseline says about every mesh."""
    judged = dataset.judged
    tables = {
        "all": Evidence.joined([one.by_all for one in judged]),
        "pictures": Evidence.joined([one.by_pictures for one in judged]),
    }
    bases = [-one.base_distances for one in judged if one.base_distances is not None]
    if bases:
        tables["panorama_to_default"] = Evidence.plain(bases)
    fits = [one.by_fits for one in judged if one.by_fits is not None]
    if fits:
        tables["fitted"] = Evidence.joined(fits)
    for name in judged[0].baselines:
        tables[name] = Evidence.plain([one.baselines[name] for one in judged])
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


def rankings_of(dataset: JudgedDataset) -> dict[str, Float[np.ndarray, "N C"]]:
    """What each kind of evidence and each baseline ranks every mesh by, for each class.

    ``all`` and ``combined`` are what :func:`shapewright.retrieval.ranking.rank` ranks by, for the evidence
    ``probabilities`` and, with the classifier's exemplars as instances, for ``combined``.
    """
    judged = dataset.judged
    known = np.array([1.0 if one.found.known is None else one.found.known for one in judged])[:, None]
    tables = {name: evidence.scores for name, evidence in evidence_of(dataset).items()}
    tables["all"] = known * np.stack([one.by_all.probabilities for one in judged])
    distances = [one.distances for one in judged if one.distances is not None]
    if distances:
        pictured = known * np.stack([one.by_pictures.probabilities for one in judged])
        columns = zip(pictured.T, np.stack(distances).T, strict=True)
        tables["combined"] = np.stack([combined_scores(one, distance) for one, distance in columns], axis=1)
    return tables


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
