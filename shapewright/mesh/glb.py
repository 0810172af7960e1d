"""Binary glTF: meshes that share a topology, written in one pass so that a slider moves smoothly; colored scenes;
point clouds.
"""

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Float, Int

MEDIA_TYPE: Final = "model/gltf-binary"
_FLOAT: Final = 5126
_UNSIGNED_INT: Final = 5125
_ARRAY_BUFFER: Final = 34962
_ELEMENT_ARRAY_BUFFER: Final = 34963
_POINTS: Final = 0
_MATERIAL: Final = {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.8}}


class GlbWriter:
    """Writes meshes with the same triangles (glTF 2.0, section 4: GLB file format).

    No normals are written: a viewer shades the faces flat or computes normals as it likes.
    """

    def __init__(self, triangles: Int[np.ndarray, "F 3"]) -> None:
        self._indices = _index_bytes(triangles)

    def write(self, vertices: Float[np.ndarray, "V 3"]) -> bytes:
        """The GLB file of one mesh; positions become float32."""
        parts = _Parts()
        parts.add_mesh(vertices, self._indices)
        return parts.file()


@dataclass(frozen=True, eq=False)
class ColoredMesh:
    """A node of a scene.

    Args:
        name: of the node.
        vertices: positions.
        triangles: vertex indices.
        colors: red, green, blue in 0..1 of each vertex, as screens show them (sRGB).
    """

    name: str
    vertices: Float[np.ndarray, "V 3"]
    triangles: Int[np.ndarray, "F 3"]
    colors: Float[np.ndarray, "V 3"]


def write_colored_glb(meshes: Sequence[ColoredMesh]) -> bytes:
    """Return the GLB file of a scene with one node for each mesh; positions and colors become float32."""
    parts = _Parts()
    for mesh in meshes:
        parts.add_mesh(mesh.vertices, _index_bytes(mesh.triangles), name=mesh.name, colors=mesh.colors)
    return parts.file()


def write_points_glb(points: Float[np.ndarray, "N 3"]) -> bytes:
    """Return the GLB file of a point cloud; positions become float32, relative to a node in their middle.

    So a scan in the coordinates of a map, far from the origin, keeps its detail.
    """
    parts = _Parts()
    parts.add_points(points)
    return parts.file()


class _Parts:
    """What a file consists of: the lists of a glTF document, and the pieces of its binary chunk."""

    def __init__(self) -> None:
        self._nodes: list[dict[str, Any]] = []
        self._meshes: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, int]] = []
        self._pieces: list[bytes] = []  # all of a length that is a multiple of 4
        self._length = 0

    def add_mesh(
        self,
        vertices: Float[np.ndarray, "V 3"],
        indices: bytes,
        *,
        name: str | None = None,
        colors: Float[np.ndarray, "V 3"] | None = None,
    ) -> None:
        positions = np.ascontiguousarray(vertices, dtype="<f4")
        bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
        attributes = {"POSITION": self._add_vectors(positions, bounds)}
        corners = self._add(indices, _ELEMENT_ARRAY_BUFFER, _UNSIGNED_INT, len(indices) // 4, "SCALAR", {})
        if colors is not None:  # section 3.7.2.1: vertex colors are linear
            attributes["COLOR_0"] = self._add_vectors(_linear(colors).astype("<f4"), {})
        named = {} if name is None else {"name": name}
        self._nodes.append({"mesh": len(self._meshes), **named})
        self._meshes.append({"primitives": [{"attributes": attributes, "indices": corners, "material": 0}], **named})

    def add_points(self, points: Float[np.ndarray, "N 3"]) -> None:
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        positions = np.ascontiguousarray(points - middle, dtype="<f4")
        bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
        attributes = {"POSITION": self._add_vectors(positions, bounds)}
        self._nodes.append({"mesh": len(self._meshes), "translation": middle.tolist()})
        self._meshes.append({"primitives": [{"attributes": attributes, "mode": _POINTS, "material": 0}]})

    def _add_vectors(self, rows: np.ndarray, bounds: dict[str, Any]) -> int:
        return self._add(rows.tobytes(), _ARRAY_BUFFER, _FLOAT, len(rows), "VEC3", bounds)

    def _add(self, data: bytes, target: int, component: int, count: int, kind: str, bounds: dict[str, Any]) -> int:
        view: dict[str, int] = {"buffer": 0, "byteLength": len(data), "target": target}
        if self._length:
            view["byteOffset"] = self._length
        accessor = {"bufferView": len(self._views), "componentType": component, "count": count, "type": kind, **bounds}
        self._views.append(view)
        self._accessors.append(accessor)
        self._pieces.append(data)
        self._length += len(data)
        return len(self._accessors) - 1

    def file(self) -> bytes:
        document = {
            "asset": {"version": "2.0", "generator": "shapewright"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(self._nodes)))}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": [_MATERIAL],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": self._length}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        return b"".join(
            (
                struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + self._length),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", self._length, b"BIN\0"),
                *self._pieces,
            )
        )


def _index_bytes(triangles: Int[np.ndarray, "F 3"]) -> bytes:
    return np.ascontiguousarray(triangles, dtype="<u4").tobytes()


def _linear(colors: Float[np.ndarray, "V 3"]) -> Float[np.ndarray, "V 3"]:
    """Return sRGB colors as linear light (IEC 61966-2-1)."""
    return np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
