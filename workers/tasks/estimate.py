"""Find the parameter values and the pose with which a model rebuilds an uploaded mesh."""

from functools import partial
from typing import TYPE_CHECKING

from models_store import catalog
from shapewright.errors import Cancelled
from shapewright.progress import PartialProgress
from workers.banks import BankCancelled, new_bank, stored_bank
from workers.context import JobContext, Outcome
from workers.finite import finite

if TYPE_CHECKING:
    from shapewright.estimation import Estimation, EstimationSettings, PanoramaBank
    from shapewright.mesh import TriangleMesh
    from shapewright.modeling import CompiledModel

_BANK_SHARE = 0.3


class _OnlyTheFirstStep:
    """Lets an estimation begin and cancels it at its first step."""

    def report(self, fraction: float, message: str) -> None:
        """Cancel as soon as anything is done."""
        if fraction > 0:
            raise Cancelled


def estimate(context: JobContext) -> Outcome:
    """Run the estimation of the row; a cancelled one hands back its best so far, if it has one."""
    from shapewright.estimation import EstimationCancelled, EstimationSettings
    from shapewright.estimation import estimate as find

    identifier = str(context.claim.payload["estimation_id"])
    with context.database.reading() as session:
        row = catalog.get_estimation(session, identifier)
    settings = EstimationSettings.from_dict(row.settings)
    context.progress.report(0.0, "reading the mesh")
    query = context.load_query(row.mesh_id)
    compiled = context.load_model(row.model_id).compile()
    progress = PartialProgress(context.progress, 0.0, 1.0)
    try:
        bank = stored_bank(context, compiled, settings)
        if bank is None:
            building = PartialProgress(context.progress, 0.0, _BANK_SHARE)
            bank = new_bank(context, compiled, settings, building)
            progress = PartialProgress(context.progress, _BANK_SHARE, 1.0)
        return _outcome(context, identifier, find(query, compiled, settings, progress=progress, bank=bank))
    except EstimationCancelled as cancelled:
        best = cancelled.best
    except BankCancelled as cancelled:
        best = _best_of(cancelled.bank, query, compiled, settings)
    if best is None:
        raise Cancelled
    return _outcome(context, identifier, best, cancelled=True)


def _best_of(
    bank: "PanoramaBank | None",
    query: "TriangleMesh",
    compiled: "CompiledModel",
    settings: "EstimationSettings",
) -> "Estimation | None":
    """The nearest of the samples that were ready."""
    from shapewright.estimation import EstimationCancelled
    from shapewright.estimation import estimate as find

    if bank is None:
        return None
    try:
        return find(query, compiled, settings, progress=_OnlyTheFirstStep(), bank=bank)
    except EstimationCancelled as cancelled:
        return cancelled.best


def _outcome(context: JobContext, identifier: str, estimation: "Estimation", *, cancelled: bool = False) -> Outcome:
    key = context.own_key(f"estimations/{identifier}", "glb")
    context.artifacts.put(key, estimation.mesh.to_bytes("glb"))
    result = finite({**estimation.to_dict(), "seconds": context.seconds})
    record = partial(catalog.record_estimation, identifier=identifier, result=result, mesh_key=key)
    return Outcome(record, (key,), cancelled=cancelled)
