"""Exemplars: the variations that a classifier learned from, by their panorama descriptors (ours).

They are evidence beside the pictures: how near does a mesh come to some variation of each class? The distance knows
geometry that pictures blur, and where a match is found its parameter values are known, too.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from jaxtyping import Float, Float32, Int

from shapewright.classification.quantized import quantize, restore
from shapewright.classification.series import SERIES, series_generators, series_values
from shapewright.distances.descriptor_files import OutdatedFileError, descriptor_header, read_descriptor_header
from shapewright.distances.panorama import DESCRIPTOR_SIZE, PanoramaDescriptor, panorama_distances
from shapewright.errors import ClassifierError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.mapped_arrays import read_arrays, write_arrays

FORMAT: Final = "shapewright-exemplars"
_VERSION: Final = 2


@dataclass(frozen=True, eq=False)
class Exemplars:
    """Descriptors of stored variations and where each comes from.

    Args:
        class_names: in the order of the classifier.
        digests: of the procedural models.
        seed: of the variations.
        subdivision_steps: of the variations.
        classes: class number of each row.
        models: number of the model of each row, among ``digests``.
        numbers: which variation of its model each row is.
        descriptors: panorama descriptors, a row a variation.
    """

    class_names: tuple[str, ...]
    digests: tuple[str, ...]
    seed: int
    subdivision_steps: int
    classes: Int[np.ndarray, " M"]
    models: Int[np.ndarray, " M"]
    numbers: Int[np.ndarray, " M"]
    descriptors: Float32[np.ndarray, "M D"]

    def __post_init__(self) -> None:
        lengths = {len(self.classes), len(self.models), len(self.numbers), len(self.descriptors)}
        if len(lengths) != 1 or set(np.unique(self.classes)) != set(range(len(self.class_names))):
            raise ClassifierError(
                "every class has exemplars, every exemplar has a class and a model", where="exemplars"
            )
        if self.descriptors.shape[1] != DESCRIPTOR_SIZE:
            raise ClassifierError("the descriptors are of another version", where="exemplars")

    def __len__(self) -> int:
        return len(self.classes)

    def taken(self, rows: Int[np.ndarray, " K"]) -> "Exemplars":
        """Return the exemplars of these rows alone, in this order."""
        return replace(
            self,
            classes=self.classes[rows],
            models=self.models[rows],
            numbers=self.numbers[rows],
            descriptors=self.descriptors[rows],
        )

    def distances(self, descriptor: PanoramaDescriptor) -> Float[np.ndarray, " M"]:
        """Panorama distance of a mesh to every exemplar."""
        return panorama_distances(descriptor, self.descriptors)

    def nearest(
        self, distances: Float[np.ndarray, " M"], *, without_model: int | None = None
    ) -> tuple[Float[np.ndarray, " C"], Int[np.ndarray, " C"]]:
        """Distance and row of the nearest exemplar of each class.

        Args:
            distances: of :meth:`distances`.
            without_model: leave this model out where its class has others, to see how a class does without it.
        """
        left = distances
        if without_model is not None:
            own = self.models == without_model
            others = (self.classes == self.classes[own][0]) & ~own
            left = np.where(own, np.inf, distances) if others.any() else distances
        rows = np.array([_lowest(left, self.classes == number) for number in range(len(self.class_names))])
        return left[rows], rows

    def values(self, row: int, generator: InstanceGenerator) -> Float[np.ndarray, " P"]:
        """The parameter values of an exemplar, drawn again.

        Args:
            row: which exemplar.
            generator: its model, compiled; the digest must be ``digests[models[row]]``.

        Raises:
            ClassifierError: another model.
        """
        digest = self.digests[self.models[row]]
        if generator.model.digest != digest:
            raise ClassifierError("the exemplar belongs to another model or another version of it", where="exemplars")
        series, index = divmod(int(self.numbers[row]), SERIES)
        rng, _ = series_generators(self.seed, digest, series)
        return np.asarray(series_values(generator, rng, SERIES)[index])

    def save(self, path: str | Path) -> None:
        """Write one compressed ``.npz`` file; its rounded descriptors change distances by 0.0006 on average.

        Raises:
            OSError: the file cannot be written.
        """
        rest = {
            "class_names": list(self.class_names),
            "digests": list(self.digests),
            "seed": self.seed,
            "subdivision_steps": self.subdivision_steps,
        }
        levels, largest = quantize(self.descriptors)
        arrays: dict[str, np.ndarray] = {
            "classes": self.classes.astype(np.int32),
            "models": self.models.astype(np.int32),
            "numbers": self.numbers.astype(np.int32),
            "levels": levels,
            "largest": largest,
        }
        write_arrays(path, descriptor_header(FORMAT, _VERSION, rest), arrays, compressed=True)

    @classmethod
    def load(cls, path: str | Path) -> "Exemplars":
        """Read a file of :meth:`save`.

        Raises:
            ClassifierError: the file is missing, damaged, none of ours or of another version.
        """
        where = Path(path).name
        try:
            header = read_descriptor_header(path, FORMAT, _VERSION)
            classes, models, numbers, levels, largest = read_arrays(
                path, ["classes", "models", "numbers", "levels", "largest"], memory_map=False
            )
            return cls(
                class_names=tuple(str(name) for name in header["class_names"]),
                digests=tuple(str(digest) for digest in header["digests"]),
                seed=int(header["seed"]),
                subdivision_steps=int(header["subdivision_steps"]),
                classes=classes,
                models=models,
                numbers=numbers,
                descriptors=restore(levels, largest),
            )
        except OSError as error:
            raise ClassifierError(f"cannot be read: {error.strerror}", where=where) from error
        except OutdatedFileError as error:
            raise ClassifierError(f"{error}; train again", where=where) from error
        except (ValueError, KeyError, TypeError) as error:
            raise ClassifierError(f"the file holds no exemplars or is damaged: {error}", where=where) from error


def _lowest(distances: Float[np.ndarray, " M"], chosen: np.ndarray) -> int:
    rows = np.flatnonzero(chosen)
    return int(rows[np.argmin(distances[rows])])
