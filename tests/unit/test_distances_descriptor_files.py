"""Descriptors of another version: files are refused, caches compute them again, and no change goes unnoticed."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from small_dataset import slab

from models_store.artifacts import ArtifactStore
from shapewright.classification.exemplars import Exemplars
from shapewright.distances import descriptor_files, panorama
from shapewright.distances.panorama import DESCRIPTOR_SIZE, PanoramaDescriptor, panorama_descriptor, panorama_distance
from shapewright.errors import ClassifierError, EstimationError, ShapewrightError
from shapewright.estimation import EstimationSettings, PanoramaBank
from shapewright.evaluation.descriptor_cache import BankRequest, DescriptorCache
from shapewright.modeling import compile_model
from shapewright.progress import NULL_PROGRESS
from shapewright.retrieval import CollectionIndex
from shapewright.training.versions import learning_versions
from workers.stored.banks import bank_key, new_bank, stored_bank

FOURIER = [0.02986, 0.02201, 0.02048, 0.02051, 0.02387, 0.02561]
WAVELETS = [1.05623, 0.96505, 0.76149, 0.7053, 1.02399, 1.01859]
DISTANCE = 0.30234
"""Numbers of version 1: spread of the Fourier parts, means of the wavelet parts, and a distance."""
SLAB = compile_model(slab())
ROW = np.linspace(0.0, 1.0, DESCRIPTOR_SIZE, dtype=np.float32)[None]
NUMBERS = np.zeros(1, np.int32)
ONE = np.ones((1, 1), np.float32)
FILES: dict[str, tuple[Any, Callable[[Path], Any], type[ShapewrightError], str]] = {
    "bank": (PanoramaBank(np.ones((1, 1)), ROW, "a" * 64), PanoramaBank.load, EstimationError, "make it anew"),
    "exemplars": (
        Exemplars(("slab",), ("a" * 64,), 0, 2, NUMBERS, NUMBERS, NUMBERS, ROW),
        Exemplars.load,
        ClassifierError,
        "train again",
    ),
    "index": (
        CollectionIndex(("a",), ("slab",), "b" * 64, ONE, ONE, ONE[0], ROW),
        CollectionIndex.load,
        ClassifierError,
        "make it anew",
    ),
}


@pytest.fixture
def next_version(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Lets the library compute descriptors of the next version from then on."""
    return lambda: monkeypatch.setattr(descriptor_files, "VERSION", panorama.VERSION + 1)


def test_a_change_of_descriptor_or_distance_raises_the_version() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.3, 1.4, 0.2], [0.2, 0.5, 2.1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    first, second = panorama_descriptor(corners, faces), panorama_descriptor(corners**2 + corners, faces)
    axes = first.to_array().reshape(6, -1)  # three of each alignment
    fourier, wavelets = axes[:, :154].std(axis=1), axes[:, 154:].mean(axis=1)
    message = "raise VERSION in distances/panorama.py, and write the new numbers here"
    assert panorama.VERSION == 1, message
    np.testing.assert_allclose(fourier, FOURIER, rtol=2e-3, err_msg=message)
    np.testing.assert_allclose(wavelets, WAVELETS, rtol=1e-3, err_msg=message)
    assert panorama_distance(first, second) == pytest.approx(DISTANCE, rel=1e-3), message


@pytest.mark.parametrize("kind", FILES)
def test_a_file_of_another_version_is_refused(kind: str, tmp_path: Path, next_version: Callable[[], None]) -> None:
    kept, load, refusal, advice = FILES[kind]
    path = tmp_path / "kept.npz"
    kept.save(path)
    load(path)
    next_version()
    with pytest.raises(refusal, match=f"another version of the descriptor .*{advice}"):
        load(path)
    kept.save(path)
    load(path)


def test_the_cache_of_descriptors_makes_everything_anew(tmp_path: Path, next_version: Callable[[], None]) -> None:
    cache, request = DescriptorCache(tmp_path), BankRequest(SLAB, 2, 0)
    cache.bank(request)
    cache.keep_nearest(request, {"c" * 64: (0.5, 1)})
    cache.keep_mesh_descriptor("c" * 64, PanoramaDescriptor.from_array(ROW[0]))
    (old,) = tmp_path.glob("slab-*.npz")
    next_version()
    assert cache.nearest(request) == {}
    assert cache.mesh_descriptor("c" * 64) is None
    cache.bank(request)
    (new,) = tmp_path.glob("slab-*.npz")
    assert new != old


def test_a_worker_builds_the_bank_anew(tmp_path: Path, next_version: Callable[[], None]) -> None:
    artifacts, settings = ArtifactStore.open(str(tmp_path)), EstimationSettings(samples=2)
    context: Any = SimpleNamespace(artifacts=artifacts, settings=SimpleNamespace(data_dir=tmp_path))
    new_bank(context, SLAB, settings, NULL_PROGRESS)
    assert stored_bank(context, SLAB, settings) is not None
    old = bank_key(SLAB, settings)
    next_version()
    assert stored_bank(context, SLAB, settings) is None
    artifacts.put(bank_key(SLAB, settings), artifacts.get(old))  # whatever its name says
    assert stored_bank(context, SLAB, settings) is None


@pytest.mark.parametrize("module", ["shapewright.classification.readings", "shapewright.training.broken.breaking"])
def test_a_kept_classifier_is_trained_anew_after_other_readings_and_breaks(
    monkeypatch: pytest.MonkeyPatch, module: str
) -> None:
    before = learning_versions()
    monkeypatch.setattr(f"{module}.VERSION", 99)
    assert learning_versions() != before


def test_a_kept_classifier_is_trained_anew(next_version: Callable[[], None]) -> None:
    before = learning_versions()
    next_version()
    assert learning_versions() != before
