"""Find the parameter values and the pose with which a model, or the best one of a class, rebuilds an uploaded mesh."""

from functools import partial
from typing import TYPE_CHECKING, Any

from models_store import catalog
from shapewright.errors import Cancelled
from shapewright.progress import PartialProgress, Progress
from workers.banks import new_bank, stored_bank
from workers.context import JobContext, Outcome
from workers.finite import finite

if TYPE_CHECKING:
    from shapewright.estimation import Estimation, EstimationSettings, PanoramaBank
    from shapewright.estimation.generator import InstanceGenerator
    from shapewright.mesh import TriangleMesh

_BANK_SHARE = 0.3


def estimate(context: JobContext) -> Outcome:
    """Run the estimation of the row; a cancelled one hands back its best so far, if it has one."""
    from shapewright.estimation import EstimationSettings

    identifier = str(context.claim.payload["estimation_id"])
    with context.database.reading() as session:
        row = catalog.get_estimation(session, identifier)
    settings = EstimationSettings.from_dict(row.settings)
    context.progress.report(0.0, "reading the mesh")
    query = context.load_query(row.mesh_id)
    if row.model_ids is None:
        return _with_model(context, identifier, query, str(row.model_id), settings)
    return _with_class(context, identifier, query, row.model_ids, settings)


def _with_model(
    context: JobContext, identifier: str, query: "TriangleMesh", model_id: str, settings: "EstimationSettings"
) -> Outcome:
    from shapewright.estimation import BankCancelled, EstimationCancelled
    from shapewright.estimation import estimate as find
    from shapewright.estimation.estimate import nearest
    from shapewright.modeling import compile_model

    compiled = compile_model(context.load_model(model_id))
    progress = PartialProgress(context.progress, 0.0, 1.0)
    try:
        bank = stored_bank(context, compiled, settings)
        if bank is None:
            building = PartialProgress(context.progress, 0.0, _BANK_SHARE)
            bank = new_bank(context, compiled, settings, building)
            progress = PartialProgress(context.progress, _BANK_SHARE, 1.0)
        found = find(query, compiled, settings, progress=progress, bank=bank)
        return _outcome(context, identifier, found, found.to_dict())
    except EstimationCancelled as cancelled:
        best = cancelled.best
    except BankCancelled as cancelled:
        best = None if cancelled.bank is None else nearest(query, compiled, settings, cancelled.bank)
    if best is None:
        raise Cancelled
    return _outcome(context, identifier, best, best.to_dict(), cancelled=True)


def _with_class(
    context: JobContext, identifier: str, query: "TriangleMesh", model_ids: list[str], settings: "EstimationSettings"
) -> Outcome:
    from shapewright.estimation import ClassEstimationCancelled, estimate_class
    from shapewright.modeling import compile_model

    def bank_of(compiled: "InstanceGenerator", progress: Progress) -> "PanoramaBank":
        return stored_bank(context, compiled, settings) or new_bank(context, compiled, settings, progress)

    generators = [compile_model(context.load_model(model_id)) for model_id in model_ids]
    try:
        best = estimate_class(query, generators, settings, progress=context.progress, bank_of=bank_of)
        cancelled = False
    except ClassEstimationCancelled as error:
        if error.best is None:
            raise Cancelled from None
        best, cancelled = error.best, True
    return _outcome(
        context, identifier, best.estimation, best.to_dict(), model_id=best.model.digest, cancelled=cancelled
    )


def _outcome(
    context: JobContext,
    identifier: str,
    estimation: "Estimation",
    document: dict[str, Any],
    *,
    model_id: str | None = None,
    cancelled: bool = False,
) -> Outcome:
    key = context.own_key(f"estimations/{identifier}", "glb")
    context.artifacts.put(key, estimation.mesh.to_bytes("glb"))
    result = finite({**document, "seconds": context.seconds})
    record = partial(catalog.record_estimation, identifier=identifier, result=result, mesh_key=key, model_id=model_id)
    return Outcome(record, (key,), cancelled=cancelled)
