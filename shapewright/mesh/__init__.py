"""Triangle meshes and point clouds: the values, and reading and writing files."""

from shapewright.mesh.point_cloud import PointCloud
from shapewright.mesh.triangle_mesh import WRITABLE_TYPES, Normalization, TriangleMesh

__all__ = ["WRITABLE_TYPES", "Normalization", "PointCloud", "TriangleMesh"]
