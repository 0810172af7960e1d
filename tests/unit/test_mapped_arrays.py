"""Arrays in a file that can be mapped into memory."""

from pathlib import Path

import numpy as np
import pytest

from shapewright.mapped_arrays import read_arrays, read_header, write_arrays

ARRAYS = {"ids": np.arange(7, dtype=np.int64), "rows": np.arange(12.0, dtype=np.float32).reshape(4, 3)}


def test_what_is_written_is_read_mapped_or_not_and_by_numpy(tmp_path: Path) -> None:
    path = tmp_path / "some.npz"
    write_arrays(path, {"format": "test", "names": ["ä", "b"]}, {**ARRAYS, "none": np.empty((0, 5))})
    assert read_header(path) == {"format": "test", "names": ["ä", "b"]}
    for memory_map in (True, False):
        ids, rows, none = read_arrays(path, ("ids", "rows", "none"), memory_map=memory_map)
        np.testing.assert_array_equal(ids, ARRAYS["ids"])
        np.testing.assert_array_equal(rows, ARRAYS["rows"])
        assert none.shape == (0, 5)
    mapped = read_arrays(path, ("rows",))[0]
    assert isinstance(mapped, np.memmap)
    assert mapped.ctypes.data % 64 == 0
    assert not mapped.flags.writeable
    with np.load(path) as archive:
        np.testing.assert_array_equal(archive["rows"], ARRAYS["rows"])
    assert [item.name for item in tmp_path.iterdir()] == [path.name]


def test_a_compressed_file_is_smaller_and_reads_the_same(tmp_path: Path) -> None:
    path, plain = tmp_path / "some.npz", tmp_path / "plain.npz"
    arrays = {**ARRAYS, "even": np.zeros((100, 10))}
    write_arrays(path, {"format": "test"}, arrays, compressed=True)
    write_arrays(plain, {"format": "test"}, arrays)
    assert path.stat().st_size < plain.stat().st_size - 7000
    assert read_header(path) == {"format": "test"}
    for read, array in zip(read_arrays(path, list(arrays), memory_map=False), arrays.values(), strict=True):
        np.testing.assert_array_equal(read, array)
    with pytest.raises(ValueError, match="compressed"):
        read_arrays(path, ("rows",))


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    path = tmp_path / "some.npz"
    write_arrays(path, {}, ARRAYS)
    with pytest.raises(ValueError, match="other"):
        read_arrays(path, ("other",))
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(ValueError, match="zip"):
        read_header(path)
    np.savez_compressed(path, header=np.frombuffer(b"[]", dtype=np.uint8), rows=np.zeros((9, 9)))
    with pytest.raises(ValueError, match="no object"):
        read_header(path)
    with pytest.raises(ValueError, match="compressed"):
        read_arrays(path, ("rows",))
