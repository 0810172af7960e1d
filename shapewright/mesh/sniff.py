"""What a file really is: its content is held against the type its name claims, before anything parses it."""

import json
import re
import struct

from shapewright.errors import MeshFileError
from shapewright.mesh.rows import is_rows

MESH_TYPES = ("glb", "gltf", "obj", "off", "ply", "stl")
"""The file types that a mesh can be read from; where a file has no faces, its vertices are a point cloud."""
_TEXT_TYPES = ("asc", "csv", "pts", "txt", "xyz")
_LAS_TYPES = ("las", "laz")
POINT_TYPES = tuple(sorted((*_TEXT_TYPES, *_LAS_TYPES, "pcd")))
"""The file types that hold nothing but a point cloud."""
QUERY_TYPES = tuple(sorted((*MESH_TYPES, *POINT_TYPES)))
"""The file types that can be read."""
_FAMILIES = {**dict.fromkeys(_TEXT_TYPES, "xyz"), **dict.fromkeys(_LAS_TYPES, "las")}
COMMON_TYPES = ("asc", "csv", "txt")
"""Those of them whose ending says little: many a file of another kind is named so."""

_FOREIGN = (
    (b"\x89PNG\r\n\x1a\n", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"%PDF", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive (archives are not unpacked)"),
    (b"\x1f\x8b", "a gzip archive (archives are not unpacked)"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
    (b"#!", "a script"),
)
_OBJ_VERTEX = re.compile(rb"^[ \t]*v[ \t]+[-+.\dnN]", re.MULTILINE)
_OFF_HEADER = re.compile(rb"(?:\s|#[^\n]*\n)*C?OFF\b(?! *BINARY)")
_PCD_HEADER = re.compile(rb"(?:\s|#[^\n]*\n)*VERSION[ \t]+\.?\d|(?:\s|#[^\n]*\n)*(?:FIELDS|COLUMNS)[ \t]")
_HEAD_BYTES = 1 << 16
_E57 = "an E57 scan, which is not read; export it as LAS, PCD or PLY"


def normalized_type(file_type: str) -> str:
    """Turn ``".OBJ"`` into ``"obj"``.

    Raises:
        MeshFileError: not one of :data:`QUERY_TYPES`.
    """
    wanted = file_type.strip().lower().removeprefix(".")
    if wanted == "e57":
        raise MeshFileError(f"this is {_E57}", where="file type")
    if wanted not in QUERY_TYPES:
        raise MeshFileError(
            f"{file_type[:20]!r} is no mesh type we read; known: {', '.join(QUERY_TYPES)}",
            where="file type",
        )
    return wanted


def detected_type(data: bytes) -> str | None:
    """Guess the type from the first bytes: a readable type, a description of something else, or ``None``.

    Text with a point on each line is ``xyz``, LAS and LAZ are ``las``.
    """
    for magic, description in _FOREIGN:
        if data.startswith(magic):
            return description
    head = data[:_HEAD_BYTES]
    if head.startswith(b"glTF"):
        return "glb"
    if re.match(rb"ply\s", head):
        return "ply"
    if head.startswith(b"LASF"):
        return "las"
    if head.startswith(b"ASTM-E57"):
        return _E57
    if _PCD_HEADER.match(head):
        return "pcd"
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return "stl"
    if re.match(rb"\s*solid\b", head, re.IGNORECASE) and b"facet" in head.lower():
        return "stl"
    if _OFF_HEADER.match(head):
        return "off"
    if b"\0" in head:
        return None
    start = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    if start.startswith(b"{"):
        return "gltf" if b'"asset"' in data else "a JSON document"
    if start.startswith(b"<"):
        return "an XML or HTML document"
    if _OBJ_VERTEX.search(data):
        return "obj"
    return "xyz" if is_rows(head) else None


def check_content(data: bytes, file_type: str) -> None:
    """Refuse content that is empty or is not of the (normalised) type it claims.

    Also checked here, as it needs no parser: the length a GLB or binary STL states, the number of lines of an
    ASCII PLY, and that a glTF brings its own buffers and pictures.

    Raises:
        MeshFileError: with ``where`` telling the place.
    """
    if not data.strip():
        raise MeshFileError("the file is empty", where="byte 0")
    found = detected_type(data)
    if found is None and file_type == "stl" and len(data) >= 84 and b"\0" in data[:_HEAD_BYTES]:
        count = struct.unpack_from("<I", data, 80)[0]
        raise MeshFileError(
            f"truncated or no STL: {count} triangles take {84 + 50 * count} bytes, there are {len(data)}",
            where="byte 80",
        )
    if found is None:
        raise MeshFileError(f"the content is not {file_type.upper()}", where="byte 0")
    if found != _FAMILIES.get(file_type, file_type):
        what = found.upper() if found in QUERY_TYPES else found
        raise MeshFileError(f"the type says {file_type.upper()}, but the content is {what}", where="byte 0")
    if file_type == "glb":
        _check_gltf_document(_glb_document(data))
    elif file_type == "gltf":
        _check_gltf_document(data)
    elif file_type == "ply":
        _check_ply_lines(data)


def _check_ply_lines(data: bytes) -> None:
    header, end, body = data.partition(b"end_header")
    if not end:
        raise MeshFileError("truncated: the header has no end", where="PLY header")
    if not re.search(rb"^format\s+ascii", header, re.MULTILINE):
        return
    stated = sum(int(count[:12]) for count in re.findall(rb"^element\s+\S+\s+(\d+)", header, re.MULTILINE))
    there = sum(1 for line in body.splitlines() if line.strip())
    if there < stated:
        raise MeshFileError(f"truncated: {stated} lines of elements stated, {there} there", where="PLY content")


def _glb_document(data: bytes) -> bytes:
    if len(data) < 20:
        raise MeshFileError("truncated: the header is incomplete", where=f"byte {len(data)}")
    version, length, json_length = struct.unpack_from("<III", data, 4)
    if version != 2:
        raise MeshFileError(f"version {version} is not supported, only 2", where="byte 4")
    if length != len(data):
        raise MeshFileError(f"truncated: {length} bytes stated, {len(data)} there", where="byte 8")
    if data[16:20] != b"JSON" or 20 + json_length > len(data):
        raise MeshFileError("the first chunk is no complete JSON chunk", where="byte 12")
    return data[20 : 20 + json_length]


def _check_gltf_document(text: bytes) -> None:
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MeshFileError(f"broken JSON: {error}", where="glTF document") from None
    if not isinstance(document, dict):
        raise MeshFileError("expected an object", where="glTF document")
    for kind in ("buffers", "images"):
        entries = document.get(kind, [])
        for index, entry in enumerate(entries if isinstance(entries, list) else []):
            uri = entry.get("uri") if isinstance(entry, dict) else None
            if uri is not None and not (isinstance(uri, str) and uri.startswith("data:")):
                raise MeshFileError(
                    "links to another file; only self-contained files are read", where=f"{kind}[{index}].uri"
                )
    required = document.get("extensionsRequired", [])
    for index, name in enumerate(required if isinstance(required, list) else []):
        if isinstance(name, str) and ("draco" in name.lower() or "meshopt" in name.lower()):
            raise MeshFileError(
                f"compressed geometry ({name[:60]}) is not supported", where=f"extensionsRequired[{index}]"
            )
