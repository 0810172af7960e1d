"""Reading point clouds: every type gives the points that were written, and what is wrong is refused with its place."""

import contextlib
import io
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest
import trimesh
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shapewright.errors import MeshFileError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.decode import decode_query
from shapewright.mesh.file import (
    DEFAULT_LIMITS,
    MeshReader,
    load_meshes,
    load_queries,
    load_query,
    parse_mesh,
    parse_query,
)
from shapewright.mesh.lzf import decompress_lzf
from shapewright.mesh.sniff import check_content, normalized_type

CLOUD = np.random.default_rng(5).normal(size=(60, 3)).astype(np.float32).astype(np.float64)
COORDINATES = st.floats(-1e6, 1e6, width=32)
CLOUDS = arrays(np.float64, st.tuples(st.integers(4, 40), st.just(3)), elements=COORDINATES, unique=True)


def read(data: bytes, file_type: str) -> TriangleMesh | PointCloud:
    """The same checks as in the child, without a process for each."""
    file_type = normalized_type(file_type)
    check_content(data, file_type)
    return decode_query(data, file_type, DEFAULT_LIMITS)


def points_of(data: bytes, file_type: str) -> np.ndarray:
    query = read(data, file_type)
    assert isinstance(query, PointCloud)
    return query.points


def rows(points: np.ndarray, separator: str = " ", further: str = "") -> bytes:
    return "".join(separator.join(map(repr, row)) + further + "\n" for row in points.tolist()).encode()


def ply(points: np.ndarray, storage: str, faces: str = "") -> bytes:
    header = f"ply\nformat {storage} 1.0\nelement vertex {len(points)}\n" + "".join(
        f"property {kind} {name}\n"
        for kind, name in (("double", "x"), ("double", "y"), ("double", "z"), ("uchar", "red"))
    )
    header += faces + "end_header\n"
    if storage == "ascii":
        return header.encode() + rows(points, further=" 7")
    order = "<" if "little" in storage else ">"
    return header.encode() + b"".join(struct.pack(order + "3dB", *row, 7) for row in points.tolist())


def pcd(points: np.ndarray, storage: str, *, width: int | None = None, **changes: str) -> bytes:
    """A PCD file with a field before, between and after the positions."""
    entries = {
        "VERSION": "0.7",
        "FIELDS": "normal x y rgb z",
        "SIZE": "4 8 8 1 8",
        "TYPE": "F F F U F",
        "COUNT": "3 1 1 1 1",
        "WIDTH": str(len(points) if width is None else width),
        "HEIGHT": "1",
        "VIEWPOINT": "0 0 0 1 0 0 0",
        "POINTS": str(len(points) if width is None else width),
        "DATA": storage,
    } | changes
    header = "# .PCD v0.7 - Point Cloud Data file format\n"
    header += "".join(f"{name} {value}\n" for name, value in entries.items() if value)
    x, y, z = points.T
    if storage == "ascii":
        lines = [f"0.1 0.2 0.3 {a!r} {b!r} 9 {c!r}\n" for a, b, c in points.tolist()]
        return (header + "".join(lines)).encode()
    row = np.dtype([("n", "<f4", 3), ("x", "<f8"), ("y", "<f8"), ("rgb", "u1"), ("z", "<f8")])
    records = np.zeros(len(points), row)
    records["x"], records["y"], records["z"] = x, y, z
    if storage == "binary":
        return header.encode() + records.tobytes()
    plain = b"".join(records[name].tobytes() for name in row.names or ())
    packed = compress_lzf(plain)
    return header.encode() + struct.pack("<II", len(packed), len(plain)) + packed


def compress_lzf(data: bytes) -> bytes:
    """Compress greedily: repeat the last place where the next three bytes stood, or copy one byte."""
    output, literals, seen, place = bytearray(), bytearray(), {}, 0

    def flush() -> None:
        for start in range(0, len(literals), 32):
            piece = literals[start : start + 32]
            output.extend((len(piece) - 1, *piece))
        literals.clear()

    while place < len(data):
        key = data[place : place + 3]
        before = seen.get(key, -1) if len(key) == 3 else -1
        seen[key] = place
        if before < 0 or place - before > 8192:
            literals.append(data[place])
            place += 1
            continue
        length = 3
        while length < 264 and place + length < len(data) and data[before + length] == data[place + length]:
            length += 1
        flush()
        distance, code = place - before - 1, length - 2
        output.extend(((min(code, 7) << 5) | distance >> 8, *((code - 7,) if code >= 7 else ()), distance & 255))
        place += length
    flush()
    return bytes(output)


def las(points: np.ndarray, *, compressed: bool) -> bytes:
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.offsets, header.scales = points.min(axis=0), np.full(3, 1e-4)
    made = laspy.LasData(header)
    made.x, made.y, made.z = points.T
    content = io.BytesIO()
    made.write(content, do_compress=compressed, laz_backend=laspy.LazBackend.Lazrs)
    return content.getvalue()


@given(points=CLOUDS, storage=st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
@settings(max_examples=30, deadline=None)
def test_ply_without_faces_gives_its_points(points: np.ndarray, storage: str) -> None:
    np.testing.assert_array_equal(points_of(ply(points, storage), "ply"), points)
    none = "element face 0\nproperty list uchar int vertex_indices\n"
    np.testing.assert_array_equal(points_of(ply(points, storage, none), "ply"), points)


@given(
    points=CLOUDS,
    separator=st.sampled_from([" ", "\t", ",", ", ", ";", "  "]),
    further=st.sampled_from(["", " # seen twice", " // seen twice"]),
    file_type=st.sampled_from(["xyz", "txt", "pts", "asc", "csv"]),
)
@settings(max_examples=40, deadline=None)
def test_rows_give_their_points(points: np.ndarray, separator: str, further: str, file_type: str) -> None:
    np.testing.assert_array_equal(points_of(rows(points, separator, further), file_type), points)
    more = f"{separator}200{separator}0.5" + further
    head = f"# made by a scanner\r\n\r\n{len(points)}\r\n".encode()
    np.testing.assert_array_equal(points_of(head + rows(points, separator, more), file_type), points)


@given(points=CLOUDS, storage=st.sampled_from(["ascii", "binary", "binary_compressed"]))
@settings(max_examples=40, deadline=None)
def test_pcd_gives_its_points(points: np.ndarray, storage: str) -> None:
    np.testing.assert_array_equal(points_of(pcd(points, storage), "pcd"), points)


@given(data=st.one_of(st.binary(max_size=600), st.text("ab", max_size=2000).map(str.encode)))
@example(data=b"")
@example(data=b"a" * 3000)
def test_lzf_gives_back_what_was_compressed(data: bytes) -> None:
    packed = compress_lzf(data)
    assert decompress_lzf(packed, len(data)) == data
    for size in (len(data) + 1, len(data) - 1):
        with pytest.raises(ValueError, match="bytes that are stated"):
            decompress_lzf(packed, size)


@given(data=st.binary(max_size=60), size=st.integers(0, 200))
def test_lzf_of_any_bytes_is_read_or_refused(data: bytes, size: int) -> None:
    with contextlib.suppress(ValueError):
        assert len(decompress_lzf(data, size)) == size


@pytest.fixture(scope="module")
def reader() -> Iterator[MeshReader]:
    with MeshReader() as shared:
        yield shared


@pytest.mark.parametrize("compressed", [False, True])
def test_las_and_laz_give_their_points_in_a_child(reader: MeshReader, compressed: bool) -> None:
    far = CLOUD + np.array([500_000, 4_500_000, 300])
    data = las(far, compressed=compressed)
    query = parse_query(data, "laz" if compressed else "las", reader=reader)
    assert isinstance(query, PointCloud)
    np.testing.assert_allclose(query.points, far, atol=6e-5)
    for part in (0.3, 0.7, 0.99):
        with pytest.raises(MeshFileError):
            read(data[: int(part * len(data))], "las")


@pytest.mark.parametrize(
    ("file_type", "data"),
    [
        ("ply", ply(CLOUD, "binary_little_endian")),
        ("obj", "".join(f"v {a!r} {b!r} {c!r}\n" for a, b, c in CLOUD.tolist()).encode()),
        ("off", f"OFF\n{len(CLOUD)} 0 0\n".encode() + rows(CLOUD)),
        ("glb", trimesh.Scene([trimesh.PointCloud(CLOUD)]).export(file_type="glb")),
        ("xyz", rows(CLOUD)),
        ("pcd", pcd(CLOUD, "binary_compressed")),
    ],
)
def test_clouds_of_strangers_are_read_in_a_child_and_are_no_meshes(
    reader: MeshReader, file_type: str, data: bytes
) -> None:
    query = parse_query(data, file_type.upper(), reader=reader)
    assert isinstance(query, PointCloud)
    np.testing.assert_array_equal(query.points, CLOUD)
    with pytest.raises(MeshFileError, match=r"no faces: it is a cloud of 60 points.*retrieval take point") as caught:
        parse_mesh(data, file_type, reader=reader)
    assert caught.value.where == "faces"


def test_named_columns_are_found() -> None:
    table = np.column_stack([np.arange(60), CLOUD[:, 2], CLOUD[:, 0], CLOUD[:, 1]])
    header = b'id;"Z";"X";"Y"\n'
    np.testing.assert_array_equal(points_of(header + rows(table, ";"), "csv"), CLOUD)
    np.testing.assert_array_equal(points_of(b"easting northing height\n" + rows(CLOUD), "txt"), CLOUD)


def test_several_scans_in_one_file_are_one_cloud() -> None:
    data = b"20\n" + rows(CLOUD[:20]) + b"40\n" + rows(CLOUD[20:], further=" -1200 3 3 3")
    np.testing.assert_array_equal(points_of(data, "pts"), CLOUD)


def test_places_that_were_not_measured_and_repeated_points_are_dropped() -> None:
    given_twice = np.concatenate([CLOUD, np.full((5, 3), np.nan), CLOUD[:9]])
    for data, file_type in ((rows(given_twice), "xyz"), (pcd(given_twice, "binary"), "pcd")):
        np.testing.assert_array_equal(points_of(data, file_type), CLOUD)


BAD = {
    "infinite": (rows(CLOUD) + b"1 inf 0\n", "xyz", r"points\[60\].*infinite"),
    "absurd size": (rows(CLOUD) + b"1 1e40 0\n", "xyz", r"points\[60\].*beyond"),
    "three points": (rows(CLOUD[:3]), "xyz", "3 different points are fewer than 4"),
    "one place": (b"1 2 3\n" * 50, "xyz", "1 different points are fewer"),
    "nothing measured": (b"nan nan nan\n" * 50, "xyz", "0 different points"),
    "two columns": (b"1 2 3\n1 2\n", "xyz", "line 2.*at least 3 numbers, got 2"),
    "words": (b"1 2 3\n1 2 three\n", "xyz", "line 2.*not a number"),
    "two headers": (b"x y z\n1 b 3\n1 2 3\n", "xyz", "line 2.*not a number"),
    "decimal commas": (b"1 2 3\n1,5 2,5 3,5\n", "xyz", "line 2.*decimal points"),
    "too few rows": (b"61\n" + rows(CLOUD), "pts", "61 points stated, 60 there"),
    "too many rows": (b"59\n" + rows(CLOUD), "pts", "59 points stated, 60 there"),
    "a mesh called xyz": (b"OFF\n1 0 0\n0 0 0\n", "xyz", "says XYZ.*OFF"),
    "rows called obj": (rows(CLOUD), "obj", "says OBJ.*XYZ"),
    "rows called pcd": (rows(CLOUD), "pcd", "says PCD.*XYZ"),
    "prose": (b"dear reader,\nvoila, this is it\n", "txt", "not TXT"),
    "a picture": (b"\x89PNG\r\n\x1a\n1 2 3", "csv", "PNG"),
    "e57": (b"ASTM-E57" + bytes(100), "e57", "E57.*LAS, PCD or PLY"),
    "e57 called las": (b"ASTM-E57" + bytes(100), "las", "E57"),
    "las of nothing": (b"LASF" + bytes(100), "las", "damaged"),
    "pcd without fields": (pcd(CLOUD, "ascii", FIELDS=""), "pcd", "no FIELDS"),
    "pcd cut in the header": (pcd(CLOUD, "ascii")[:120], "pcd", "no DATA"),
    "pcd of absurd counts": (pcd(CLOUD, "binary", width=10**11), "pcd", "POINTS.*more than the limit"),
    "pcd of other products": (pcd(CLOUD, "binary", HEIGHT="2"), "pcd", "POINTS.*width times height is 120"),
    "pcd with too many": (pcd(CLOUD, "binary", width=61), "pcd", "DATA.*truncated"),
    "pcd text with too many": (pcd(CLOUD, "ascii", width=61), "pcd", "61 points stated, 60 there"),
    "pcd text with too few": (pcd(CLOUD, "ascii", width=59), "pcd", "59 points stated, 60 there"),
    "pcd compressed otherwise": (pcd(CLOUD, "binary_compressed", width=61), "pcd", "DATA.*are stated"),
    "pcd of wide points": (pcd(CLOUD, "binary", COUNT="3 1 1 999999 1"), "pcd", "COUNT"),
    "pcd of strange types": (pcd(CLOUD, "binary", TYPE="F F F U X"), "pcd", "TYPE"),
    "pcd of strange sizes": (pcd(CLOUD, "binary", SIZE="4 8 8 1 16"), "pcd", "TYPE"),
    "pcd of negative sizes": (pcd(CLOUD, "binary", SIZE="4 8 8 -1 8"), "pcd", "SIZE"),
    "pcd of strange storage": (pcd(CLOUD, "ascii", DATA="zipped"), "pcd", "DATA.*binary_compressed"),
    "pcd in the plane": (pcd(CLOUD, "ascii", FIELDS="normal x y rgb w"), "pcd", "FIELDS.*x, y and z"),
    "pcd with prose": (b"VERSION .7\nhello\n", "pcd", "line 2.*HELLO"),
    "ply of absurd counts": (ply(CLOUD, "binary_little_endian").replace(b"x 60", b"x 99999999999"), "ply", "length"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused_with_the_place(name: str) -> None:
    data, file_type, message = BAD[name]
    with pytest.raises(MeshFileError, match=message) as caught:
        read(data, file_type)
    assert caught.value.where
    assert len(str(caught.value)) < 300


WRITTEN = {
    "ply": ply(CLOUD, "binary_little_endian"),
    "pts": b"60\n" + rows(CLOUD),
    "pcd": pcd(CLOUD, "binary"),
    "PCD": pcd(CLOUD, "binary_compressed"),
    "las": las(CLOUD, compressed=False),
    "laz": las(CLOUD, compressed=True),
}


@pytest.mark.parametrize("file_type", WRITTEN)
@pytest.mark.parametrize("part", [0.02, 0.4, 0.8, 0.97])
def test_truncated_files_are_refused(file_type: str, part: float) -> None:
    data = WRITTEN[file_type]
    with pytest.raises(MeshFileError):
        read(data[: int(part * len(data))], file_type.lower())


@settings(max_examples=150, deadline=None)
@given(
    file_type=st.sampled_from(sorted(WRITTEN)),
    cuts=st.lists(st.tuples(st.integers(0, 2500), st.binary(max_size=6)), min_size=1, max_size=4),
)
def test_damage_of_any_sort_reads_or_is_refused_but_never_breaks(file_type: str, cuts: list[tuple[int, bytes]]) -> None:
    data = bytearray(WRITTEN[file_type])
    for place, bytes_ in cuts:
        data[place : place + len(bytes_)] = bytes_
    with contextlib.suppress(MeshFileError):
        assert np.isfinite(points_of(bytes(data), file_type.lower())).all()


@pytest.mark.parametrize(
    ("file_type", "place", "bytes_", "message"),
    [
        ("las", 100, b"\xff" * 4, "4294967295 records stated"),
        ("laz", 100, b"\xff" * 4, "4294967295 records stated"),
        ("laz", 313, bytes(2), "at least one LazItem"),
    ],
)
def test_a_header_that_asks_for_too_much_or_nothing_is_refused(
    file_type: str, place: int, bytes_: bytes, message: str
) -> None:
    data = bytearray(WRITTEN[file_type])
    data[place : place + len(bytes_)] = bytes_
    with pytest.raises(MeshFileError, match=message):
        points_of(bytes(data), file_type)


def test_a_table_of_more_chunks_than_points_is_refused() -> None:
    data = bytearray(WRITTEN["laz"])
    start = int.from_bytes(data[96:100], "little")
    table = int.from_bytes(data[start : start + 8], "little")
    data[table + 4 : table + 8] = (2**31).to_bytes(4, "little")
    with pytest.raises(MeshFileError, match="2147483648 chunks stated for 60 points"):
        points_of(bytes(data), "laz")


@pytest.mark.parametrize("file_type", ["ply", "pts", "pcd", "laz"])
def test_the_limits_of_meshes_hold_for_points(file_type: str) -> None:
    with pytest.raises(MeshFileError, match="60 points are more than the limit of 59"):
        decode_query(WRITTEN[file_type], file_type, replace(DEFAULT_LIMITS, vertices=59))
    with pytest.raises(MeshFileError, match="limit of 100 bytes"):
        parse_query(WRITTEN[file_type], file_type, limits=replace(DEFAULT_LIMITS, size_bytes=100))


def test_a_bomb_of_repetitions_stops_at_the_stated_size() -> None:
    bomb = b"\x00a" + b"\xe0\xff\x00" * 100_000
    body = struct.pack("<II", len(bomb), 60 * 37) + bomb
    header = pcd(CLOUD, "binary_compressed").partition(b"binary_compressed\n")[0]
    with pytest.raises(MeshFileError, match=r"DATA.*not of the 2220 bytes"):
        read(header + b"binary_compressed\n" + body, "pcd")


def test_many_files_are_read_in_their_order(tmp_path: Path) -> None:
    ball = TriangleMesh.from_trimesh(trimesh.creation.icosphere(1))
    ball.save(tmp_path / "ball.off")
    (tmp_path / "scan.xyz").write_bytes(rows(CLOUD))
    (tmp_path / "bad.pcd").write_bytes(b"VERSION .7\nhello\n")
    paths = [tmp_path / name for name in ("ball.off", "scan.xyz", "bad.pcd")]
    kinds = [type(one) for one in load_queries(paths, jobs=2)]
    assert kinds == [TriangleMesh, PointCloud, MeshFileError]
    mesh, refused, bad = load_meshes(paths)
    assert isinstance(mesh, TriangleMesh)
    assert isinstance(bad, MeshFileError)
    assert isinstance(refused, MeshFileError)
    assert "scan.xyz" in str(refused.where)
    assert "cloud of 60 points" in refused.message
    query = load_query(paths[1])
    assert isinstance(query, PointCloud)
    np.testing.assert_array_equal(query.points, CLOUD)
