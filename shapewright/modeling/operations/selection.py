"""Targets bound to a topology: which vertices move, in which frames, about which points."""

from dataclasses import dataclass

from shapewright.errors import ModelError
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target
from shapewright.modeling.frames import TargetFrames, frames_of_targets, write_means
from shapewright.modeling.program import Program


@dataclass(frozen=True, eq=False)
class MovedTargets:
    """What each target of an operation needs.

    All frames and pivots are taken before anything moves, so targets do not depend on each other's order, except that
    they move one after the other: a vertex may be in several.

    Attributes:
        frames: of all targets.
        hinges: the vertices whose means are the pivots.
        moved: the vertices that move.
    """

    frames: TargetFrames
    hinges: tuple[list[int], ...]
    moved: tuple[list[int], ...]

    def write_pivots(self, program: Program) -> list[range]:
        """Write instructions that evaluate the pivots; return the row of each."""
        return write_means(program, self.hinges)


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
    moved, hinges = [], []
    for target in targets:
        vertices = mesh.vertices_of(target.elements)
        if not vertices:
            raise ModelError("a selected component has no vertices left")
        hinge = mesh.vertices_of(target.pivot or ((pivot,) if pivot else ())) or vertices
        mesh.spend(len(vertices) + len(hinge))
        moved.append(vertices)
        hinges.append(hinge)
    return MovedTargets(frames, tuple(hinges), tuple(moved))


def refuse_pivots(kind: str, targets: tuple[Target, ...]) -> None:
    """Raise ModelError if a target has a pivot, which only scale and rotate know."""
    if any(target.pivot for target in targets):
        raise ModelError(f"{kind} turns about no pivot")
