"""Artefacts are there as a whole or not at all, in every kind of store."""

import http.server
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from models_store.artifacts import ArtifactStore
from models_store.errors import ArtifactError, ArtifactNotFoundError


class TinyS3(http.server.BaseHTTPRequestHandler):
    """As much of S3 as one object at a time needs, kept in a dictionary; a key with ``full`` finds no room."""

    protocol_version = "HTTP/1.1"
    objects: dict[str, bytes]

    def answer(self, status: int, body: bytes = b"", length: int | None = None) -> None:
        self.send_response(status)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        self.send_header("ETag", '"1"')
        self.send_header("Last-Modified", "Tue, 01 Jan 2030 00:00:00 GMT")
        self.end_headers()
        self.wfile.write(body)

    def do_PUT(self) -> None:
        data = self.rfile.read(int(self.headers["Content-Length"]))
        if "full" in self.path:
            self.answer(400, b"<Error><Code>QuotaExceeded</Code></Error>")
            return
        self.objects[urlsplit(self.path).path] = data
        self.answer(200)

    def do_GET(self) -> None:
        data = self.objects.get(urlsplit(self.path).path)
        self.answer(404) if data is None else self.answer(200, data)

    def do_HEAD(self) -> None:
        data = self.objects.get(urlsplit(self.path).path)
        self.answer(404) if data is None else self.answer(200, length=len(data))

    def do_POST(self) -> None:  # a deletion of several objects
        request = self.rfile.read(int(self.headers["Content-Length"])).decode()
        keys = re.findall("<Key>(.*?)</Key>", request)
        for key in keys:
            self.objects.pop(f"{urlsplit(self.path).path}/{key}", None)
        deleted = "".join(f"<Deleted><Key>{key}</Key></Deleted>" for key in keys)
        self.answer(200, f"<DeleteResult>{deleted}</DeleteResult>".encode())

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def tiny_s3(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    handler = type("Handler", (TinyS3,), {"objects": {}})
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        server.daemon_threads = True
        threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True).start()
        for name, value in {
            "ENDPOINT_URL": f"http://127.0.0.1:{server.server_port}",
            "ALLOW_HTTP": "true",
            "ACCESS_KEY_ID": "key",
            "SECRET_ACCESS_KEY": "secret",
            "REGION": "here",
        }.items():
            monkeypatch.setenv(f"AWS_{name}", value)
        yield "s3://bucket/prefix"
        server.shutdown()


@pytest.fixture(params=["folder", "memory", "s3"])
def store(request: pytest.FixtureRequest, tmp_path: Path) -> ArtifactStore:
    if request.param == "s3":
        return ArtifactStore.open(request.getfixturevalue("tiny_s3"))
    return ArtifactStore.open("memory://" if request.param == "memory" else (tmp_path / "a b").as_uri())


def test_what_is_put_is_there_until_it_is_deleted(store: ArtifactStore, tmp_path: Path) -> None:
    key = "meshes/00ff/source.off"
    assert not store.exists(key)
    with pytest.raises(ArtifactNotFoundError):
        store.get(key)
    with pytest.raises(ArtifactNotFoundError):
        store.local_copy(key, tmp_path / "cache")
    store.put(key, b"first")
    store.put(key, b"second")
    assert store.get(key) == b"second"
    assert store.exists(key)
    assert store.local_copy(key, tmp_path / "cache").read_bytes() == b"second"
    assert store.local_copy(key, tmp_path / "cache").read_bytes() == b"second"
    store.delete(key)
    store.delete(key)
    assert not store.exists(key)
    store.check()


def test_empty_and_large_artifacts(store: ArtifactStore) -> None:
    for data in (b"", bytes(range(256)) * 40_000):
        store.put("a/b.bin", data)
        assert store.get("a/b.bin") == data


@pytest.mark.parametrize("key", ["", "/a", "a/", "../a", "a/../b", "a//b", "a b", "a\\b", ".hidden", "a/\0", "ü"])
def test_keys_that_could_lead_elsewhere_are_refused(tmp_path: Path, key: str) -> None:
    store = ArtifactStore.open(str(tmp_path))
    for refused in (lambda: store.put(key, b""), lambda: store.get(key), lambda: store.delete(key)):
        with pytest.raises(ArtifactError):
            refused()


def test_a_full_s3_store_is_an_artifact_error(tiny_s3: str) -> None:
    store = ArtifactStore.open(tiny_s3)
    with pytest.raises(ArtifactError, match="no space left"):
        store.put("full/a.bin", b"data")
    assert not store.exists("full/a.bin")


def test_a_full_disk_leaves_nothing_behind_and_the_old_artifact_alone(tmp_path: Path) -> None:
    """The limit on the size of files is what a full disk looks like to the writer: it stops half way."""
    program = """
import resource, sys
from pathlib import Path
from models_store.artifacts import ArtifactStore
from models_store.errors import ArtifactError
store = ArtifactStore.open(sys.argv[1])
store.put("old/a.bin", b"old")
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
for key in ("new/b.bin", "old/a.bin"):
    try:
        store.put(key, bytes(1_000_000))
    except ArtifactError as error:
        assert "no space left" in str(error), error
    else:
        raise SystemExit("it was written?")
files = [p for p in Path(sys.argv[1]).rglob("*") if p.is_file()]
assert [p.name for p in files] == ["a.bin"], files
assert store.get("old/a.bin") == b"old"
"""
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "store")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_a_store_that_cannot_be_opened(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for url in (str(tmp_path / "file" / "folder"), "nothing://here"):
        with pytest.raises(ArtifactError):
            ArtifactStore.open(url)


def test_a_folder_that_went_away_is_noticed(tmp_path: Path) -> None:
    store = ArtifactStore.open(str(tmp_path / "store"))
    store.check()
    (tmp_path / "store").rmdir()
    with pytest.raises(ArtifactError):
        store.check()
