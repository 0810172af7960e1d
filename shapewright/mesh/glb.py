"""Binary glTF of meshes that share one topology: written in one pass, so that a slider moves smoothly."""

import json
import struct
from typing import Final

import numpy as np
from jaxtyping import Float, Int

MEDIA_TYPE: Final = "model/gltf-binary"
_FLOAT: Final = 5126
_UNSIGNED_INT: Final = 5125
_ARRAY_BUFFER: Final = 34962
_ELEMENT_ARRAY_BUFFER: Final = 34963


class GlbWriter:
    """Writes meshes with the same triangles (glTF 2.0, section 4: GLB file format).

    No normals are written: a viewer shades the faces flat or computes normals as it likes.
    """

    def __init__(self, triangles: Int[np.ndarray, "F 3"]) -> None:
        self._indices = np.ascontiguousarray(triangles, dtype="<u4").tobytes()
        self._index_count = int(triangles.size)

    def write(self, vertices: Float[np.ndarray, "V 3"]) -> bytes:
        """The GLB file of one mesh; positions become float32."""
        positions = np.ascontiguousarray(vertices, dtype="<f4")
        data = positions.tobytes()
        document = {
            "asset": {"version": "2.0", "generator": "shapewright"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [
                {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.8}}
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": _FLOAT,
                    "count": len(positions),
                    "type": "VEC3",
                    "min": positions.min(axis=0).tolist(),
                    "max": positions.max(axis=0).tolist(),
                },
                {"bufferView": 1, "componentType": _UNSIGNED_INT, "count": self._index_count, "type": "SCALAR"},
            ],
            "bufferViews": [
                {"buffer": 0, "byteLength": len(data), "target": _ARRAY_BUFFER},
                {
                    "buffer": 0,
                    "byteOffset": len(data),
                    "byteLength": len(self._indices),
                    "target": _ELEMENT_ARRAY_BUFFER,
                },
            ],
            "buffers": [{"byteLength": len(data) + len(self._indices)}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary_length = len(data) + len(self._indices)  # both are multiples of 4
        total = 12 + 8 + len(text) + 8 + binary_length
        return b"".join(
            (
                struct.pack("<4sII", b"glTF", 2, total),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", binary_length, b"BIN\0"),
                data,
                self._indices,
            )
        )
