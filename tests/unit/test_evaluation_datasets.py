"""Datasets: what is read, what is refused, and how a limit spreads over the classes."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_dataset import slab, write_dataset

from shapewright.errors import EvaluationError
from shapewright.evaluation.datasets import LabelledFile, Skipped, load_each, of_classes, read_dataset, spread
from shapewright.mesh import TriangleMesh
from shapewright.modeling import compile_model

labels = st.lists(st.sampled_from(["fish", "gun", "table", "other"]), min_size=1, max_size=40)


def items(class_names: list[str]) -> list[LabelledFile]:
    return [LabelledFile(f"{i}.off", name, Path(f"{i}.off")) for i, name in enumerate(class_names)]


def test_files_are_found_below_the_folder_and_below_its_meshes(tmp_path: Path) -> None:
    good = write_dataset(tmp_path, [(compile_model(slab()), 2)])
    read = read_dataset(tmp_path)
    assert [item.file for item in read] == [*good, "cube.off", "broken.off", "missing.off"]
    assert read[0].path == tmp_path / "meshes" / good[0]
    (tmp_path / good[0]).write_bytes((tmp_path / "meshes" / good[0]).read_bytes())
    assert read_dataset(tmp_path)[0].path == tmp_path / good[0]
    assert {item.class_name for item in of_classes(read, ["slab", "sword"])} == {"slab"}


def test_unreadable_meshes_are_told_and_the_others_read(tmp_path: Path) -> None:
    write_dataset(tmp_path, [(compile_model(slab()), 1)])
    read = read_dataset(tmp_path)
    for jobs in (1, 3):
        loaded = [mesh for _, mesh in load_each(read, jobs=jobs)]
        assert [type(mesh) for mesh in loaded] == [TriangleMesh, TriangleMesh, Skipped, Skipped], loaded
    assert loaded[3] == Skipped("missing.off", "cannot be read: No such file or directory")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "a folder with labels.csv"),
        (b"file,label\na.off,fish\n", "the column 'class' is missing"),
        (b"file,class\n", "no meshes"),
        (b"", "the column 'class' is missing"),
        (b"file,class\n\na.off,\n", "line 3"),
        (b"file,class\na.off\n", "line 2"),
        (b"file,class\n../a.off,fish\n", "line 2: '../a.off' is no path below"),
        (b"file,class\nmeshes/../../a.off,fish\n", "no path below"),
        (b"file,class\n/etc/a.off,fish\n", "no path below"),
        (b"file,class\na\0b.off,fish\n", "no path below"),
        (b"file,class\n\xff\xfe,x\n", "comma-separated"),
    ],
)
def test_what_is_no_dataset_is_refused(tmp_path: Path, content: bytes | None, message: str) -> None:
    if content is not None:
        (tmp_path / "labels.csv").write_bytes(content)
    with pytest.raises(EvaluationError, match=message):
        read_dataset(tmp_path)


def test_a_name_that_no_file_system_takes_is_skipped(tmp_path: Path) -> None:
    (tmp_path / "labels.csv").write_text(f"file,class\n{'a' * 3000}.off,fish\n")
    ((_, mesh),) = load_each(read_dataset(tmp_path))
    assert isinstance(mesh, Skipped)
    assert "too long" in mesh.reason


@given(labels, st.integers(1, 50))
def test_a_limit_takes_as_many_of_each_class_as_it_can(class_names: list[str], limit: int) -> None:
    every = items(class_names)
    chosen = spread(every, limit)
    assert len(chosen) == min(limit, len(every))
    assert list(chosen) == [item for item in every if item in chosen]
    assert spread(every, limit) == chosen
    counts, available = Counter(item.class_name for item in chosen), Counter(class_names)
    fullest = max(counts.values())
    assert all(counts[name] >= min(fullest - 1, available[name]) for name in available)


def test_without_a_limit_all_are_taken() -> None:
    every = items(["fish", "gun"])
    assert spread(every, None) == tuple(every)
    assert [item.file for item in spread(items(["fish"] * 10), 2)] == ["2.off", "7.off"]
