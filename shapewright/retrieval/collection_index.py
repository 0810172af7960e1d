"""The index of a collection: what is known about each of its meshes, so that a query need not look at them again."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from jaxtyping import Float32

from shapewright.errors import ClassifierError
from shapewright.mapped_arrays import read_arrays, write_arrays

FORMAT: Final = "shapewright-collection-index"
VERSION: Final = 1

_ARRAYS: Final = ("probabilities", "picture_probabilities", "known", "descriptors")


@dataclass(frozen=True, eq=False)
class CollectionIndex:
    """Meshes by name, with what a classifier and the panorama descriptor say about each.

    Args:
        names: of the meshes, all different; what they mean is up to who made the index.
        class_names: the classes of the classifier, the columns of the probabilities.
        classifier_digest: SHA-256 of the classifier's file.
        probabilities: of each class, of all evidence.
        picture_probabilities: of each class, of the pictures alone.
        known: that the mesh is of one of the classes at all.
        descriptors: flat panorama descriptors; like the other arrays perhaps a read-only memory map.

    Raises:
        ClassifierError: the arrays differ in length, or a name comes twice.
    """

    names: tuple[str, ...]
    class_names: tuple[str, ...]
    classifier_digest: str
    probabilities: Float32[np.ndarray, "N C"]
    picture_probabilities: Float32[np.ndarray, "N C"]
    known: Float32[np.ndarray, " N"]
    descriptors: Float32[np.ndarray, "N D"]

    def __post_init__(self) -> None:
        from shapewright.distances.panorama import DESCRIPTOR_SIZE

        count, width = len(self.names), len(self.class_names)
        shapes = (self.probabilities.shape, self.picture_probabilities.shape, self.known.shape)
        if shapes != ((count, width), (count, width), (count,)) or len(self.descriptors) != count:
            raise ClassifierError(f"the arrays are not of {count} meshes and {width} classes", where="index")
        if self.descriptors.shape[1] != DESCRIPTOR_SIZE:
            raise ClassifierError("the descriptors are of another size", where="index")
        if len(set(self.names)) != count:
            raise ClassifierError("a mesh comes twice", where="index")

    def __len__(self) -> int:
        return len(self.names)

    @classmethod
    def empty(cls, class_names: Sequence[str], classifier_digest: str) -> "CollectionIndex":
        """Make an index without meshes."""
        from shapewright.distances.panorama import DESCRIPTOR_SIZE

        none = np.empty((0, len(class_names)), np.float32)
        known, descriptors = np.empty(0, np.float32), np.empty((0, DESCRIPTOR_SIZE), np.float32)
        return cls((), tuple(class_names), classifier_digest, none, none, known, descriptors)

    def check_fits(self, class_names: Sequence[str], classifier_digest: str) -> None:
        """Raise ClassifierError unless the index was made with this classifier."""
        if self.classifier_digest != classifier_digest or self.class_names != tuple(class_names):
            raise ClassifierError("the index was made with another classifier", where="index")

    def taken(self, rows: Sequence[int], names: Sequence[str] | None = None) -> "CollectionIndex":
        """Make an index of some of the meshes, in this order and with new names if given; a row may come twice."""
        chosen = np.asarray(rows, dtype=np.int64)
        return CollectionIndex(
            tuple(self.names[row] for row in chosen) if names is None else tuple(names),
            self.class_names,
            self.classifier_digest,
            np.asarray(self.probabilities[chosen]),
            np.asarray(self.picture_probabilities[chosen]),
            np.asarray(self.known[chosen]),
            np.asarray(self.descriptors[chosen]),
        )

    def joined(self, other: "CollectionIndex") -> "CollectionIndex":
        """Make an index of the meshes of both; what both have is taken from this one.

        Raises:
            ClassifierError: they are of different classifiers.
        """
        other.check_fits(self.class_names, self.classifier_digest)
        here = set(self.names)
        fresh = other.taken([row for row, name in enumerate(other.names) if name not in here])
        return CollectionIndex(
            self.names + fresh.names,
            self.class_names,
            self.classifier_digest,
            np.concatenate([self.probabilities, fresh.probabilities]),
            np.concatenate([self.picture_probabilities, fresh.picture_probabilities]),
            np.concatenate([self.known, fresh.known]),
            np.concatenate([self.descriptors, fresh.descriptors]),
        )

    def rows_of(self, names: Iterable[str]) -> dict[str, int]:
        """Tell the rows of those of these names that are here."""
        row_of = {name: row for row, name in enumerate(self.names)}
        return {name: row_of[name] for name in names if name in row_of}

    def save(self, path: str | Path) -> None:
        """Write one uncompressed ``.npz`` file, completely or not at all; :meth:`load` maps it into memory.

        Raises:
            OSError: the file cannot be written.
        """
        from shapewright.distances.descriptor_files import descriptor_header

        rest = {
            "names": self.names,
            "class_names": self.class_names,
            "classifier_digest": self.classifier_digest,
        }
        write_arrays(path, descriptor_header(FORMAT, VERSION, rest), {name: getattr(self, name) for name in _ARRAYS})

    @classmethod
    def load(cls, path: str | Path, *, memory_map: bool = True) -> "CollectionIndex":
        """Read an index; with ``memory_map`` the arrays stay in the file and are read when used.

        Raises:
            ClassifierError: the file is no index, is damaged, or is of another version of the format or of the
                descriptor.
            OSError: the file cannot be opened.
        """
        from shapewright.distances.descriptor_files import OutdatedFileError, read_descriptor_header

        source = Path(path)
        try:
            header = read_descriptor_header(source, FORMAT, VERSION)
            arrays = read_arrays(source, _ARRAYS, memory_map=memory_map)
            if any(array.dtype != np.float32 for array in arrays) or arrays[-1].ndim != 2:
                raise ValueError("its arrays are of an unknown kind")
            names, class_names = (tuple(str(name) for name in header[key]) for key in ("names", "class_names"))
            return cls(names, class_names, str(header["classifier_digest"]), *arrays)
        except OutdatedFileError as error:
            raise ClassifierError(str(error), where=source.name) from error
        except (KeyError, ValueError, TypeError) as error:
            raise ClassifierError(
                f"the file is no index of meshes or is damaged: {error}", where=source.name
            ) from error
