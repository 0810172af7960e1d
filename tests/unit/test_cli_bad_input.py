"""Bad files given to the command: one line that names the file and the place in it, and nothing is left behind."""

import copy
import json
import resource
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from command_line import shapewright, write_lamp_model

TETRAHEDRON = b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
LINK = (
    b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "../secret.bin", "byteLength": 36}], '
    b'"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}'
)
MESHES = {
    "empty.off": (b"", "byte 0: the file is empty"),
    "truncated.off": (TETRAHEDRON[:-20], "truncated"),
    "nan.off": (TETRAHEDRON.replace(b"\n0 1 0\n", b"\n0 nan 0\n"), "vertices[2]"),
    "one.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "fewer than 4 faces"),
    "wrong.stl": (TETRAHEDRON, "the content is OFF"),
    "mesh.exe": (TETRAHEDRON, "no mesh type we read"),
    "scan.xyz": (b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n", "no faces: it is a cloud of 4 points"),
    "link.gltf": (LINK, "buffers[0].uri"),
}


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("verb", [["render", "-o", "a.png"], ["estimate", "-m", "table", "-o", "a.glb"]])
def test_meshes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, verb: list[str], name: str) -> None:
    monkeypatch.chdir(tmp_path)
    data, told = MESHES[name]
    Path(name).write_bytes(data)
    message = shapewright(verb[0], name, *verb[1:], "--json").refused()
    assert message.startswith(repr(name))
    assert told in message
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_mesh_over_the_size_limit(tmp_path: Path) -> None:
    large = tmp_path / "large.off"
    with large.open("wb") as file:
        file.truncate(1 << 40)  # a hole: it takes no room on the disk
    message = shapewright("render", large, "-o", tmp_path / "a.png").refused()
    assert "large.off" in message
    assert "limit" in message
    assert list(tmp_path.iterdir()) == [large]


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("operations", 1, "op"), "explode", "operations[1].op: unknown operation"),
        (("operations", 1, "targets", 0, "elements", 0), "f99", "operations[1]: face f99 does not exist"),
        (("parameters", 0, "range"), [1.5, 2.0], "parameters[0]: the range"),
    ],
)
def test_documents(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: tuple[Any, ...], value: Any, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    document = copy.deepcopy(json.loads(write_lamp_model(tmp_path).read_text()))
    holder: Any = document
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    Path("wrong.json").write_text(json.dumps(document))
    for arguments in (["instance", "wrong.json", "-o", "a.glb"], ["train", "table", "wrong.json", "-o", "a.onnx"]):
        assert f"wrong.json: {told}" in shapewright(*arguments, "--json").refused()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["lamp.json", "wrong.json"]


def test_a_document_of_broken_json(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("broken.json").write_text('{"format": ')
    message = shapewright("instance", "broken.json", "-o", "a.glb").refused()
    assert message.startswith("broken.json: line 1 column 12: broken JSON")


@pytest.mark.parametrize(
    "arguments", [["instance", "table", "-o", "a.glb"], ["render", "table", "--size", "256", "-o", "a.png"]]
)
def test_a_full_disk(tmp_path: Path, arguments: list[str]) -> None:
    def nearly_full() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

    command = [sys.executable, "-m", "cli", *arguments, "--json"]
    done = subprocess.run(command, cwd=tmp_path, preexec_fn=nearly_full, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.strip() == f"shapewright: {arguments[-1]}: File too large"
    assert list(tmp_path.iterdir()) == []
