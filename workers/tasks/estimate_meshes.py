"""One part of the estimation of a collection: a few of its meshes, for the worker that has the whole."""

from typing import TYPE_CHECKING

from shapewright.progress import PartialProgress
from workers.context import JobContext, Outcome
from workers.helping import Helping
from workers.mesh_estimations import MeshEstimations

if TYPE_CHECKING:
    from sqlalchemy.orm import Session


def estimate_meshes(context: JobContext) -> Outcome:
    """Write the rows of these meshes; those that were written before this part gave way stay as they are."""
    helping = Helping(context)
    work = MeshEstimations(context)
    positions = [int(position) for position in context.claim.payload["positions"]]
    for position in work.missing(positions):
        place = positions.index(position)
        work.estimate(position, PartialProgress(helping, place / len(positions), (place + 1) / len(positions)))
    return Outcome(_nothing)


def _nothing(session: "Session") -> None:
    """The rows are written already."""
