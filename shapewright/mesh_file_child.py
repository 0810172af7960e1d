"""The child process of :func:`shapewright.mesh_file.parse_mesh`: ``python -m shapewright.mesh_file_child``.

It limits itself before it looks at the content, and from then on can open no file and no connection, as no
further descriptor is allowed. In: one line of JSON, then the file. Out: one line of JSON, then the arrays.
"""

import importlib
import json
import resource
import sys


def main() -> None:
    """Read one request from stdin, write one answer to stdout."""
    request = json.loads(sys.stdin.buffer.readline())
    file_type, limits = request["file_type"], request["limits"]
    _limit(resource.RLIMIT_AS, limits["memory_bytes"])
    _limit(resource.RLIMIT_CPU, limits["cpu_s"], spare=1)  # a second between the signal and the kill
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_FSIZE, 0)
    try:
        answer, body = _parse(file_type, limits)
    except MemoryError:
        answer = {
            "error": f"reading needs more than {limits['memory_bytes']} bytes of memory",
            "where": "reader process",
        }
        body = []
    out = sys.stdout.buffer
    out.write(json.dumps(answer).encode() + b"\n")
    for part in body:
        out.write(part)
    out.flush()


def _parse(file_type: str, limits: dict[str, float]) -> tuple[dict[str, object], list[bytes]]:
    from shapewright import mesh_decode
    from shapewright.errors import MeshFileError

    if file_type in ("ply", "glb", "gltf"):
        _load_trimesh()
    _limit(resource.RLIMIT_NOFILE, 3)  # imports are over: stdin, stdout and stderr are all that stays open
    try:
        mesh = mesh_decode.decode_mesh(sys.stdin.buffer.read(), file_type, mesh_decode.ReadLimits(**limits))  # type: ignore[arg-type]
    except MeshFileError as error:
        return {"error": error.message, "where": error.where}, []
    counts: dict[str, object] = {"vertices": len(mesh.vertices), "faces": len(mesh.faces)}
    return counts, [mesh.vertices.tobytes(), mesh.faces.tobytes()]


def _load_trimesh() -> None:
    """Import trimesh and what it imports only while reading, before opening files is forbidden."""
    importlib.import_module("trimesh")
    for name in ("trimesh.exchange.gltf", "trimesh.exchange.ply", "trimesh.visual.material", "PIL.Image"):
        importlib.import_module(name)


def _limit(kind: int, value: float, spare: int = 0) -> None:
    _, most = resource.getrlimit(kind)
    hard = int(value) + spare
    if most != resource.RLIM_INFINITY:
        hard = min(hard, most)
    resource.setrlimit(kind, (min(int(value), hard), hard))


if __name__ == "__main__":
    main()
