"""Targets bound to a topology: which rows move, in which frame, about which point."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.frames import FrameSource, ImageFrame, Positions, WorldFrame, frames_of_targets


@dataclass(frozen=True)
class MovedTarget:
    """The vertices of a target, its frame and the vertices whose mean is its pivot."""

    vertices: list[int]
    frame: FrameSource | WorldFrame | ImageFrame
    pivot: list[int]


def moved_targets(
    mesh: ControlMesh, targets: tuple[Target, ...], pivot: Element | None = None
) -> tuple[MovedTarget, ...]:
    """Bind targets to a topology.

    Args:
        mesh: the topology at the time of the operation.
        targets: what moves.
        pivot: the element about whose centre every target is scaled or turned; ``None`` means about its own.

    Raises:
        ModelError: no target, an empty one, or an element that does not exist.
    """
    if not targets or not all(target.elements for target in targets):
        raise ModelError("nothing is selected")
    frames = frames_of_targets(mesh, targets)
    fixed = mesh.vertices_of([pivot]) if pivot else None
    bound = []
    for target, frame in zip(targets, frames, strict=True):
        vertices = mesh.vertices_of(target.elements)
        if not vertices:
            raise ModelError("a selected component has no vertices left")
        bound.append(MovedTarget(vertices, frame, fixed or vertices))
    return tuple(bound)


LocalMap = Callable[[Float[np.ndarray, "N B 3"]], Float[np.ndarray, "N B 3"]]


def map_about_pivots(positions: Positions, targets: tuple[MovedTarget, ...], local_map: LocalMap) -> None:
    """Apply a map to the local coordinates of each target, about its pivot, in place.

    All frames and pivots are taken before anything moves, so targets do not depend on each other's order.
    """
    frames = [target.frame.evaluate(positions) for target in targets]
    pivots = [positions[target.pivot].mean(axis=0) for target in targets]
    for target, frame, pivot in zip(targets, frames, pivots, strict=True):
        local = np.einsum("bji,nbj->nbi", frame, positions[target.vertices] - pivot)
        positions[target.vertices] = pivot + np.einsum("bij,nbj->nbi", frame, local_map(local))
