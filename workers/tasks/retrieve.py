"""Order the meshes of a collection by their likeness to a class, a model or a mesh, and draw the first."""

from collections.abc import Iterator, Sequence
from functools import partial
from io import BytesIO
from typing import TYPE_CHECKING, Final

import numpy as np

from models_store import catalog
from models_store.errors import StoreError
from models_store.tables import CollectionRow, RetrievalRow
from shapewright.progress import PartialProgress, Progress
from workers.context import JobContext, Outcome
from workers.finite import finite
from workers.stored.banks import new_bank, stored_bank
from workers.stored.classifiers import stored_classifier
from workers.stored.indexes import load_index

if TYPE_CHECKING:
    from jaxtyping import Float32

    from shapewright.estimation import InstanceGenerator, PanoramaBank
    from shapewright.modeling import CompiledModel
    from shapewright.rendering import LabelledMesh
    from shapewright.retrieval import ClassQuery, CollectionIndex, MeshQuery, RankedMesh

SHEET_CELLS: Final = 24
"""Meshes on a contact sheet."""


def retrieve(context: JobContext) -> Outcome:
    """Rank the collection of the retrieval's row for its query."""
    from shapewright.retrieval import rank

    identifier = str(context.claim.payload["retrieval_id"])
    with context.database.reading() as session:
        row = catalog.get_retrieval(session, identifier)
        collection = catalog.get_collection(session, row.collection_id)
        names = catalog.mesh_names(session, collection.mesh_ids)
    context.progress.report(0.0, "reading the index")
    index = load_index(context, str(collection.index_key))
    query = _query(context, row, collection, index, PartialProgress(context.progress, 0.05, 0.5))
    evidence = row.settings["evidence"]
    ranked = rank(index, query, evidence, progress=PartialProgress(context.progress, 0.5, 0.7))
    found = ranked[: row.settings["limit"]]
    key = context.own_key(f"retrievals/{identifier}", "png")
    context.artifacts.put(key, _sheet(context, row, found, names))
    result = finite(
        {
            "mesh_count": len(ranked),
            "items": [
                {
                    "mesh_id": one.name,
                    "file_name": names[one.name],
                    "score": one.score,
                    "probability": one.probability,
                    "distance": one.distance,
                }
                for one in found
            ],
            "seconds": context.seconds,
        }
    )
    record = partial(catalog.record_retrieval, identifier=identifier, result=result, sheet_key=key)
    return Outcome(record, (key,))


def _query(
    context: JobContext, row: RetrievalRow, collection: CollectionRow, index: "CollectionIndex", progress: Progress
) -> "ClassQuery | MeshQuery":
    from shapewright.retrieval import ClassQuery, MeshQuery, look_at

    if row.mesh_id is not None:
        rows = index.rows_of([row.mesh_id])
        if rows:
            return MeshQuery.of(index, rows[row.mesh_id])
        progress.report(0.0, "looking at the query")
        classifier = stored_classifier(context, collection.classifier_id).classifier
        return look_at(context.load_query(row.mesh_id), classifier).as_query(index.class_names)
    if row.class_name is not None and row.settings["evidence"] == "probabilities":
        return ClassQuery(row.class_name)
    models = _models(context, row, collection)
    class_name = models[0].model.class_name
    if row.settings["evidence"] == "probabilities":
        return ClassQuery(class_name)
    return ClassQuery(class_name, _exemplars(context, row, models, progress))


def _models(context: JobContext, row: RetrievalRow, collection: CollectionRow) -> "list[CompiledModel]":
    """The model that is asked for, or those of the class that the classifier has learned from."""
    from shapewright.modeling import compile_model

    if row.model_id is not None:
        return [compile_model(context.load_model(row.model_id))]
    with context.database.reading() as session:
        learned_from = catalog.get_classifier(session, collection.classifier_id).model_ids
        of_class = [one for one in catalog.known_models(session, learned_from) if one.class_name == row.class_name]
    if not of_class:
        raise StoreError("none of the models that this class was learned from is in the catalog", where="class_name")
    return [compile_model(context.load_model(model.id)) for model in of_class]


def _exemplars(
    context: JobContext, row: RetrievalRow, models: "Sequence[CompiledModel]", progress: Progress
) -> "Float32[np.ndarray, 'M D']":
    from shapewright.classification import gather_instances, instances_of_each
    from shapewright.estimation import EstimationSettings

    count = instances_of_each(models, row.settings["instances"])

    def banks(compiled: "InstanceGenerator", part: Progress) -> "PanoramaBank":
        settings = EstimationSettings(samples=count, seed=row.settings["seed"])
        return stored_bank(context, compiled, settings) or new_bank(context, compiled, settings, part)

    return gather_instances(models, banks if count else None, progress=progress)


def _sheet(context: JobContext, row: RetrievalRow, found: "Sequence[RankedMesh]", names: dict[str, str]) -> bytes:
    """A PNG of the first meshes, below the query if that is a mesh."""
    from PIL import Image

    from shapewright.rendering import LabelledMesh, compose_mesh_sheet

    shown = found[:SHEET_CELLS]

    def drawn() -> "Iterator[LabelledMesh]":
        for number, one in enumerate(shown):
            context.progress.report(0.7 + 0.3 * number / len(shown), f"drawing: {number} of {len(shown)}")
            yield LabelledMesh(context.load_query(one.name), f"{number + 1}. {names[one.name]}", one.caption)

    wanted = f"of the class {row.class_name}"
    sections = []
    with context.database.reading() as session:
        if row.model_id is not None:
            wanted = f"like {catalog.get_model(session, row.model_id).name}"
        elif row.mesh_id is not None:
            wanted = "like the query"
            query_name = catalog.get_mesh(session, row.mesh_id).file_name
    if row.mesh_id is not None:
        sections.append(("query", iter([LabelledMesh(context.load_query(row.mesh_id), query_name)])))
    png = BytesIO()
    picture = compose_mesh_sheet([*sections, (f"meshes {wanted}", drawn())])
    Image.fromarray(picture).save(png, format="PNG", optimize=True)
    return png.getvalue()
