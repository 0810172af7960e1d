"""Estimate the parameters of many meshes, together with workers that have nothing else to do."""

from functools import partial
from typing import TYPE_CHECKING, Final

from models_store.job_kinds import JobKind
from shapewright.progress import CallbackProgress, PartialProgress
from workers.context import JobContext, Outcome
from workers.mesh_estimations import MeshEstimations
from workers.shared_parts import SharedParts

if TYPE_CHECKING:
    from sqlalchemy.orm import Session

MESHES_A_PART: Final = 4
"""So few that a part that is lost costs a minute, and so many that the models are worth being compiled for them."""


def estimate_collection(context: JobContext) -> Outcome:
    """Estimate the meshes that no interrupted attempt has; each has its row as soon as it is done."""
    work = MeshEstimations(context)
    count = len(work.row.mesh_ids)
    context.progress.report(0.0, f"0 of {count} meshes")
    positions = work.missing(range(count))
    groups = [positions[start : start + MESHES_A_PART] for start in range(0, len(positions), MESHES_A_PART)]
    identifier = context.claim.payload["collection_estimation_id"]
    payloads = [{"collection_estimation_id": identifier, "positions": group} for group in groups]

    def estimate(group: list[int]) -> None:
        for position in work.missing(group):
            done = count - len(work.missing(positions))
            share, message = done / count, f"{done} of {count} meshes"
            work.estimate(position, CallbackProgress(partial(_repeat, context, share, message)))

    waiting = PartialProgress(context.progress, (count - len(positions)) / count, 1.0)
    for number, _ in SharedParts(context, JobKind.ESTIMATE_MESHES, payloads).mine(waiting):
        estimate(groups[number])
    estimate(positions)  # what failed at another worker
    return Outcome(_nothing)


def _repeat(context: JobContext, share: float, message: str, *_: object) -> None:
    """Report how many meshes are done, whatever is done with the one at hand."""
    context.progress.report(share, message)


def _nothing(session: "Session") -> None:
    """The rows are written already."""
