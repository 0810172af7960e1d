"""What a coverage run can use again: banks of variations, descriptors of meshes, nearest rows.

Everything is kept in one folder and found by content: the digest of a model, the SHA-256 of a mesh file, and the
version of the descriptor.
"""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from shapewright.distances.descriptor_files import descriptor_version
from shapewright.distances.panorama import PanoramaDescriptor, panorama_descriptors
from shapewright.errors import EstimationError, MeshError
from shapewright.estimation.bank import PanoramaBank, build_bank
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, Progress
from shapewright.whole_file import write_whole

_PROBED_ROWS: Final = 4


@dataclass(frozen=True)
class BankRequest:
    """Which random variations: of which model, how many, from which seed."""

    compiled: CompiledModel
    samples: int
    seed: int

    @property
    def stem(self) -> str:
        """Name of the files that belong to it."""
        model = self.compiled.model
        return f"{model.name}-{self.samples}-{self.seed}-{model.digest[:24]}-d{descriptor_version()}"

    @property
    def family(self) -> str:
        """Beginning of the names of files that answer the same request to any version of the model."""
        return f"{self.compiled.model.name}-{self.samples}-{self.seed}-"


class DescriptorCache:
    """A folder that is made when first written to; several processes may use it at once.

    A new version of a model replaces what was kept of the one before.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def bank(self, request: BankRequest, progress: Progress = NULL_PROGRESS) -> PanoramaBank:
        """Map a kept bank into memory, or build and keep it."""
        path = self._folder / f"{request.stem}.npz"
        bank = _load_bank(path, request)
        if bank is None:
            rng = np.random.default_rng(request.seed)
            built = build_bank(request.compiled, request.samples, rng, progress)
            self._folder.mkdir(parents=True, exist_ok=True)
            for ending in ("npz", "json"):  # not *: another process may be writing beside its target
                for old in self._folder.glob(f"{request.family}*.{ending}"):
                    if old != path:  # another process may have built the same bank, and be about to map it
                        old.unlink(missing_ok=True)
            built.save(path)
            del built
            bank = PanoramaBank.load(path)
        return bank

    def mesh_descriptor(self, digest: str) -> PanoramaDescriptor | None:
        """Return the descriptor of a mesh file, by the SHA-256 of its bytes, if it is kept."""
        try:
            return PanoramaDescriptor.from_array(np.frombuffer(self._mesh_path(digest).read_bytes(), dtype="<f4"))
        except (OSError, ValueError, MeshError):
            return None

    def keep_mesh_descriptor(self, digest: str, descriptor: PanoramaDescriptor) -> None:
        """Keep the descriptor of a mesh file."""
        self._folder.mkdir(parents=True, exist_ok=True)
        write_whole(self._mesh_path(digest), descriptor.to_array().astype("<f4").tobytes())

    def nearest(self, request: BankRequest) -> dict[str, tuple[float, int]]:
        """Return what is known about a bank: digest of a mesh file to distance and row of the nearest variation."""
        try:
            kept = json.loads((self._folder / f"{request.stem}.json").read_text())
            return {str(digest): (float(distance), int(row)) for digest, (distance, row) in kept.items()}
        except (OSError, ValueError, AttributeError, TypeError):
            return {}

    def keep_nearest(self, request: BankRequest, table: dict[str, tuple[float, int]]) -> None:
        """Keep distances and rows beside the bank."""
        write_whole(self._folder / f"{request.stem}.json", json.dumps(table).encode())

    def _mesh_path(self, digest: str) -> Path:
        return self._folder / f"mesh-{digest}-d{descriptor_version()}.f4"


def file_digest(path: Path) -> str:
    """SHA-256 of a file and the ending of its name, which tells how it is read.

    Raises:
        OSError: the file cannot be read.
    """
    with path.open("rb") as file:
        return hashlib.sha256(hashlib.file_digest(file, "sha256").digest() + path.suffix.lower().encode()).hexdigest()


def _load_bank(path: Path, request: BankRequest) -> PanoramaBank | None:
    """A kept bank, if the model still gives these variations: sampler and kernel may have changed, not the model."""
    try:
        bank = PanoramaBank.load(path)
    except (OSError, EstimationError):
        return None
    compiled = request.compiled
    values = compiled.random_values(np.random.default_rng(request.seed), len(bank))
    if bank.model_digest != compiled.model.digest or not np.array_equal(values, bank.values):
        return None
    rows = np.linspace(0, len(bank) - 1, _PROBED_ROWS).astype(np.int64)
    probed = panorama_descriptors(compiled.surface_points(values[rows]), compiled.surface_triangles()).to_array()
    return bank if np.allclose(probed, bank.descriptors[rows], atol=1e-4) else None
