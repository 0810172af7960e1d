import base64
import contextlib
import json
import os
import re
import signal
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.errors import MeshFileError
from shapewright.mesh import TriangleMesh
from shapewright.mesh.decode import decode_query
from shapewright.mesh.file import DEFAULT_LIMITS, MeshReader, load_mesh, parse_mesh
from shapewright.mesh.sniff import MESH_TYPES, POINT_TYPES, check_content

BALL = TriangleMesh.from_trimesh(trimesh.creation.icosphere(2)).cleaned()
WRITTEN = {name: BALL.to_bytes(name) for name in ("glb", "obj", "off", "ply", "stl")}
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


def gltf_with(uri):
    indices = BALL.faces.astype("<u4").tobytes()
    positions = BALL.vertices.astype("<f4").tobytes()
    data = indices + positions
    low, high = BALL.bounds.astype("<f4").tolist()
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5125, "count": BALL.faces.size, "type": "SCALAR"},
                {
                    "bufferView": 1,
                    "componentType": 5126,
                    "count": len(BALL.vertices),
                    "type": "VEC3",
                    "min": low,
                    "max": high,
                },
            ],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": len(indices)},
                {"buffer": 0, "byteOffset": len(indices), "byteLength": len(positions)},
            ],
            "buffers": [{"byteLength": len(data), "uri": uri or data_uri(data)}],
        }
    ).encode()


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


@pytest.mark.parametrize("file_type", ["glb", "gltf", "obj", "off", "ply", "stl"])
def test_strangers_files_are_read_in_a_child(file_type):
    data = gltf_with(None) if file_type == "gltf" else WRITTEN[file_type]
    mesh = parse_mesh(data, f".{file_type.upper()}")
    assert len(mesh.faces) == len(BALL.faces)
    assert mesh.is_watertight
    assert mesh.area == pytest.approx(BALL.area, rel=1e-5)
    assert mesh.vertices.flags.writeable


def test_ascii_stl_and_ply_are_read():
    ball = BALL.to_trimesh()
    text = ball.export(file_type="stl_ascii")
    assert parse_mesh(text.encode(), "stl").is_watertight
    assert parse_mesh(ball.export(file_type="ply", encoding="ascii"), "ply").is_watertight


def test_a_scene_becomes_one_mesh_with_its_transforms():
    scene = trimesh.Scene()
    for k in range(3):
        scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=np.diag([2, 2, 2, 1]) + [[0, 0, 0, 5 * k]] + 0)
    mesh = parse_mesh(scene.export(file_type="glb"), "glb")
    assert len(mesh.faces) == 36
    assert mesh.area == pytest.approx(3 * 24)


def test_obj_of_the_wild():
    text = (
        b"\xef\xbb\xbf# comment\r\nmtllib /etc/passwd\r\nmtllib ../../secret.mtl\r\n"
        b"g part one\r\nusemtl red\r\n"
        b"f 1/1/1 2/2/2 \\\r\n 3/3/3 4//4\r\n"  # before its vertices, and continued
        b"v 0 0 0\r\nv 1 0 0 0.5 0.5 0.5\r\nv 1 1 0\r\nv 0 1 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
        b"o part two\r\nv 0 0 1\r\nf -1 1 2\r\nf -1 2 3\r\nf 5 3 4\nf 1 2\nl 1 2\ns off\n"
    )
    mesh = parse_mesh(text, "obj")
    assert len(mesh.vertices) == 5
    assert len(mesh.faces) == 5


def test_off_of_the_wild():
    text = (
        b"# made by hand\nCOFF 5 5 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0 0 0 0 0\n\n0 1 0 0 0 0 0\n0 0 1 0 0 0 0\n"
        b"4 0 1 2 3 0.5 0.5 0.5 # a quad with a colour\n3 4 0 1\n3 4 1 2\n3 4 2 3\n2 0 1\n"
    )
    mesh = parse_mesh(text, "off")
    assert len(mesh.faces) == 5
    spaced = WRITTEN["off"].replace(b"OFF\n", b"OFF ", 1).replace(b"\n", b"\r\n")
    assert len(parse_mesh(spaced, "off").faces) == len(BALL.faces)


BAD = {
    "empty": (b"", "obj", "empty"),
    "blank": (b" \n\n ", "off", "empty"),
    "a picture called obj": (PNG, "obj", "says OBJ.*PNG"),
    "an obj called stl": (WRITTEN["obj"], "stl", "says STL.*OBJ"),
    "an stl called ply": (WRITTEN["stl"], "ply", "says PLY.*STL"),
    "a glb called off": (WRITTEN["glb"], "off", "says OFF.*GLB"),
    "an off called obj": (WRITTEN["off"], "obj", "says OBJ.*OFF"),
    "an archive": (b"PK\x03\x04" + bytes(100), "glb", "not unpacked"),
    "prose": (b"dear reader,\nvoila\n", "obj", "not OBJ"),
    "a web page": (b"<!doctype html><p>404", "obj", "HTML"),
    "unknown type": (WRITTEN["obj"], "exe", "no mesh type"),
    "type with NUL": (WRITTEN["obj"], "obj\0", "no mesh type"),
    "no faces": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "obj", "no faces"),
    "one triangle": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj", "fewer than 4 faces is no solid object"),
    "no area": (b"v 0 0 0\nv 1 0 0\nv 2 0 0\n" + b"f 1 2 3\n" * 5, "obj", "no face has an area"),
    "NaN": (b"v 0 0 0\nv 1 nan 0\nv 0 1 0\n" + b"f 1 2 3\n" * 5, "obj", r"vertices\[1\].*NaN"),
    "infinite": (b"v 0 0 0\nv 1 1e999 0\nv 0 1 0\n" + b"f 1 2 3\n" * 5, "obj", r"vertices\[1\]"),
    "absurd size": (b"v 0 0 0\nv 1 1e40 0\nv 0 1 0\n" + b"f 1 2 3\n" * 5, "obj", r"vertices\[1\].*beyond"),
    "no number": (b"v 0 0 0\nv 1 one 0\n", "obj", "line 2.*no number"),
    "no vertex 9": (b"v 0 0 0\nf 1 9 1\n", "obj", "vertex 9 of 1"),
    "vertex 0": (b"v 0 0 0\nf 0 1 1\n", "obj", "line 2.*vertex 0"),
    "huge index": (b"v 0 0 0\nf 1 1 " + b"9" * 30 + b"\n", "obj", "vertex 9+ of 1"),
    "endless digits": (b"v 0 0 0\nf 1 1 " + b"9" * 9000 + b"\n", "obj", "corner"),
    "off without counts": (b"OFF\nabc\n", "off", "line 2.*counts"),
    "off with absurd counts": (b"OFF\n999999999999 999999999999 0\n0 0 0\n", "off", "ends after 1 of"),
    "off with a bad corner": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "off", "line 6.*one of 3"),
    "gltf with a link": (gltf_with("ball.bin"), "gltf", r"buffers\[0\].uri.*another file"),
    "gltf with an address": (gltf_with("http://localhost/ball.bin"), "gltf", r"buffers\[0\].uri"),
    "gltf with a file address": (gltf_with("file:///etc/passwd"), "gltf", r"buffers\[0\].uri"),
    "gltf of broken JSON": (gltf_with(None)[:-9], "gltf", "broken JSON"),
    "deep JSON": (b'{"asset": ' + b"[" * 200_000, "gltf", "broken JSON"),
    "glb with another version": (b"glTF" + struct.pack("<II", 1, 24) + bytes(12), "glb", "version 1"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused_with_the_place(name):
    data, file_type, message = BAD[name]
    with pytest.raises(MeshFileError, match=message) as caught:
        parse_mesh(data, file_type)
    assert caught.value.where
    assert len(str(caught.value)) < 300 or "digits" in name


@pytest.mark.parametrize("file_type", ["glb", "off", "ply", "stl"])
@pytest.mark.parametrize("part", [0.01, 0.4, 0.8, 0.97])
def test_truncated_files_are_refused(file_type, part):
    data = WRITTEN[file_type]
    with pytest.raises(MeshFileError):
        refuse_here(data[: int(part * len(data))], file_type)


@pytest.mark.parametrize("part", [0.3, 0.6, 0.95])
def test_truncated_text_variants_are_refused(part):
    ball = BALL.to_trimesh()
    stl = ball.export(file_type="stl_ascii").encode()
    ply = ball.export(file_type="ply", encoding="ascii")
    for data, file_type in ((stl, "stl"), (ply, "ply")):
        with pytest.raises(MeshFileError, match=r"truncated|damaged"):
            refuse_here(data[: int(part * len(data))], file_type)


def test_a_truncated_obj_is_refused_when_vertices_are_missing():
    with pytest.raises(MeshFileError):
        refuse_here(WRITTEN["obj"][:3000], "obj")
    faces_first = b"\n".join(sorted(WRITTEN["obj"].splitlines()))
    with pytest.raises(MeshFileError, match="truncated"):
        refuse_here(faces_first[:-200].rsplit(b" ", 1)[0], "obj")


def refuse_here(data, file_type):
    """The same checks as in the child, without a process for each."""
    check_content(data, file_type)
    decode_query(data, file_type, DEFAULT_LIMITS)


@settings(max_examples=150, deadline=None)
@given(
    file_type=st.sampled_from(["glb", "obj", "off", "ply", "stl"]),
    cuts=st.lists(st.tuples(st.integers(0, 4000), st.binary(max_size=6)), min_size=1, max_size=4),
)
def test_damage_of_any_sort_reads_or_is_refused_but_never_breaks(file_type, cuts):
    data = bytearray(WRITTEN[file_type])
    for place, bytes_ in cuts:
        data[place : place + len(bytes_)] = bytes_
    with contextlib.suppress(MeshFileError):
        refuse_here(bytes(data), file_type)


def test_limits_of_size_and_counts():
    with pytest.raises(MeshFileError, match="limit of 100 bytes"):
        parse_mesh(WRITTEN["off"], "off", limits=replace(DEFAULT_LIMITS, size_bytes=100))
    with pytest.raises(MeshFileError, match="162 vertices are more than the limit of 161"):
        parse_mesh(WRITTEN["off"], "off", limits=replace(DEFAULT_LIMITS, vertices=161))
    with pytest.raises(MeshFileError, match="320 faces are more than the limit of 319"):
        parse_mesh(WRITTEN["off"], "off", limits=replace(DEFAULT_LIMITS, faces=319))


def test_limits_of_memory_and_time():
    large = b"v 0.125 0.25 0.375\n" * 500_000 + WRITTEN["obj"]
    with pytest.raises(MeshFileError, match="memory"):
        parse_mesh(large, "obj", limits=replace(DEFAULT_LIMITS, memory_bytes=150 * 2**20))
    with pytest.raises(MeshFileError, match="processor time"):
        parse_mesh(large * 3, "obj", limits=replace(DEFAULT_LIMITS, cpu_s=1))
    with pytest.raises(MeshFileError, match=r"more than 0\.01 s"):
        parse_mesh(large, "obj", limits=replace(DEFAULT_LIMITS, wall_s=0.01))


def test_a_bomb_of_instances_stops_at_a_limit():
    document = json.loads(gltf_with(None))
    document["nodes"] = [{"mesh": 0} for _ in range(20_000)]
    document["scenes"] = [{"nodes": list(range(20_000))}]
    limits = replace(DEFAULT_LIMITS, memory_bytes=2**30, cpu_s=5)
    with pytest.raises(MeshFileError):
        parse_mesh(json.dumps(document).encode(), "gltf", limits=limits)


def test_the_child_cannot_open_anything_once_it_reads():
    program = """
from shapewright.mesh import decode as reading, reader_process
reading.decode_query = lambda *_: open("/etc/hostname")
reader_process.main()
"""
    request = {"file_type": "obj", "limits": vars(DEFAULT_LIMITS), "size": len(WRITTEN["obj"])}
    child = subprocess.run(
        [sys.executable, "-c", program],
        input=json.dumps(request).encode() + b"\n" + WRITTEN["obj"],
        capture_output=True,
        check=False,
    )
    assert json.loads(child.stdout) == {"status": 1, "size": 0}
    assert b"Too many open files" in child.stderr


def test_one_reader_reads_many_files_and_outlives_bad_ones():
    large = b"v 0.125 0.25 0.375\n" * 500_000 + WRITTEN["obj"]
    with MeshReader() as reader:
        for limits, reason in (
            (replace(DEFAULT_LIMITS, memory_bytes=150 * 2**20), "memory"),
            (replace(DEFAULT_LIMITS, wall_s=0.05), "more than"),
            (replace(DEFAULT_LIMITS, faces=100), "320 faces"),
        ):
            with pytest.raises(MeshFileError, match=reason):
                parse_mesh(large, "obj", limits=limits, reader=reader)
            for file_type in ("obj", "glb"):
                assert len(parse_mesh(WRITTEN[file_type], file_type, reader=reader).faces) == len(BALL.faces)
        (process,) = reader._idle
        os.kill(process._popen.pid, signal.SIGKILL)  # whatever befalls it: the next file is not to blame
        np.testing.assert_array_equal(parse_mesh(WRITTEN["off"], "off", reader=reader).faces, BALL.faces)
        assert len(reader._idle) == 1


def test_a_hijacked_child_finds_no_other_file_and_answers_no_more_than_it_may():
    program = """
import sys
from shapewright.mesh import decode as reading, reader_process

class Huge:
    def __len__(self): return 1
    def tobytes(self): return bytes(10**6)

def decode(data, *_):
    if data == b"endless":
        return type("Mesh", (), {"vertices": Huge(), "faces": Huge()})
    found, frame = set(), sys._getframe()
    while frame is not None:
        found |= {one for one in frame.f_locals.values() if isinstance(one, bytes) and b"triangle" in one}
        frame = frame.f_back
    raise reading.MeshFileError(str(found))

reading.decode_query = decode
reader_process.main()
"""
    limits = vars(replace(DEFAULT_LIMITS, vertices=1000, faces=1000))
    requests = b""
    for data in (b"triangle 1", b"triangle 2", b"endless"):
        requests += json.dumps({"file_type": "obj", "limits": limits, "size": len(data)}).encode() + b"\n" + data
    child = subprocess.run([sys.executable, "-c", program], input=requests, capture_output=True, check=False)
    assert re.findall(rb"{b'triangle.*?}", child.stdout) == [b"{b'triangle 1'}", b"{b'triangle 2'}"]
    assert child.stdout.endswith(b'{"status": -9, "size": 0}\n')


def test_a_prepared_reader_has_a_process_for_the_first_file():
    with MeshReader() as reader:
        reader.prepare()
        reader.prepare()
        (process,) = reader._idle
        np.testing.assert_array_equal(parse_mesh(WRITTEN["off"], "off", reader=reader).faces, BALL.faces)
        assert reader._idle == [process]


def test_threads_share_a_reader():
    types = ["obj", "off", "stl", "ply"] * 4
    with MeshReader() as reader, ThreadPoolExecutor(3) as pool:
        meshes = list(pool.map(lambda file_type: parse_mesh(WRITTEN[file_type], file_type, reader=reader), types))
        assert len(reader._idle) == 1
    assert [len(mesh.faces) for mesh in meshes] == [len(BALL.faces)] * len(types)
    assert reader._idle == []


def test_the_child_sees_none_of_our_environment(monkeypatch):
    monkeypatch.setenv("PYTHONWARNINGS", "this would be complained about")
    monkeypatch.setenv("PYTHONSTARTUP", "/nowhere")
    monkeypatch.setenv("SHAPEWRIGHT_DATABASE_URL", "postgresql://user:secret@host/db")
    assert len(parse_mesh(WRITTEN["stl"], "stl").faces) == len(BALL.faces)


def test_trusted_files(tmp_path):
    path = tmp_path / "ball.off"
    path.write_bytes(WRITTEN["off"])
    np.testing.assert_array_equal(load_mesh(path).vertices, BALL.vertices)
    np.testing.assert_array_equal(load_mesh(str(path)).faces, BALL.faces)
    with pytest.raises(MeshFileError, match="limit of 10 bytes"):
        load_mesh(path, limits=replace(DEFAULT_LIMITS, size_bytes=10))


def test_a_file_that_is_not_trusted_is_read_in_a_child(tmp_path):
    path = tmp_path / "ball.off"
    path.write_bytes(WRITTEN["off"])
    np.testing.assert_array_equal(load_mesh(path, in_child=True).vertices, BALL.vertices)
    with pytest.raises(MeshFileError, match=r"more than 0\.01 s") as caught:
        load_mesh(path, in_child=True, limits=replace(DEFAULT_LIMITS, wall_s=0.01))
    assert "ball.off" in str(caught.value.where)


@pytest.mark.parametrize("name", ["missing.obj", "folder.obj", "nul\0.obj", "ball", "ball.txt"])
def test_paths_that_cannot_be_read(tmp_path, name):
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(MeshFileError):
        load_mesh(os.path.join(tmp_path, name))  # noqa: PTH118 - pathlib is not asked about the NUL


def test_readable_types_are_the_documented_ones():
    assert set(MESH_TYPES) == {"obj", "off", "ply", "stl", "glb", "gltf"}
    assert set(POINT_TYPES) == {"asc", "csv", "las", "laz", "pcd", "pts", "txt", "xyz"}


@pytest.mark.real_data
def test_real_meshes_load_and_mostly_are_soup(real_data):
    names = sorted((real_data / "meshes").glob("*/*"))[::40]
    meshes = [load_mesh(name) for name in names]
    assert len(meshes) > 15
    assert sum(mesh.is_watertight for mesh in meshes) < len(meshes) / 2
