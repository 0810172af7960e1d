"""The query-independent half of layer 1: random instances and their panorama descriptors (section 3.3)."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from jaxtyping import Float, Float32

from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation.generator import InstanceGenerator
from shapewright.estimation.settings import EstimationSettings
from shapewright.mapped_arrays import read_arrays, write_arrays
from shapewright.progress import NULL_PROGRESS, Progress

FORMAT: Final = "shapewright-panorama-bank"
VERSION: Final = 1

_CHUNK_BYTES: Final = 32 * 2**20


@dataclass(frozen=True, eq=False)
class PanoramaBank:
    """Random values of a model and the descriptors of their instances.

    Args:
        values: x of each instance.
        descriptors: flat panorama descriptors, one row an instance; may be a read-only memory map.
        model_digest: the model they belong to.
        subdivision_steps: of the instances.

    Raises:
        EstimationError: no rows, or the arrays differ in length.
    """

    values: Float[np.ndarray, "N P"]
    descriptors: Float32[np.ndarray, "M D"]
    model_digest: str
    subdivision_steps: int = 2

    def __post_init__(self) -> None:
        if len(self.values) == 0 or len(self.values) != len(self.descriptors):
            counts = f"{len(self.values)} and {len(self.descriptors)}"
            raise EstimationError(f"a bank has as many values as descriptors, got {counts}", where="bank")

    def __len__(self) -> int:
        return len(self.values)

    def check_fits(self, generator: InstanceGenerator, subdivision_steps: int) -> None:
        """Raise EstimationError unless the bank was built from this model, in this way."""
        from shapewright.distances.panorama import DESCRIPTOR_SIZE

        if self.model_digest != generator.model.digest:
            raise EstimationError("the bank belongs to another model or another version of it", where="bank")
        if self.subdivision_steps != subdivision_steps:
            raise EstimationError(
                f"the bank was built with {self.subdivision_steps} subdivision steps, not {subdivision_steps}",
                where="bank",
            )
        widths = (self.values.shape[1], self.descriptors.shape[1])
        if widths != (len(generator.minimum), DESCRIPTOR_SIZE):
            raise EstimationError("the bank does not have the columns of the model and its descriptors", where="bank")

    def save(self, path: str | Path) -> None:
        """Write one uncompressed ``.npz`` file, completely or not at all.

        numpy reads it, and :meth:`load` maps its arrays into memory: each begins at a multiple of 64 bytes.

        Raises:
            OSError: the file cannot be written.
        """
        from shapewright.distances.descriptor_files import descriptor_header

        rest = {"model_digest": self.model_digest, "subdivision_steps": self.subdivision_steps}
        write_arrays(
            path, descriptor_header(FORMAT, VERSION, rest), {"values": self.values, "descriptors": self.descriptors}
        )

    @classmethod
    def load(cls, path: str | Path, *, memory_map: bool = True) -> "PanoramaBank":
        """Read a bank; with ``memory_map`` the arrays stay in the file and are read when used.

        Raises:
            EstimationError: the file is no bank, is damaged, or is of another version of the format or of the
                descriptor.
            OSError: the file cannot be opened.
        """
        from shapewright.distances.descriptor_files import OutdatedFileError, read_descriptor_header

        source = Path(path)
        try:
            header = read_descriptor_header(source, FORMAT, VERSION)
            values, descriptors = read_arrays(source, ("values", "descriptors"), memory_map=memory_map)
            return cls(values, descriptors, str(header["model_digest"]), int(header["subdivision_steps"]))
        except OutdatedFileError as error:
            raise EstimationError(str(error), where=source.name) from error
        except (KeyError, ValueError, TypeError) as error:
            raise EstimationError(f"the file is no bank or is damaged: {error}", where=source.name) from error


class BankCancelled(Cancelled):
    """The building was cancelled. ``bank`` holds the samples that were ready, ``None`` if there are none."""

    def __init__(self, bank: PanoramaBank | None) -> None:
        super().__init__("the building of the bank was cancelled")
        self.bank = bank


def bank_chunks(
    generator: InstanceGenerator,
    samples: int,
    rng: np.random.Generator,
    *,
    subdivision_steps: int = 2,
    progress: Progress = NULL_PROGRESS,
) -> Iterator[PanoramaBank]:
    """Build a bank piece by piece, so that a caller has what is finished if ``progress`` cancels.

    A model without parameters has one instance, whatever ``samples`` says. Work memory is bounded: a piece
    holds at most 32 MiB of vertices.

    Raises:
        EstimationError: fewer than one sample.
    """
    from shapewright.distances.panorama import panorama_descriptors

    if samples < 1:
        raise EstimationError(f"a bank needs at least one instance, got {samples}", where="samples")
    if len(generator.minimum) == 0:
        samples = 1
    triangles = generator.surface_triangles(subdivision_steps)
    n_vertices = int(triangles.max()) + 1
    size = max(1, min(256, _CHUNK_BYTES // (24 * n_vertices)))
    values = generator.random_values(rng, samples)  # at once: the same rows however they are cut into pieces
    for start in range(0, samples, size):
        progress.report(start / samples, f"random instances: {start} of {samples}")
        rows = values[start : start + size]
        points = generator.surface_points(rows, subdivision_steps)
        batch = panorama_descriptors(points, triangles).to_array()
        yield PanoramaBank(rows, batch, generator.model.digest, subdivision_steps)
    progress.report(1.0, f"random instances: {samples} of {samples}")


def joined(chunks: list[PanoramaBank]) -> PanoramaBank:
    """One bank of several of the same model."""
    return PanoramaBank(
        np.concatenate([chunk.values for chunk in chunks]),
        np.concatenate([chunk.descriptors for chunk in chunks]),
        chunks[0].model_digest,
        chunks[0].subdivision_steps,
    )


def build_bank(
    generator: InstanceGenerator,
    samples: int = 10_000,
    rng: np.random.Generator | None = None,
    progress: Progress = NULL_PROGRESS,
    *,
    subdivision_steps: int = 2,
) -> PanoramaBank:
    """Random instances (every active parameter uniform in its range) and their descriptors.

    Args:
        generator: a compiled model.
        samples: instances, 10 000 in the paper.
        rng: source of the values; seeded with 0 if not given.
        progress: told after every piece; may cancel.
        subdivision_steps: of the instances.

    Raises:
        BankCancelled: the progress cancelled.
        EstimationError: fewer than one sample.
    """
    rng = np.random.default_rng(0) if rng is None else rng
    chunks: list[PanoramaBank] = []
    try:
        for chunk in bank_chunks(generator, samples, rng, subdivision_steps=subdivision_steps, progress=progress):
            chunks.append(chunk)  # noqa: PERF402 - what is there when the generator is cancelled counts
    except Cancelled:
        raise BankCancelled(joined(chunks) if chunks else None) from None
    return joined(chunks)


def build_bank_for(
    generator: InstanceGenerator, settings: EstimationSettings, progress: Progress = NULL_PROGRESS
) -> PanoramaBank:
    """Build the bank that an estimation with these settings scans.

    Raises:
        BankCancelled: the progress cancelled.
    """
    rng, _ = np.random.default_rng(settings.seed).spawn(2)  # the second spreads the points on the query
    return build_bank(generator, settings.samples, rng, progress, subdivision_steps=settings.subdivision_steps)
