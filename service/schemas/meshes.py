"""Meshes and point clouds that were uploaded."""

from typing import Annotated, Literal, Self

from pydantic import Field

from models_store.tables import MeshRow
from service.schemas.common import Moment, OutBody, PageOut

Coordinates = Annotated[list[float], Field(min_length=3, max_length=3)]


class MeshOut(OutBody):
    """An uploaded mesh or point cloud."""

    id: str = Field(description="SHA-256 of the file's bytes.")
    kind: Literal["mesh", "point_cloud"] = Field(
        description="A point cloud has no faces; it can be classified and retrieved, not estimated."
    )
    file_name: str
    file_type: str
    file_size: int = Field(description="Bytes of the file as it was uploaded.")
    vertex_count: int = Field(description="Of a point cloud, its points.")
    face_count: int
    bounds: Annotated[list[Coordinates], Field(min_length=2, max_length=2)] = Field(
        description="Smallest and largest x, y, z, in the file's own coordinates."
    )
    watertight: bool
    content_url: str = Field(description="The mesh or the points as GLB.")
    created_at: Moment

    @classmethod
    def from_row(cls, row: MeshRow) -> Self:
        """Write down a row."""
        return cls(
            id=row.id,
            kind="mesh" if row.face_count else "point_cloud",
            file_name=row.file_name,
            file_type=row.file_type,
            file_size=row.file_size,
            vertex_count=row.vertex_count,
            face_count=row.face_count,
            bounds=row.bounds,
            watertight=row.watertight,
            content_url=f"/v1/meshes/{row.id}/content",
            created_at=row.created_at,
        )


class MeshPageOut(PageOut[MeshOut]):
    """A page of meshes."""
