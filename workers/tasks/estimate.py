"""Find the parameter values and the pose with which a model, or the best one of a class, rebuilds an uploaded mesh."""

from functools import partial
from typing import TYPE_CHECKING, cast

from models_store import catalog
from shapewright.errors import Cancelled, EstimationError
from shapewright.progress import LimitedProgress
from workers.context import JobContext, Outcome
from workers.finite import finite
from workers.stored.banks import bank_of

if TYPE_CHECKING:
    from shapewright.estimation import Estimation, Query
    from shapewright.estimation.query import Axis, Unit


def estimate(context: JobContext) -> Outcome:
    """Run the estimation of the row; one that is cancelled or out of time hands back its best so far, if there is one.

    Raises:
        EstimationError: the time was over before anything was found.
        Cancelled: the job was cancelled before anything was found.
    """
    from shapewright.estimation import EstimationCancelled, EstimationSettings, Query
    from shapewright.estimation import estimate as find
    from shapewright.modeling import compile_model

    identifier = str(context.claim.payload["estimation_id"])
    with context.database.reading() as session:
        row = catalog.get_estimation(session, identifier)
    settings = EstimationSettings.from_dict(row.settings)
    model_ids = [str(row.model_id)] if row.model_ids is None else row.model_ids

    limit = LimitedProgress(
        context.progress, lambda: row.time_limit_s is not None and context.seconds >= row.time_limit_s
    )
    context.progress.report(0.0, "reading the mesh")
    query = Query(context.load_mesh(row.mesh_id), units=cast("Unit | None", row.units), up=cast("Axis | None", row.up))
    generators = [compile_model(context.load_model(model_id)) for model_id in model_ids]
    try:
        found = find(query, generators, settings, progress=limit, banks=partial(bank_of, context, settings))
        return _outcome(context, identifier, query, found)
    except EstimationCancelled as cancelled:
        if cancelled.best is not None:
            return _outcome(context, identifier, query, cancelled.best, cancelled=not limit.reached)
        if limit.reached:
            raise EstimationError("the time was over before anything was found", where="time_limit_s") from None
        raise Cancelled from None


def _outcome(
    context: JobContext, identifier: str, query: "Query", estimation: "Estimation", *, cancelled: bool = False
) -> Outcome:
    from shapewright.estimation.residual_views import ResidualViews

    key = context.own_key(f"estimations/{identifier}", "glb")
    residuals_key = context.own_key(f"estimations/{identifier}-residuals", "glb")
    context.artifacts.put(key, estimation.mesh.to_bytes("glb"))
    context.artifacts.put(residuals_key, ResidualViews.of(query.mesh, estimation.mesh).glb())
    result = finite({**estimation.to_dict(), "seconds": context.seconds})
    record = partial(
        catalog.record_estimation,
        identifier=identifier,
        result=result,
        mesh_key=key,
        residuals_key=residuals_key,
    )
    return Outcome(record, (key, residuals_key), cancelled=cancelled)
