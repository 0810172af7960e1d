"""Stores of arrays: what is put comes back, from files as a map; damage reads as missing."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from shapewright.training import FolderStore, MemoryStore
from shapewright.training.array_store import mapped_array, npy_bytes

KEY = "features/some-network/0-0-12.npy"
ARRAY = np.arange(60, dtype=np.float16).reshape(3, 4, 5)


@pytest.fixture(params=["memory", "folder"])
def store(request, tmp_path: Path):
    return MemoryStore() if request.param == "memory" else FolderStore(tmp_path / "not" / "yet")


def test_what_is_put_comes_back(store) -> None:
    assert store.get(KEY) is None
    store.put(KEY, ARRAY)
    found = store.get(KEY)
    assert found.dtype == ARRAY.dtype
    assert np.array_equal(found, ARRAY)
    assert store.get(KEY.replace("12", "13")) is None
    store.put(KEY, ARRAY + 1)
    assert np.array_equal(store.get(KEY), ARRAY + 1)


def test_a_folder_is_mapped_and_shared(tmp_path: Path) -> None:
    FolderStore(tmp_path).put(KEY, ARRAY)
    found = FolderStore(str(tmp_path)).get(KEY)
    assert isinstance(found, np.memmap)
    assert not found.flags.writeable
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == ["0-0-12.npy"], "nothing else is left"


def test_damage_reads_as_missing(tmp_path: Path) -> None:
    store, content = FolderStore(tmp_path), npy_bytes(ARRAY)
    store.put(KEY, ARRAY)
    path = tmp_path / KEY
    for damaged in (b"", b"\x93NUMPY", content[:40], content[:-1], b"no array at all" * 10):
        path.write_bytes(damaged)
        assert store.get(KEY) is None
    np.savez(path.with_suffix(".npz"), a=ARRAY)
    path.with_suffix(".npz").replace(path)
    assert store.get(KEY) is None, "several arrays are none"
    np.save(path, np.array([{"an": "object"}]), allow_pickle=True)
    assert store.get(KEY) is None, "nothing is unpickled"
    store.put(KEY, ARRAY)
    assert np.array_equal(store.get(KEY), ARRAY)


@given(place=st.integers(0, 127), byte=st.integers(0, 255))
@settings(
    deadline=None, max_examples=300, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
)
def test_a_broken_byte_of_the_header_never_raises(tmp_path: Path, place: int, byte: int) -> None:
    content = bytearray(npy_bytes(ARRAY))
    content[place] = byte
    path = tmp_path / "array.npy"
    path.write_bytes(content)
    found = mapped_array(path)
    assert found is None or isinstance(found, np.ndarray)
