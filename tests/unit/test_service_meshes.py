"""Meshes over HTTP: what is taken, what is refused, and that a refusal leaves nothing."""

import resource
import struct
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from service_support import GLB, LiveService, problem, running, service, shared_service, tetrahedron

from models_store.catalog import mesh_id
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.mesh.file import parse_mesh, parse_query

__all__ = ["service", "shared_service"]

MAX_BYTES = 300_000
SHAPE = TriangleMesh(
    np.array([[1.0, 2.0, 3.0], [4.0, 2.0, 3.0], [1.0, 7.0, 3.0], [1.0, 2.0, 9.0]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
)


@pytest.mark.parametrize("file_type", ["obj", "off", "ply", "stl", "glb"])
def test_every_type_of_file_is_taken(service: LiveService, file_type: str) -> None:
    data = SHAPE.to_bytes(file_type)  # type: ignore[arg-type]
    response = service.upload(data, f"../My Shape.{file_type.upper()}")
    assert response.status_code == 201, response.text
    mesh = response.json()
    assert response.headers["location"] == f"/v1/meshes/{mesh['id']}"
    assert mesh["id"] == mesh_id(data)
    assert mesh["file_name"] == f"My Shape.{file_type.upper()}"
    assert (mesh["file_type"], mesh["file_size"]) == (file_type, len(data))
    assert (mesh["vertex_count"], mesh["face_count"], mesh["watertight"]) == (4, 4, True)
    assert mesh["bounds"] == [[1, 2, 3], [4, 7, 9]]
    assert service.client.get(f"/v1/meshes/{mesh['id']}").json() == mesh
    assert service.client.get("/v1/meshes").json()["items"] == [mesh]

    content = service.client.get(mesh["content_url"])
    assert content.headers["content-type"] == GLB
    assert parse_mesh(content.content, "glb").bounds.tolist() == mesh["bounds"]
    etag = content.headers["etag"]
    assert service.client.get(mesh["content_url"], headers={"If-None-Match": etag}).status_code == 304


SCAN = b"5\n500000 4500000.25 1\n500001 4500000 1\n500000 4500003 1\n500000 4500000 7\n500000 4500000.5 1\n"


def test_a_file_without_faces_is_a_point_cloud(service: LiveService) -> None:
    response = service.upload(SCAN, "scan.PTS")
    assert response.status_code == 201, response.text
    cloud = response.json()
    assert (cloud["kind"], cloud["file_type"], cloud["watertight"]) == ("point_cloud", "pts", False)
    assert (cloud["vertex_count"], cloud["face_count"]) == (5, 0)
    assert cloud["bounds"] == [[500000, 4500000, 1], [500001, 4500003, 7]]
    assert service.client.get("/v1/meshes").json()["items"] == [cloud]
    shown = parse_query(service.client.get(cloud["content_url"]).content, "glb")
    assert isinstance(shown, PointCloud)
    np.testing.assert_allclose(shown.points, np.loadtxt(SCAN.splitlines()[1:]), atol=1e-6)


def test_a_point_cloud_is_not_estimated(service: LiveService) -> None:
    cloud = service.upload(SCAN, "scan.txt").json()["id"]
    mesh = service.upload(tetrahedron(), "mesh.off").json()["id"]
    model = service.add_model("box")["id"]
    told = problem(service.client.post("/v1/estimations", json={"mesh_id": cloud, "model_id": model}), 422, "mesh_id")
    assert "point cloud" in told["detail"]
    many = {"mesh_ids": [mesh, cloud], "model_id": model}
    problem(service.client.post("/v1/collection-estimations", json=many), 422, "mesh_ids[1]")
    for asked in ("estimations", "collection-estimations"):
        assert service.client.get(f"/v1/{asked}").json()["items"] == []


def test_the_same_bytes_are_the_same_mesh(service: LiveService) -> None:
    first = service.upload(tetrahedron(), "one.off")
    kept = service.artifacts()
    second = service.upload(tetrahedron(), "two.off")
    assert (first.status_code, second.status_code) == (201, 200)
    assert first.json() == second.json()
    assert service.artifacts() == kept
    assert len(service.client.get("/v1/meshes").json()["items"]) == 1


@pytest.fixture(scope="module")
def strict_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveService]:
    with running(tmp_path_factory.mktemp("strict") / "data", max_mesh_bytes=MAX_BYTES) as live:
        yield live


ONE_TRIANGLE = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
WITH_NAN = tetrahedron().replace(b"0 1.0 0", b"0 nan 0")
STATED = struct.pack("<80sI", b"", 100) + b"\0" * 100
LINK = (
    b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "../secret.bin", "byteLength": 36}], '
    b'"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}'
)


@pytest.mark.parametrize(
    ("data", "file_name", "status", "words"),
    [
        (b"", "empty.off", 422, "empty"),
        (tetrahedron()[:40], "truncated.off", 422, ""),
        (STATED, "truncated.stl", 422, "truncated"),
        (SHAPE.to_bytes("glb")[:-10], "truncated.glb", 422, "truncated"),
        (WITH_NAN, "nan.off", 422, "NaN"),
        (ONE_TRIANGLE, "one.off", 422, "fewer than 4 faces"),
        (b"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no_faces.off", 422, ""),
        (b"OFF\n4 4 0\n" + b"1 1 1\n" * 4 + b"3 0 1 2\n" * 4, "point.off", 422, "area"),
        (tetrahedron(), "wrong.stl", 422, "the content is OFF"),
        (b"PK\x03\x04....", "zipped.obj", 422, "ZIP"),
        (b"1 2 3\n4 5\n", "short.xyz", 422, "at least 3 numbers"),
        (b"VERSION .7\nFIELDS x y z\n", "cut.pcd", 422, "the header has no"),
        (b"ASTM-E57" + bytes(50), "scan.e57", 415, ".pcd"),
        (LINK, "link.gltf", 422, "links to another file"),
        (tetrahedron(), "mesh.exe", 415, ".off"),
        (tetrahedron(), "mesh", 415, ".off"),
        (b" " * (MAX_BYTES + 1), "large.off", 413, str(MAX_BYTES)),
        (b" " * (MAX_BYTES + 100_000), "larger.off", 413, ""),
        (b" " * 20_000_000, "huge.off", 413, ""),
    ],
)
def test_a_file_that_is_wrong_leaves_nothing(
    strict_service: LiveService, data: bytes, file_name: str, status: int, words: str
) -> None:
    document = problem(strict_service.upload(data, file_name), status)
    assert words in document["detail"]
    assert document["where"]
    strict_service.assert_nothing_left()


def test_an_obj_that_names_other_files_is_read_without_them(service: LiveService) -> None:
    data = b"mtllib /etc/passwd\n" + SHAPE.to_bytes("obj").replace(b"f ", b"usemtl x\nf ", 1)
    assert service.upload(data, "links.obj").json()["face_count"] == 4


def test_a_body_without_a_stated_length_is_limited_too(strict_service: LiveService) -> None:
    def chunks() -> Iterator[bytes]:
        yield b'--x\r\nContent-Disposition: form-data; name="file"; filename="a.off"\r\n\r\n'
        for _ in range(50):
            yield b" " * 10_000
        yield b"\r\n--x--\r\n"

    headers = {"Content-Type": "multipart/form-data; boundary=x"}
    problem(strict_service.client.post("/v1/meshes", content=chunks(), headers=headers), 413)
    strict_service.assert_nothing_left()


def test_a_form_without_the_file_says_what_is_missing(strict_service: LiveService) -> None:
    client = strict_service.client
    problem(client.post("/v1/meshes"), 422, "file")
    problem(client.post("/v1/meshes", files={"mesh": ("a.off", tetrahedron())}), 422, "file")
    problem(client.post("/v1/meshes", data={"file": "text"}), 422, "file")
    problem(client.post("/v1/meshes", json={"file": "text"}), 422, "file")
    broken = {"Content-Type": "multipart/form-data"}
    problem(client.post("/v1/meshes", content=b"nothing", headers=broken), 422, "body")
    strict_service.assert_nothing_left()


def test_unknown_meshes_are_not_found(shared_service: LiveService) -> None:
    problem(shared_service.client.get("/v1/meshes/nope"), 404)
    problem(shared_service.client.get(f"/v1/meshes/{'0' * 64}/content"), 404)


@contextmanager
def full_disk(free_bytes: int) -> Iterator[None]:
    """No file of this process may grow over a size: the system refuses, as it does when a disk is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (free_bytes, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize(
    ("size", "free"),
    [
        pytest.param(900_000, 600_000, id="of the artefacts"),
        pytest.param(2_500_000, 1_500_000, id="of temporary files"),
    ],
)
def test_a_full_disk_is_said_and_leaves_nothing(service: LiveService, size: int, free: int) -> None:
    data = tetrahedron() + b"#" * size
    with full_disk(free):
        problem(service.upload(data), 507)
    service.assert_nothing_left()
    assert service.upload(data).status_code == 201
