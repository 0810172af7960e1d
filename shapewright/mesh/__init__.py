"""Triangle meshes: the value, and reading and writing files."""

from shapewright.mesh.triangle_mesh import WRITABLE_TYPES, Normalization, TriangleMesh

__all__ = ["WRITABLE_TYPES", "Normalization", "TriangleMesh"]
