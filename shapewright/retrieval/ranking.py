"""Retrieval: the meshes of a collection in the order of their likeness to a query (paper section 4.2).

The query is a class (or one of its models), or a mesh; the evidence is one of

- ``probabilities``: for a class, the probability that the classifier gives it, times the probability that the
  mesh is of a class that the classifier knows at all. For a mesh, the probability that it and the query are of
  the same class. This is the paper's retrieval.
- ``panorama``: the negative panorama distance, for a class to the nearest of some instances of its models. With
  the base instance of one model alone this is what the paper compares with.
- ``combined``: both. ``ln(max(p, 1e-6)) - d / s`` with the probability p and the distance d, where s is the
  interquartile range of d over the collection. Read it as the logarithm of a posterior: objects of the query's
  kind are exponentially rarer the farther away they are, in units of what distances differ by here. So neither
  the unit nor the offset of the distance matters, and nothing is fitted to labels. Where the classifier is sure
  of many meshes the distance orders them; where the distances are alike, the classifier does.
"""

from dataclasses import dataclass
from typing import Final, Literal, get_args

import numpy as np
from jaxtyping import Float, Float32

from shapewright.errors import ClassifierError
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.retrieval.collection_index import CollectionIndex

Evidence = Literal["probabilities", "panorama", "combined"]
EVIDENCE: Final[tuple[Evidence, ...]] = get_args(Evidence)


def default_evidence(class_name: str | None) -> Evidence:
    """What to rank by if nobody says: the geometry of a class counts in its probabilities already."""
    return "combined" if class_name is None else "probabilities"


PROBABILITY_FLOOR: Final = 1e-6
"""Below this, probabilities are rounding noise of a softmax and count alike."""

_ALIKE: Final = 1e-9
"""Distances that differ by no more are the same."""

_STEP: Final = 16


@dataclass(frozen=True, eq=False)
class ClassQuery:
    """Meshes of a class are wanted.

    Args:
        class_name: one of the classifier's classes; not needed where the panorama distance is the only evidence.
        exemplars: flat panorama descriptors of instances of the class's models, or of one of them; only the
            probabilities can do without.
    """

    class_name: str | None
    exemplars: Float32[np.ndarray, "M D"] | None = None


@dataclass(frozen=True, eq=False)
class MeshQuery:
    """Meshes like this one are wanted.

    Args:
        descriptor: its flat panorama descriptor.
        probabilities: of each class of the index, in its order.
        known: that the mesh is of one of these classes at all.
    """

    descriptor: Float32[np.ndarray, " D"]
    probabilities: Float[np.ndarray, " C"]
    known: float = 1.0

    @classmethod
    def of(cls, index: CollectionIndex, row: int) -> "MeshQuery":
        """Make the query for meshes like one of the index."""
        return cls(np.asarray(index.descriptors[row]), np.asarray(index.probabilities[row]), float(index.known[row]))


@dataclass(frozen=True)
class RankedMesh:
    """One place of a ranking.

    Args:
        name: of the mesh, as in the index.
        row: of the mesh in the index.
        score: what the ranking is ordered by; only the order has a meaning across kinds of evidence.
        probability: the part of the classifier, ``None`` if it was not asked for.
        distance: the panorama distance, ``None`` if it was not asked for.
    """

    name: str
    row: int
    score: float
    probability: float | None
    distance: float | None

    @property
    def caption(self) -> str:
        """The parts of the score, for people."""
        probability = [] if self.probability is None else [f"{self.probability:.1%}"]
        return ", ".join([*probability, *([] if self.distance is None else [f"distance {self.distance:.3f}"])])


def rank(
    index: CollectionIndex,
    query: ClassQuery | MeshQuery,
    evidence: Evidence = "combined",
    *,
    progress: Progress = NULL_PROGRESS,
) -> list[RankedMesh]:
    """Order all meshes of an index, the best first; equal scores in the order of names.

    Args:
        index: of the collection.
        query: what is wanted.
        evidence: see the module's text.
        progress: told as the distances are measured; may cancel.

    Raises:
        ClassifierError: an unknown kind of evidence, a class that the index does not know, no exemplars where
            distances are needed.
    """
    if evidence not in EVIDENCE:
        raise ClassifierError(f"{evidence!r} is none of {', '.join(EVIDENCE)}", where="evidence")
    # distances to exemplars may have a part in the probabilities: they must not count twice
    by_class = index.picture_probabilities if evidence == "combined" else index.probabilities
    probabilities = None if evidence == "panorama" else query_probabilities(index, query, by_class)
    distances = None if evidence == "probabilities" else query_distances(index, query, progress)
    if probabilities is None:
        assert distances is not None
        scores = -distances
    elif distances is None:
        scores = probabilities
    else:
        scores = combined_scores(probabilities, distances)
    order = sorted(range(len(index)), key=lambda row: (-scores[row], index.names[row]))
    return [
        RankedMesh(
            index.names[row],
            row,
            float(scores[row]),
            None if probabilities is None else float(probabilities[row]),
            None if distances is None else float(distances[row]),
        )
        for row in order
    ]


def query_probabilities(
    index: CollectionIndex, query: ClassQuery | MeshQuery, by_class: Float[np.ndarray, "N C"]
) -> Float[np.ndarray, " N"]:
    """Probability that each mesh is of the wanted class, or of the same class as the wanted mesh.

    Args:
        index: of the collection.
        query: what is wanted.
        by_class: probabilities of the classes for each mesh of the index.

    Raises:
        ClassifierError: a class that the index does not know.
    """
    known = index.known.astype(np.float64)
    if isinstance(query, MeshQuery):
        same = by_class.astype(np.float64) @ np.asarray(query.probabilities, dtype=np.float64)
        return np.asarray(query.known * known * same)
    if query.class_name not in index.class_names:
        names = ", ".join(index.class_names)
        raise ClassifierError(f"the classifier does not know {query.class_name!r} (but: {names})", where="class_name")
    return np.asarray(known * by_class[:, index.class_names.index(query.class_name)])


def query_distances(
    index: CollectionIndex, query: ClassQuery | MeshQuery, progress: Progress = NULL_PROGRESS
) -> Float[np.ndarray, " N"]:
    """Panorama distance of each mesh to the query, or to the nearest of its exemplars.

    Raises:
        ClassifierError: the query has no exemplars.
    """
    if isinstance(query, MeshQuery):
        return nearest_distances(index.descriptors, query.descriptor[None], progress)
    if query.exemplars is None or len(query.exemplars) == 0:
        raise ClassifierError("instances of a model are needed to measure distances to a class", where="exemplars")
    return nearest_distances(index.descriptors, query.exemplars, progress)


def nearest_distances(
    descriptors: Float32[np.ndarray, "N D"],
    exemplars: Float32[np.ndarray, "M D"],
    progress: Progress = NULL_PROGRESS,
) -> Float[np.ndarray, " N"]:
    """Panorama distance of each row to the nearest exemplar. It is symmetric, so the longer list is what is scanned."""
    from shapewright.distances.panorama import PanoramaDescriptor, panorama_distances

    out = np.full(len(descriptors), np.inf)
    by_exemplar = len(exemplars) <= len(descriptors)
    scanned = exemplars if by_exemplar else descriptors
    for number, row in enumerate(scanned):
        if number % _STEP == 0:
            progress.report(number / len(scanned), "measuring distances")
        one = PanoramaDescriptor.from_array(row)
        if by_exemplar:
            np.minimum(out, panorama_distances(one, descriptors), out=out)
        else:
            out[number] = panorama_distances(one, exemplars).min()
    return out


def combined_scores(
    probabilities: Float[np.ndarray, " N"], distances: Float[np.ndarray, " N"]
) -> Float[np.ndarray, " N"]:
    """Both kinds of evidence in one number; see the module's text."""
    if len(distances) == 0:
        return np.empty(0)
    low, high = np.quantile(distances, [0.25, 0.75])
    spread = high - low if high - low > _ALIKE else 1.0
    return np.asarray(np.log(np.maximum(probabilities, PROBABILITY_FLOOR)) - distances / spread)
