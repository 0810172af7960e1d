"""Uploaded meshes: the bytes as they came, and what was read from them as GLB."""

import hashlib
from collections.abc import Sequence
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

if TYPE_CHECKING:
    from shapewright.mesh import TriangleMesh


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
    mesh: "TriangleMesh",
    now: datetime,
) -> tuple[MeshRow, bool]:
    """Keep an uploaded file and what was read from it. Returns its row, and whether it is new.

    Args:
        database: where the row goes.
        artifacts: where the bytes go, before the row.
        data: the file as it was uploaded.
        file_name: its name at the uploader's.
        file_type: ``obj``, ``off``, ``ply``, ``stl``, ``glb`` or ``gltf``.
        mesh: what :func:`shapewright.mesh.file.parse_mesh` read from it.
        now: the time, with a zone.

    Raises:
        ArtifactError: no room for it; nothing is left behind.
    """
    identifier = mesh_id(data)
    with database.reading() as session:
        existing = session.get(MeshRow, identifier)
    if existing is not None:
        return existing, False
    row = MeshRow(
        id=identifier,
        file_name=storable(file_name, limit=255),
        file_type=file_type,
        file_size=len(data),
        vertex_count=len(mesh.vertices),
        face_count=len(mesh.faces),
        bounds=mesh.bounds.tolist(),
        watertight=mesh.is_watertight,
        source_key=f"meshes/{identifier}/source.{file_type}",
        content_key=f"meshes/{identifier}/mesh.glb",
        created_at=now,
    )
    content = mesh.to_bytes("glb")
    try:
        artifacts.put(row.source_key, data)
        artifacts.put(row.content_key, content)
    except ArtifactError:
        # Should somebody upload the same bytes at this very moment, their row may now miss its files; the
        # store is full or broken for them too.
        for key in (row.source_key, row.content_key):
            artifacts.delete(key)
        raise
    with database.writing() as session:
        return add_mesh(session, row)


def add_mesh(session: Session, row: MeshRow) -> tuple[MeshRow, bool]:
    """Add the row of a mesh whose artefacts are there. Returns the row, and whether it is new."""
    return insert_once(session, row)


def get_mesh(session: Session, identifier: str) -> MeshRow:
    """The mesh with this id.

    Raises:
        NotFoundError: there is none.
    """
    return get_row(session, MeshRow, "mesh", identifier)


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
