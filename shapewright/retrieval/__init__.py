"""Finding meshes: the index of a collection, and its meshes by their likeness to a query (paper section 4.2).

Names are loaded when first used: a ranking needs no ONNX Runtime, and the kinds of evidence no numba.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.retrieval.collection_index import CollectionIndex
    from shapewright.retrieval.indexing import Indexed, SkippedMesh, index_meshes, look_at
    from shapewright.retrieval.ranking import ClassQuery, MeshQuery, RankedMesh, rank

_HOMES = {
    "ClassQuery": "ranking",
    "CollectionIndex": "collection_index",
    "Indexed": "indexing",
    "MeshQuery": "ranking",
    "RankedMesh": "ranking",
    "SkippedMesh": "indexing",
    "index_meshes": "indexing",
    "look_at": "indexing",
    "rank": "ranking",
}

__all__ = [
    "ClassQuery",
    "CollectionIndex",
    "Indexed",
    "MeshQuery",
    "RankedMesh",
    "SkippedMesh",
    "index_meshes",
    "look_at",
    "rank",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
