"""Find the parameter values and the pose with which a model, or the best one of a class, rebuilds an uploaded mesh."""

from functools import partial
from typing import TYPE_CHECKING, cast

from models_store import catalog
from shapewright.errors import Cancelled
from workers.context import JobContext, Outcome
from workers.finite import finite
from workers.stored.banks import bank_of

if TYPE_CHECKING:
    from shapewright.estimation import Estimation
    from shapewright.estimation.query import Axis, Unit


def estimate(context: JobContext) -> Outcome:
    """Run the estimation of the row; a cancelled one hands back its best so far, if it has one."""
    from shapewright.estimation import EstimationCancelled, EstimationSettings, Query
    from shapewright.estimation import estimate as find
    from shapewright.modeling import compile_model

    identifier = str(context.claim.payload["estimation_id"])
    with context.database.reading() as session:
        row = catalog.get_estimation(session, identifier)
    settings = EstimationSettings.from_dict(row.settings)
    model_ids = [str(row.model_id)] if row.model_ids is None else row.model_ids

    context.progress.report(0.0, "reading the mesh")
    query = Query(context.load_query(row.mesh_id), units=cast("Unit | None", row.units), up=cast("Axis | None", row.up))
    generators = [compile_model(context.load_model(model_id)) for model_id in model_ids]
    try:
        found = find(query, generators, settings, progress=context.progress, banks=partial(bank_of, context, settings))
        return _outcome(context, identifier, found)
    except EstimationCancelled as cancelled:
        if cancelled.best is None:
            raise Cancelled from None
        return _outcome(context, identifier, cancelled.best, cancelled=True)


def _outcome(context: JobContext, identifier: str, estimation: "Estimation", *, cancelled: bool = False) -> Outcome:
    key = context.own_key(f"estimations/{identifier}", "glb")
    context.artifacts.put(key, estimation.mesh.to_bytes("glb"))
    result = finite({**estimation.to_dict(), "seconds": context.seconds})
    record = partial(
        catalog.record_estimation,
        identifier=identifier,
        result=result,
        mesh_key=key,
    )
    return Outcome(record, (key,), cancelled=cancelled)
