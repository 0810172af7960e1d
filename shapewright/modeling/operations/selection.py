"""Targets bound to a topology: which rows move, in which frames, about which points."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.frames import Centres, Positions, TargetFrames, frames_of_targets


@dataclass(frozen=True, eq=False)
class Run:
    """Vertices of consecutive targets that share none, so that all may move at once.

    Attributes:
        vertices: the rows that move.
        targets: the target of each.
    """

    vertices: Int[np.ndarray, " N"]
    targets: Int[np.ndarray, " N"]


@dataclass(frozen=True, eq=False)
class MovedTargets:
    """The frames of all targets, the vertices whose means are their pivots, and the rows.

    Targets that share vertices are in different runs, which move one after the other.
    """

    frames: TargetFrames
    pivots: Centres
    runs: tuple[Run, ...]

    def reads(self) -> set[int]:
        """Return the rows that are moved or that say how."""
        return self.frames.vertices() | self.pivots.vertices() | self.writes()

    def writes(self) -> set[int]:
        """Return the rows that are moved."""
        return {int(v) for run in self.runs for v in run.vertices}


def moved_targets(mesh: ControlMesh, targets: tuple[Target, ...], pivot: Element | None = None) -> MovedTargets:
    """Bind targets to a topology.

    Args:
        mesh: the topology at the time of the operation.
        targets: what moves.
        pivot: the element about whose centre every target is scaled or turned that names no pivot of its own;
            ``None`` means about the target's own centre.

    Raises:
        ModelError: no target, an empty one, an element that does not exist, or too much work.
    """
    if not targets or not all(target.elements for target in targets):
        raise ModelError("nothing is selected")
    frames = frames_of_targets(mesh, targets)
    moved, pivots = [], []
    for target in targets:
        vertices = mesh.vertices_of(target.elements)
        if not vertices:
            raise ModelError("a selected component has no vertices left")
        hinge = mesh.vertices_of(target.pivot or ((pivot,) if pivot else ())) or vertices
        mesh.spend(len(vertices) + len(hinge))
        moved.append(vertices)
        pivots.append(hinge)
    return MovedTargets(frames, Centres(pivots), _runs(moved))


def refuse_pivots(kind: str, targets: tuple[Target, ...]) -> None:
    """Raise ModelError if a target has a pivot, which only scale and rotate know."""
    if any(target.pivot for target in targets):
        raise ModelError(f"{kind} turns about no pivot")


def _runs(moved: list[list[int]]) -> tuple[Run, ...]:
    runs: list[list[tuple[int, int]]] = [[]]
    taken: set[int] = set()
    for target, vertices in enumerate(moved):
        if not taken.isdisjoint(vertices):
            runs.append([])
            taken = set()
        taken.update(vertices)
        runs[-1] += [(vertex, target) for vertex in vertices]
    return tuple(Run(*np.array(run, dtype=np.int64).T.copy()) for run in runs)


def map_about_pivots(positions: Positions, targets: MovedTargets, local_map: Float[np.ndarray, "3 3 B"]) -> None:
    """Apply a linear map of local coordinates to each target, about its pivot, in place.

    All frames and pivots are taken before anything moves, so targets do not depend on each other's order.
    """
    frames = targets.frames.evaluate(positions)
    maps = np.einsum("tijb,tkjb->tikb", np.einsum("tijb,jkb->tikb", frames, local_map), frames)
    pivots = targets.pivots.evaluate(positions)
    for run in targets.runs:
        if len(maps) == 1:  # the common case needs no copy of the map for each vertex
            positions[run.vertices] = pivots + np.einsum(
                "ijb,njb->nib", maps[0], positions.take(run.vertices, axis=0) - pivots
            )
        else:
            pivot = pivots.take(run.targets, axis=0)
            offsets = positions.take(run.vertices, axis=0) - pivot
            positions[run.vertices] = pivot + np.einsum("nijb,njb->nib", maps.take(run.targets, axis=0), offsets)


def stretch_about_pivots(positions: Positions, targets: MovedTargets, factors: Float[np.ndarray, "3 B"]) -> None:
    """Multiply local coordinates by factors, as :func:`map_about_pivots` does with a diagonal map."""
    if not targets.frames.along_axes:
        stretch = np.zeros((3, 3, positions.shape[2]))
        stretch[(0, 1, 2), (0, 1, 2)] = factors
        map_about_pivots(positions, targets, stretch)
        return
    pivots = targets.pivots.evaluate(positions)
    for run in targets.runs:
        pivot = pivots if len(pivots) == 1 else pivots.take(run.targets, axis=0)
        offsets = positions.take(run.vertices, axis=0) - pivot
        offsets *= factors
        offsets += pivot
        positions[run.vertices] = offsets
