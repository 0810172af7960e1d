"""Triangle meshes: the value that queries, instances and fitted meshes are passed around as.

Polygon soup is normal here: nothing asks for a closed, oriented or manifold mesh. Reading files is in
:mod:`shapewright.mesh.file`.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from shapewright.errors import MeshError
from shapewright.mesh.glb import GlbWriter
from shapewright.mesh.places import first_at_place
from shapewright.whole_file import write_whole

WRITABLE_TYPES = ("glb", "obj", "off", "ply", "stl")
"""The file types a mesh can be written as."""


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices and triangles, in the units of whoever made them.

    Args:
        vertices: positions; kept as C-contiguous float64.
        faces: vertex indices of each triangle; kept as C-contiguous int64.

    The arrays are not copied when they already have that form. They are the value of the mesh: do not write
    into them, derived figures are computed once and kept.

    Raises:
        MeshError: wrong shapes, no faces, a coordinate that is not finite, an index out of range.
    """

    vertices: Float[np.ndarray, "V 3"]
    faces: Int[np.ndarray, "F 3"]

    def __post_init__(self) -> None:
        vertices = np.asarray(self.vertices)
        faces = np.asarray(self.faces)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or vertices.dtype.kind not in "fiu":
            raise MeshError(f"expected numbers of shape (V, 3), got {vertices.shape}", where="vertices")
        if faces.ndim != 2 or faces.shape[1] != 3 or (faces.size and faces.dtype.kind not in "iu"):
            raise MeshError(f"expected integers of shape (F, 3), got {faces.shape}", where="faces")
        if len(faces) == 0:
            raise MeshError("the mesh has no faces", where="faces")
        vertices = np.ascontiguousarray(vertices, dtype=np.float64)
        faces = np.ascontiguousarray(faces, dtype=np.int64)
        finite = np.isfinite(vertices).all(axis=1)
        if not finite.all():
            raise MeshError("a coordinate is NaN or infinite", where=f"vertices[{int(np.argmin(finite))}]")
        in_range = ((faces >= 0) & (faces < len(vertices))).all(axis=1)
        if not in_range.all():
            face = int(np.argmin(in_range))
            raise MeshError(
                f"index out of range: {faces[face].tolist()} of {len(vertices)} vertices",
                where=f"faces[{face}]",
            )
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    @property
    def triangles(self) -> Float[np.ndarray, "F 3 3"]:
        """Corner positions of each triangle."""
        return np.asarray(self.vertices[self.faces])

    @cached_property
    def _crosses(self) -> Float[np.ndarray, "F 3"]:
        corners = self.triangles
        return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))

    @cached_property
    def face_areas(self) -> Float[np.ndarray, " F"]:
        """Area of each triangle, in squared units of the coordinates."""
        return np.asarray(np.linalg.norm(self._crosses, axis=1)) * 0.5

    @cached_property
    def face_normals(self) -> Float[np.ndarray, "F 3"]:
        """Unit normals by the winding of each triangle; zero where a triangle has no area."""
        doubled = 2.0 * self.face_areas[:, None]
        zeros = np.zeros_like(self._crosses)
        return np.asarray(np.divide(self._crosses, doubled, out=zeros, where=doubled > 0))

    @property
    def area(self) -> float:
        """Total surface area."""
        return float(self.face_areas.sum())

    @cached_property
    def centroid(self) -> Float[np.ndarray, " 3"]:
        """Area-weighted mean of the surface.

        Raises:
            MeshError: the surface has no area.
        """
        if not self.area > 0:
            raise MeshError("the surface has no area", where="faces")
        return np.asarray(self.face_areas @ self.triangles.mean(axis=1) / self.area)

    @property
    def vertex_mean(self) -> Float[np.ndarray, " 3"]:
        """Plain mean of the vertices (the paper's "center of mass", section 3.3)."""
        return np.asarray(self.vertices.mean(axis=0))

    @property
    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Smallest and largest coordinates."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def is_watertight(self) -> bool:
        """Whether every edge belongs to exactly two triangles (vertices are told apart by index)."""
        edges = np.sort(self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys = edges[:, 0] * len(self.vertices) + edges[:, 1]
        return bool((np.unique(keys, return_counts=True)[1] == 2).all())

    def transformed(
        self,
        rotation: Float[np.ndarray, "3 3"],
        translation: Float[np.ndarray, " 3"],
        scale: float = 1.0,
    ) -> "TriangleMesh":
        """The mesh with every vertex ``v`` at ``scale * rotation @ v + translation``."""
        return TriangleMesh(scale * (self.vertices @ rotation.T) + translation, self.faces)

    def normalized(self) -> "Normalization":
        """Vertex mean to the origin, all coordinates within [-1, 1], one of them at the end (section 3.3).

        Raises:
            MeshError: all vertices are one point.
        """
        centred = self.vertices - self.vertex_mean
        extent = float(np.abs(centred).max())
        if not extent > 0 or not np.isfinite(1.0 / extent):
            raise MeshError("all vertices are one point", where="vertices")
        scale = 1.0 / extent
        return Normalization(TriangleMesh(centred * scale, self.faces), -scale * self.vertex_mean, scale)

    def cleaned(self) -> "TriangleMesh":
        """The same surface without what carries none of it; the form in which files are handed out.

        - Vertices at exactly the same position become one (as in STL, where each triangle brings its own).
        - Triangles without area are dropped: a repeated corner, or an area below 1e-15 of the squared
          diagonal of the bounding box.
        - Vertices that no triangle uses are dropped: they would move the vertex mean.

        Kept on purpose: winding, repeated triangles, holes, non-manifold edges, separate parts.

        Raises:
            MeshError: nothing with an area is left.
        """
        faces = first_at_place(self.vertices)[self.faces]
        a, b, c = (self.vertices[faces[:, k]] for k in range(3))
        diagonal = float(np.linalg.norm(self.bounds[1] - self.bounds[0]))
        areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        faces = faces[areas > 1e-15 * diagonal**2]
        if len(faces) == 0:
            raise MeshError("no face has an area", where="faces")
        used, renumbered = np.unique(faces, return_inverse=True)
        return TriangleMesh(self.vertices[used], renumbered.reshape(-1, 3))

    @classmethod
    def from_trimesh(cls, mesh: Any) -> "TriangleMesh":
        """Take vertices and faces of a ``trimesh.Trimesh`` as they are (copied)."""
        return cls(np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64))

    def to_trimesh(self) -> Any:
        """A ``trimesh.Trimesh`` with copies of the same vertices and faces, unprocessed."""
        import trimesh

        return trimesh.Trimesh(self.vertices.copy(), self.faces.copy(), process=False)

    def to_bytes(self, file_type: str) -> bytes:
        """The mesh as the bytes of a file; OBJ and OFF give every float64 back, the others keep float32.

        Raises:
            MeshError: the type is none of glb, obj, off, ply, stl.
        """
        if file_type not in WRITABLE_TYPES:
            raise MeshError(f"cannot write {file_type!r}; known: {', '.join(WRITABLE_TYPES)}")
        if file_type == "obj":
            return self._text("v %.17g %.17g %.17g", "f %d %d %d", first_index=1)
        if file_type == "off":
            counts = f"OFF\n{len(self.vertices)} {len(self.faces)} 0\n"
            return counts.encode() + self._text("%.17g %.17g %.17g", "3 %d %d %d", first_index=0)
        if file_type == "glb":
            return GlbWriter(self.faces).write(self.vertices)
        return bytes(self.to_trimesh().export(file_type=file_type))

    def _text(self, vertex_line: str, face_line: str, *, first_index: int) -> bytes:
        lines = [vertex_line % tuple(row) for row in self.vertices.tolist()]
        lines += [face_line % tuple(row) for row in (self.faces + first_index).tolist()]
        return ("\n".join(lines) + "\n").encode()

    def save(self, path: str | Path) -> None:
        """Write a file whose type is the ending of its name.

        Raises:
            MeshError: the ending is none of .glb .obj .off .ply .stl.
            OSError: the file cannot be written.
        """
        data = self.to_bytes(Path(path).suffix.lower().lstrip("."))
        write_whole(path, data)


@dataclass(frozen=True, eq=False)
class Normalization:
    """A mesh in the shared coordinate system, and how it came there.

    ``mesh.vertices == scale * original + translation``, what ``original.transformed(identity, translation,
    scale)`` does; the way back is ``(mesh.vertices - translation) / scale``.
    """

    mesh: TriangleMesh
    translation: Float[np.ndarray, " 3"]
    scale: float
