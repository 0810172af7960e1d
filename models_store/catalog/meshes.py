"""Uploaded meshes and point clouds: the bytes as they came, and what was read from them as GLB."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from models_store.artifacts import ArtifactStore
from models_store.catalog.rows import get_row, insert_once
from models_store.errors import ArtifactError, NotFoundError
from models_store.paging import Page, fetch_page
from models_store.session import Database
from models_store.tables import MeshRow
from models_store.text import check_id, storable
from shapewright.errors import MeshError

if TYPE_CHECKING:
    from shapewright.mesh import PointCloud, TriangleMesh


_IDS_A_QUERY: Final = 500


def mesh_id(data: bytes) -> str:
    """The id of the mesh in an uploaded file: SHA-256 of its bytes."""
    return hashlib.sha256(data).hexdigest()


def store_mesh(
    database: Database,
    artifacts: ArtifactStore,
    data: bytes,
    *,
    file_name: str,
    file_type: str,
    mesh: "TriangleMesh | PointCloud",
    now: datetime,
) -> tuple[MeshRow, bool]:
    """Keep an uploaded file and what was read from it. Returns its row, and whether it is new.

    Args:
        database: where the row goes.
        artifacts: where the bytes go, before the row.
        data: the file as it was uploaded.
        file_name: its name at the uploader's.
        file_type: one of :data:`shapewright.mesh.sniff.QUERY_TYPES`.
        mesh: what :func:`shapewright.mesh.file.parse_query` read from it; a point cloud has no faces.
        now: the time, with a zone.

    Raises:
        ArtifactError: no room for it; nothing is left behind.
    """
    identifier = mesh_id(data)
    with database.reading() as session:
        existing = session.get(MeshRow, identifier)
    if existing is not None:
        return existing, False
    content = _content(mesh)
    row = MeshRow(
        id=identifier,
        file_name=storable(file_name, limit=255),
        file_type=file_type,
        file_size=len(data),
        vertex_count=content.vertices,
        face_count=content.faces,
        bounds=mesh.bounds.tolist(),
        watertight=content.watertight,
        source_key=f"meshes/{identifier}/source.{file_type}",
        content_key=f"meshes/{identifier}/mesh.glb",
        created_at=now,
    )
    try:
        artifacts.put(row.source_key, data)
        artifacts.put(row.content_key, content.glb)
    except ArtifactError:
        # Should somebody upload the same bytes at this very moment, their row may now miss its files; the
        # store is full or broken for them too.
        for key in (row.source_key, row.content_key):
            artifacts.delete(key)
        raise
    with database.writing() as session:
        return add_mesh(session, row)


@dataclass(frozen=True)
class _Content:
    vertices: int
    faces: int
    watertight: bool
    glb: bytes


def _content(mesh: "TriangleMesh | PointCloud") -> _Content:
    from shapewright.mesh import PointCloud
    from shapewright.mesh.glb import write_points_glb

    if isinstance(mesh, PointCloud):
        return _Content(len(mesh.points), 0, False, write_points_glb(mesh.points))
    return _Content(len(mesh.vertices), len(mesh.faces), mesh.is_watertight, mesh.to_bytes("glb"))


def add_mesh(session: Session, row: MeshRow) -> tuple[MeshRow, bool]:
    """Add the row of a mesh whose artefacts are there. Returns the row, and whether it is new."""
    return insert_once(session, row)


def get_mesh(session: Session, identifier: str) -> MeshRow:
    """The mesh with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, MeshRow, "mesh", identifier)


def require_faces(session: Session, identifiers: Sequence[str], where: str) -> None:
    """Refuse point clouds where a surface is needed. Ids of no mesh are passed over.

    Args:
        session: a session.
        identifiers: of the meshes.
        where: the field that names them; ``{}`` in it becomes the number of the point cloud.

    Raises:
        MeshError: one of them is a point cloud; the first that is.
    """
    for start in range(0, len(identifiers), _IDS_A_QUERY):
        asked = identifiers[start : start + _IDS_A_QUERY]
        clouds = set(session.scalars(select(MeshRow.id).where(MeshRow.id.in_(asked), MeshRow.face_count == 0)))
        for number, identifier in enumerate(asked, start):
            if identifier in clouds:
                raise MeshError(
                    "this is a point cloud, and an estimation needs a mesh with faces (classification and retrieval"
                    " take point clouds)",
                    where=where.format(number),
                )


def mesh_names(session: Session, identifiers: Sequence[str]) -> dict[str, str]:
    """The file name of each of these meshes, whose ids are all different, in their order.

    Raises:
        NotFoundError: one is not there; the first that is not.
    """
    checked = [check_id("mesh", identifier) for identifier in identifiers]
    found: dict[str, str] = {}
    for start in range(0, len(checked), _IDS_A_QUERY):
        query = select(MeshRow.id, MeshRow.file_name).where(MeshRow.id.in_(checked[start : start + _IDS_A_QUERY]))
        found.update((row.id, row.file_name) for row in session.execute(query))
    for identifier in checked:
        if identifier not in found:
            raise NotFoundError("mesh", identifier)
    return {identifier: found[identifier] for identifier in checked}


def list_meshes(session: Session, *, limit: int = 50, cursor: str | None = None) -> Page[MeshRow]:
    """One page of meshes, newest first.

    Raises:
        CursorError: a cursor of somewhere else, or a limit out of range.
    """
    return fetch_page(session, select(MeshRow), MeshRow, limit=limit, cursor=cursor)
