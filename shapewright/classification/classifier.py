"""Using a classifier: ONNX Runtime and the renderer, no torch (paper section 3.2)."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.classification.features import BATCH_SIZE, make_session
from shapewright.classification.file_format import (
    FORMAT,
    FORMAT_VERSION,
    IMAGES,
    METADATA_KEY,
    PROBABILITIES,
)
from shapewright.errors import ClassifierError
from shapewright.mesh import TriangleMesh
from shapewright.rendering.images import render_images
from shapewright.rendering.styles import STYLES
from shapewright.rendering.views import random_views

DEFAULT_VIEWS = 10


@dataclass(frozen=True, eq=False)
class Classification:
    """The answer to: what is this mesh?

    Args:
        class_name: the class with the highest mean probability.
        probabilities: mean over the views, highest first.
        per_view: probabilities of each picture; columns in the order of the classifier's ``class_names``.
        images: the pictures that were looked at.
    """

    class_name: str
    probabilities: dict[str, float]
    per_view: Float[np.ndarray, "N C"]
    images: UInt8[np.ndarray, "N H W 3"]


class Classifier:
    """A classifier's file, loaded.

    Args:
        onnx: the file's content or its path.
        threads: threads of ONNX Runtime.

    Raises:
        ClassifierError: the file is missing, damaged, or not one of ours.
    """

    def __init__(self, onnx: bytes | str | Path, *, threads: int = 2) -> None:
        content, where = _read(onnx)
        try:
            self._session = make_session(content, threads=threads)
        except Exception as error:  # ONNX Runtime's exceptions share no base but Exception
            raise ClassifierError(f"not an ONNX file that can be loaded: {_first_line(error)}", where=where) from error
        self.metadata = _checked_metadata(self._session, where)
        self.class_names: tuple[str, ...] = tuple(self.metadata["class_names"])
        self.image_size = int(self.metadata["rendering"]["image_size"])

    @property
    def metrics(self) -> dict[str, Any]:
        """Figures of the training that made this classifier."""
        return dict(self.metadata["metrics"])

    def predict(self, images: UInt8[np.ndarray, "N H W 3"]) -> Float[np.ndarray, "N C"]:
        """Calibrated class probabilities of pictures, float32.

        Raises:
            ClassifierError: pictures of another size.
        """
        if images.shape[1:3] != (self.image_size, self.image_size):
            raise ClassifierError(f"pictures of {images.shape[1:3]} pixels, expected {self.image_size}", where="images")
        out = np.empty((len(images), len(self.class_names)), dtype=np.float32)
        for start in range(0, len(images), BATCH_SIZE):
            batch = images[start : start + BATCH_SIZE]
            out[start : start + len(batch)] = self._session.run([PROBABILITIES], {IMAGES: batch})[0]
        return out

    def render(
        self, mesh: TriangleMesh, *, views: int = DEFAULT_VIEWS, rng: np.random.Generator | None = None
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Pictures of a mesh, drawn as the learning pictures were: random rotations and scales.

        Raises:
            ClassifierError: fewer than one view.
            RenderingError: no headless OpenGL.
        """
        if views < 1:
            raise ClassifierError("at least one view is needed", where="views")
        rendering = self.metadata["rendering"]
        low, high = rendering["scale_range"]
        rotations, scales = random_views(rng or np.random.default_rng(0), views, scale_range=(low, high))
        return render_images(
            [mesh],
            None,
            rotations,
            scales,
            objects=np.zeros(views, dtype=np.int64),
            size=self.image_size,
            style=rendering["style"],
            window=float(rendering["window"]),
        )

    def classify(
        self, mesh: TriangleMesh, *, views: int = DEFAULT_VIEWS, rng: np.random.Generator | None = None
    ) -> Classification:
        """Draw a mesh from several sides and average the class probabilities (paper section 3.2).

        Args:
            mesh: any triangle soup.
            views: pictures; the paper's 10 by default.
            rng: draws rotations and scales; by default a fresh ``default_rng(0)``, so answers repeat.

        Raises:
            ClassifierError: fewer than one view.
            RenderingError: no headless OpenGL.
        """
        images = self.render(mesh, views=views, rng=rng)
        per_view = self.predict(images)
        mean = per_view.mean(axis=0, dtype=np.float64)
        order = np.argsort(-mean, kind="stable")
        return Classification(
            class_name=self.class_names[order[0]],
            probabilities={self.class_names[i]: float(mean[i]) for i in order},
            per_view=per_view,
            images=images,
        )


def _read(onnx: bytes | str | Path) -> tuple[bytes, str | None]:
    if isinstance(onnx, bytes):
        return onnx, None
    path = Path(onnx)
    try:
        return path.read_bytes(), path.name
    except OSError as error:
        raise ClassifierError(f"cannot be read: {error.strerror}", where=path.name) from error


def _checked_metadata(session: Any, where: str | None) -> dict[str, Any]:
    """What the file says about itself, if graph and metadata are ours and agree."""
    text = session.get_modelmeta().custom_metadata_map.get(METADATA_KEY)
    if text is None:
        raise ClassifierError("an ONNX file, but not a Shapewright classifier: it has no metadata of ours", where=where)
    try:
        metadata = json.loads(text)
        if metadata["format"] != FORMAT:
            raise ClassifierError(f"the format is {metadata['format']!r}, not {FORMAT!r}", where=where)
        if metadata["version"] != FORMAT_VERSION:
            raise ClassifierError(
                f"version {metadata['version']!r} of the format is not known, this library reads {FORMAT_VERSION}",
                where=where,
            )
        class_names = metadata["class_names"]
        rendering = metadata["rendering"]
        size = int(rendering["image_size"])
        sound = (
            isinstance(class_names, list)
            and all(isinstance(name, str) for name in class_names)
            and isinstance(metadata["metrics"], dict)
            and rendering["style"] in STYLES
            and float(rendering["window"]) > 0
            and len([float(end) for end in rendering["scale_range"]]) == 2
        )
    except (ValueError, KeyError, TypeError) as error:
        raise ClassifierError(f"the metadata is damaged: {error!r}", where=where) from error
    shapes = {port.name: (port.type, list(port.shape)[1:]) for port in session.get_inputs() + session.get_outputs()}
    expected = {
        IMAGES: ("tensor(uint8)", [size, size, 3]),
        PROBABILITIES: ("tensor(float)", [len(class_names)]),
    }
    if not sound or any(shapes.get(name) != shape for name, shape in expected.items()):
        raise ClassifierError("the metadata does not fit the graph", where=where)
    return dict(metadata)


def _first_line(error: Exception) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:200]
