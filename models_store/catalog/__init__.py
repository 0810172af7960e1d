"""What the store knows: models, meshes, classifiers, classifications, estimations, collections, retrievals.

Every function takes a session, so that several steps can share one transaction. Models and meshes are addressed
by their content; the others are asked for together with the job that fills them in.
"""

from models_store.catalog.classifications import (
    get_classification,
    list_classifications,
    record_classification,
    request_classification,
)
from models_store.catalog.classifiers import (
    get_classifier,
    list_classifiers,
    newest_classifier,
    ready_classifier,
    record_classifier,
    request_classifier,
)
from models_store.catalog.collection_estimations import (
    DoneCounts,
    count_estimated,
    get_collection_estimation,
    list_collection_estimations,
    request_collection_estimation,
)
from models_store.catalog.collections import (
    get_collection,
    index_keys,
    list_collections,
    record_collection,
    request_collection,
)
from models_store.catalog.estimated_meshes import (
    RankedMesh,
    RowOrder,
    all_estimated,
    estimated_positions,
    page_of_estimated,
    record_estimated_mesh,
)
from models_store.catalog.estimations import (
    get_estimation,
    list_estimations,
    record_estimation,
    request_estimation,
)
from models_store.catalog.meshes import add_mesh, get_mesh, list_meshes, mesh_id, mesh_names, store_mesh
from models_store.catalog.models import (
    add_model,
    get_model,
    known_models,
    list_classes,
    list_models,
    models_of_class,
    record_thumbnail,
    request_thumbnail,
)
from models_store.catalog.retrievals import (
    get_retrieval,
    list_retrievals,
    record_retrieval,
    request_retrieval,
)
from models_store.catalog.shipped import (
    ShippedItem,
    ShippedKind,
    add_shipped_classifier,
    add_shipped_model,
    missing_shipped,
    shipped_classifier,
)

__all__ = [
    "DoneCounts",
    "RankedMesh",
    "RowOrder",
    "ShippedItem",
    "ShippedKind",
    "add_mesh",
    "add_model",
    "add_shipped_classifier",
    "add_shipped_model",
    "all_estimated",
    "count_estimated",
    "estimated_positions",
    "get_classification",
    "get_classifier",
    "get_collection",
    "get_collection_estimation",
    "get_estimation",
    "get_mesh",
    "get_model",
    "get_retrieval",
    "index_keys",
    "known_models",
    "list_classes",
    "list_classifications",
    "list_classifiers",
    "list_collection_estimations",
    "list_collections",
    "list_estimations",
    "list_meshes",
    "list_models",
    "list_retrievals",
    "mesh_id",
    "mesh_names",
    "missing_shipped",
    "models_of_class",
    "newest_classifier",
    "page_of_estimated",
    "ready_classifier",
    "record_classification",
    "record_classifier",
    "record_collection",
    "record_estimated_mesh",
    "record_estimation",
    "record_retrieval",
    "record_thumbnail",
    "request_classification",
    "request_classifier",
    "request_collection",
    "request_collection_estimation",
    "request_estimation",
    "request_retrieval",
    "request_thumbnail",
    "shipped_classifier",
    "store_mesh",
]
