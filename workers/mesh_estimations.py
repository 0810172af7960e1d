"""The meshes of a collection estimation, one after the other; whatever is wrong with one of them is its row."""

import time
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final, cast

import structlog

from models_store import catalog
from models_store.errors import ArtifactError, ArtifactNotFoundError, StaleClaim
from models_store.session import OUTAGES
from shapewright.errors import Cancelled, EstimationError, ShapewrightError
from shapewright.progress import LimitedProgress, Progress
from workers.context import JobContext, utc_now
from workers.finite import finite
from workers.patience import patiently
from workers.stopping import GivingWay, WorkerStopping
from workers.stored.banks import bank_of

if TYPE_CHECKING:
    from models_store.tables import CollectionEstimationRow
    from shapewright.estimation import Estimation
    from shapewright.estimation.query import Axis, Unit
    from shapewright.modeling import CompiledModel

log = structlog.get_logger(__name__)

MESHES_A_PART: Final = 4
"""So few that a part that is lost costs a minute, and so many that the models are worth being compiled for them."""
UNEXPECTED: Final = "internal worker error; see its log"


class MeshEstimations:
    """Estimates meshes of a collection estimation and keeps a row for each, for the holder of a claim on it.

    Args:
        context: of the job, or of a part of it.
    """

    def __init__(self, context: JobContext) -> None:
        self._context = context
        self._id = str(context.claim.payload["collection_estimation_id"])
        with context.database.reading() as session:
            self.row: CollectionEstimationRow = catalog.get_collection_estimation(session, self._id)

    def missing(self, positions: "list[int] | range") -> list[int]:
        """Which of these meshes have no row yet."""

        def read() -> set[int]:
            with self._context.database.reading() as session:
                return catalog.estimated_positions(session, self._id)

        done = patiently(read, self._context.settings.result_patience_s)
        return [position for position in positions if position not in done]

    def estimate(self, position: int, progress: Progress) -> None:
        """Estimate a mesh and write its row.

        Raises:
            Cancelled: nobody wants it any more; nothing is written.
            StaleClaim: the work belongs to somebody else now.
        """
        began_s = time.perf_counter()
        answer: dict[str, Any] | None = None
        error: str | None = None
        try:
            answer = self._answer(position, progress)
        except (Cancelled, StaleClaim, WorkerStopping, GivingWay, *OUTAGES):
            raise
        except ShapewrightError as refused:
            if isinstance(refused, ArtifactError) and not isinstance(refused, ArtifactNotFoundError):
                raise  # the store is away: that is no fault of the mesh
            error = str(refused)
        except Exception:
            log.exception("a mesh of a collection broke its estimation", mesh_id=self.row.mesh_ids[position])
            error = UNEXPECTED
        self._write(position, answer, error, time.perf_counter() - began_s)

    def _answer(self, position: int, progress: Progress) -> dict[str, Any]:
        from shapewright.estimation import EstimationCancelled, EstimationSettings, Query, estimate
        from shapewright.estimation.table.rows import answer_of

        row, settings = self.row, EstimationSettings.from_dict(self.row.settings)
        mesh = self._context.load_mesh(row.mesh_ids[position])
        query = Query(mesh, units=cast("Unit | None", row.units), up=cast("Axis | None", row.up))
        banks = partial(bank_of, self._context, settings)
        compiled = self._compiled
        began_s, limit_s = time.perf_counter(), row.time_limit_s
        limit = LimitedProgress(progress, lambda: limit_s is not None and time.perf_counter() - began_s >= limit_s)
        try:
            found: Estimation = estimate(query, compiled, settings, progress=limit, banks=banks)
        except EstimationCancelled as cancelled:
            if not limit.reached:
                raise Cancelled from None
            if cancelled.best is None:
                raise EstimationError("the time was over before anything was found", where="time_limit_s") from None
            found = cancelled.best
        return cast("dict[str, Any]", finite(answer_of(found)))

    @cached_property
    def _compiled(self) -> "list[CompiledModel]":
        from shapewright.modeling import compile_model

        return [compile_model(self._context.load_model(model_id)) for model_id in self.row.model_ids]

    def _write(self, position: int, answer: dict[str, Any] | None, error: str | None, seconds: float) -> None:
        from shapewright.estimation.table.rows import TableRow, cells_of, number

        cells = cells_of(TableRow("", answer, error, seconds))
        numbers = {column: number(cell) for column, cell in cells.items()}

        def write() -> None:
            with self._context.database.writing() as session:
                catalog.record_estimated_mesh(
                    session,
                    self._context.claim,
                    self._id,
                    position,
                    mesh_id=self.row.mesh_ids[position],
                    answer=answer,
                    measures={column: value for column, value in numbers.items() if value is not None},
                    error=error,
                    seconds=seconds,
                    now=utc_now(),
                )

        patiently(write, self._context.settings.result_patience_s)
