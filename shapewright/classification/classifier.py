"""Using a classifier: pictures by ONNX Runtime, geometry by exemplars, no torch (paper section 3.2, and beyond)."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.classification.answer import Classification
from shapewright.classification.checked_metadata import checked_metadata
from shapewright.classification.evidence import KnownCurves, class_probabilities, class_scores
from shapewright.classification.exemplars import Exemplars
from shapewright.classification.file_format import exemplars_file
from shapewright.classification.look import Look
from shapewright.classification.neighbor import Neighbor
from shapewright.classification.sights import Sight, sights_of
from shapewright.classification.synthesis import FITTED_CLASSES, fit_class
from shapewright.classification.trade_off import TradeOffPoint, trade_off_of
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptor
from shapewright.errors import ClassifierError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.network.ports import IMAGES, OPEN_PROBABILITIES, PROBABILITIES
from shapewright.network.session import BATCH_SIZE, make_session
from shapewright.rendering.views import spread_views

DEFAULT_VIEWS: Final = 10
GROUND_PREFERENCE: Final = 0.25
"""How much lower the best score may be without the ground than with it, for the ground to be left out all the same; 0
for scans of one side, of which a table top is often all there is."""


class Classifier:
    """A classifier's file, loaded.

    Args:
        onnx: the file's content or its path.
        exemplars: the geometric evidence that was trained with it, if there is any.
        threads: threads of ONNX Runtime.

    Raises:
        ClassifierError: the file is missing, damaged, or not one of ours; exemplars of another classifier.
    """

    def __init__(self, onnx: bytes | str | Path, *, exemplars: Exemplars | None = None, threads: int = 2) -> None:
        content, where = _read(onnx)
        try:
            self._session = make_session(content, threads=threads)
        except Exception as error:  # ONNX Runtime's exceptions share no base but Exception
            raise ClassifierError(f"not an ONNX file that can be loaded: {_first_line(error)}", where=where) from error
        self.metadata = checked_metadata(self._session, where)
        self.class_names: tuple[str, ...] = tuple(self.metadata["class_names"])
        self.look = Look.from_dict(self.metadata["rendering"])
        self.exemplars = exemplars
        if exemplars is not None:
            digests = tuple(model["digest"] for model in self.metadata["models"])
            if (exemplars.class_names, exemplars.digests) != (self.class_names, digests):
                raise ClassifierError("the exemplars belong to another classifier", where="exemplars")

    @property
    def metrics(self) -> dict[str, Any]:
        """Figures of the training that made this classifier."""
        return dict(self.metadata["metrics"])

    @property
    def trade_off(self) -> tuple[TradeOffPoint, ...] | None:
        """What thresholds of ``known`` accept and refuse; ``None`` if the training did not measure it."""
        return trade_off_of(self.metadata["metrics"], geometry=self.exemplars is not None)

    def predict(self, images: UInt8[np.ndarray, "N H W 3"]) -> Float[np.ndarray, "N C"]:
        """Calibrated class probabilities of pictures, given that they show one of the classes; float32.

        Raises:
            ClassifierError: pictures of another size.
        """
        return self._run(images)[0]

    def render(
        self, query: TriangleMesh | PointCloud, *, views: int = DEFAULT_VIEWS, rng: np.random.Generator | None = None
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Draw a query as the learning pictures were drawn, from directions that are spread evenly.

        Raises:
            ClassifierError: fewer than one view, or a point cloud where pictures need faces.
            MeshError: the query has no area or no extent.
            RenderingError: no headless OpenGL, where pictures need it.
        """
        rng = rng or np.random.default_rng(0)
        even = self._views(views, rng)
        sight = sights_of(query, self.look)[0]
        return sight.images(*_joined(even, sight.more_views(rng, views)))

    def classify(
        self,
        query: TriangleMesh | PointCloud,
        /,
        *,
        views: int = DEFAULT_VIEWS,
        rng: np.random.Generator | None = None,
        models: Mapping[str, InstanceGenerator] | None = None,
    ) -> Classification:
        """Draw a query from several sides, average the class probabilities (paper section 3.2), compare its geometry.

        An object that may stand on the ground is looked at with and without it. A scan of one side is looked at more
        often from there; its geometry, far from that of every whole object, only tells whether it is known. For scans
        less is enough to be known.

        Args:
            query: any triangle soup, or a point cloud.
            views: pictures, the paper's 10 by default; three times as many of a scan of one side.
            rng: draws rotations and scales; by default a fresh ``default_rng(0)``, so answers repeat.
            models: compiled models by digest: the most probable classes are fitted, not only compared with their
                exemplars. It takes a second, and the parameter values come with it.

        Raises:
            ClassifierError: fewer than one view, models without exemplars, or a point cloud where pictures need faces.
            MeshError: the query has no area or no extent.
            RenderingError: no headless OpenGL, where pictures need it.
        """
        if models is not None and self.exemplars is None:
            raise ClassifierError("a fit begins at exemplars, and there are none", where="models")
        rng = rng or np.random.default_rng(0)
        even = self._views(views, rng)
        with_ground, *without = (
            self._seen(sight, even, sight.more_views(rng, views)) for sight in sights_of(query, self.look)
        )
        seen = with_ground
        preference = 0.0 if with_ground.is_open else GROUND_PREFERENCE
        for other in without:
            if other.scores.max() > with_ground.scores.max() - preference:
                seen = other
        pictured, opened, distances = seen.pictured, seen.opened, seen.distances
        fits = None
        if self.exemplars is not None and models is not None:
            assert seen.descriptor is not None
            assert seen.exemplar_distances is not None
            assert distances is not None
            fits = {}
            for number in np.argsort(-seen.scores, kind="stable")[:FITTED_CLASSES]:
                fit = fit_class(seen.descriptor, self.exemplars, seen.exemplar_distances, int(number), models, rng)
                if fit is not None:
                    fits[self.class_names[number]] = fit
                    distances[number] = min(fit.distance, distances[number])
        curves = self._curves("pictures" if distances is None else "geometry")
        scores = _shifted(class_scores(opened, distances), curves, seen)
        probabilities = self._ranked(class_probabilities(pictured, None if seen.is_open else distances))
        return Classification(
            class_name=next(iter(probabilities)),
            known=None if curves is None else curves.probability(float(scores.max())),
            probabilities=probabilities,
            picture_probabilities=self._ranked(pictured),
            scores=self._ranked(scores),
            picture_scores=self._ranked(_shifted(class_scores(opened), self._curves("pictures"), seen)),
            distances=None if distances is None else self._ranked(distances, lowest_first=True),
            fits=fits,
            neighbor=self._neighbor(next(iter(probabilities)), seen.exemplar_distances),
            descriptor=seen.descriptor,
            per_view=seen.per_view,
            images=seen.images,
        )

    def _neighbor(self, class_name: str, distances: Float[np.ndarray, " M"] | None) -> Neighbor | None:
        if self.exemplars is None or distances is None:
            return None
        number = self.class_names.index(class_name)
        lowest, rows = self.exemplars.nearest(distances)
        usual = self.metadata["usual_distances"]
        return Neighbor(
            class_name=class_name,
            digest=self.exemplars.digests[self.exemplars.models[rows[number]]],
            row=int(rows[number]),
            distance=float(lowest[number]),
            usual_distance=None if usual is None else usual[number],
        )

    def _views(self, views: int, rng: np.random.Generator) -> "_Views":
        if views < 1:
            raise ClassifierError("at least one view is needed", where="views")
        return spread_views(rng, views, scale_range=self.look.scale_range)

    def _seen(self, sight: Sight, even: "_Views", more: "_Views") -> "_Seen":
        images = sight.images(*_joined(even, more))
        per_view, open_per_view = self._run(images)
        opened = open_per_view.mean(axis=0, dtype=np.float64)
        descriptor = every = distances = None
        if self.exemplars is not None:
            surface = sight.surface()
            descriptor = panorama_descriptor(surface.vertices, surface.faces)
            every = self.exemplars.distances(descriptor)
            distances, _ = self.exemplars.nearest(every)
        return _Seen(
            images=images,
            per_view=per_view,
            pictured=per_view.mean(axis=0, dtype=np.float64),
            opened=opened,
            descriptor=descriptor,
            exemplar_distances=every,
            distances=distances,
            scores=class_scores(opened, distances),
            is_open=len(more[1]) > 0,
            is_rough=sight.is_rough or len(more[1]) > 0,
        )

    def _run(self, images: UInt8[np.ndarray, "N H W 3"]) -> tuple[Float[np.ndarray, "N C"], Float[np.ndarray, "N C"]]:
        """Probabilities of pictures, without and with a share for ``none``."""
        if images.shape[1:3] != (self.look.image_size, self.look.image_size):
            raise ClassifierError(
                f"pictures of {images.shape[1:3]} pixels, expected {self.look.image_size}", where="images"
            )
        outputs = [PROBABILITIES, OPEN_PROBABILITIES]
        batches = [
            self._session.run(outputs, {IMAGES: images[start : start + BATCH_SIZE]})
            for start in range(0, len(images), BATCH_SIZE)
        ]
        closed, opened = (np.concatenate([batch[place] for batch in batches]) for place in (0, 1))
        return closed, opened

    def _ranked(self, values: Float[np.ndarray, " C"], *, lowest_first: bool = False) -> dict[str, float]:
        order = np.argsort(values if lowest_first else -values, kind="stable")
        return {self.class_names[i]: float(values[i]) for i in order}

    def _curves(self, evidence: str) -> KnownCurves | None:
        values = self.metadata["known"][evidence]
        return None if values is None else KnownCurves.from_dict(values)


_Views = tuple[Float[np.ndarray, "_ 3 3"], Float[np.ndarray, " _"]]
"""Rotations and scales."""


def _joined(views: _Views, more: _Views) -> _Views:
    return np.concatenate([views[0], more[0]]), np.concatenate([views[1], more[1]])


@dataclass(frozen=True, eq=False)
class _Seen:
    """What a sight says about the classes, in the order of their numbers; whether it is of one side, or of a scan."""

    images: UInt8[np.ndarray, "N H W 3"]
    per_view: Float[np.ndarray, "N C"]
    pictured: Float[np.ndarray, " C"]
    opened: Float[np.ndarray, " C"]
    descriptor: PanoramaDescriptor | None
    exemplar_distances: Float[np.ndarray, " M"] | None
    distances: Float[np.ndarray, " C"] | None
    scores: Float[np.ndarray, " C"]
    is_open: bool
    is_rough: bool


def _shifted(scores: Float[np.ndarray, " C"], curves: KnownCurves | None, seen: _Seen) -> Float[np.ndarray, " C"]:
    return scores if curves is None else curves.shifted(scores, is_rough=seen.is_rough)


def files_digest(onnx: bytes, exemplars: Path | None) -> str:
    """SHA-256 of all that a classifier's answers come from.

    Raises:
        OSError: the exemplars cannot be read.
    """
    digest = hashlib.sha256(onnx)
    if exemplars is not None:
        with exemplars.open("rb") as file:
            digest.update(hashlib.file_digest(file, "sha256").digest())
    return digest.hexdigest()


def load_classifier(path: str | Path, *, threads: int = 2) -> Classifier:
    """A classifier with the exemplars that lie beside its file, if there are any.

    Raises:
        ClassifierError: as :class:`Classifier`, or damaged exemplars.
    """
    beside = exemplars_file(Path(path))
    return Classifier(path, exemplars=Exemplars.load(beside) if beside.is_file() else None, threads=threads)


def _read(onnx: bytes | str | Path) -> tuple[bytes, str | None]:
    if isinstance(onnx, bytes):
        return onnx, None
    path = Path(onnx)
    try:
        return path.read_bytes(), path.name
    except OSError as error:
        raise ClassifierError(f"cannot be read: {error.strerror}", where=path.name) from error


def _first_line(error: Exception) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:200]
