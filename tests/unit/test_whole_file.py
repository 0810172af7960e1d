"""A file is written completely or not at all."""

import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from shapewright.modeling import Recorder, compile_model
from shapewright.whole_file import write_whole


@contextmanager
def full_disk(free_bytes: int) -> Iterator[None]:
    """No file of this process may grow over a size, which is what a full disk looks like to the writer."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (free_bytes, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_leaves_nothing_and_what_was_there(tmp_path: Path) -> None:
    old = tmp_path / "old.bin"
    write_whole(old, b"old")
    for path in (old, tmp_path / "new.bin"):
        with full_disk(1000), pytest.raises(OSError, match="too large") as caught:
            write_whole(path, bytes(5000))
        assert caught.value.filename == str(path)
    assert [path.name for path in tmp_path.iterdir()] == ["old.bin"]
    assert old.read_bytes() == b"old"


def test_meshes_and_models_are_written_whole(tmp_path: Path) -> None:
    recorder = Recorder("brick", "brick")
    recorder.box(1.0, 2.0, 3.0)
    model = recorder.build()
    with full_disk(50):
        with pytest.raises(OSError, match="too large"):
            model.save(tmp_path / "brick.json")
        with pytest.raises(OSError, match="too large"):
            compile_model(model).instance(np.ones(0)).save(tmp_path / "brick.off")
    assert list(tmp_path.iterdir()) == []


def test_a_link_is_followed_and_a_missing_folder_is_named(tmp_path: Path) -> None:
    link = tmp_path / "link.bin"
    link.symlink_to("target.bin")
    write_whole(str(link), b"through")
    assert link.is_symlink()
    assert (tmp_path / "target.bin").read_bytes() == b"through"
    with pytest.raises(FileNotFoundError, match="missing"):
        write_whole(tmp_path / "missing" / "file.bin", b"")
