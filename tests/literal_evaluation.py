"""Control meshes as the definitions say, in plain NumPy: what the compiled evaluation must agree with.

Nothing is prepared, shared or skipped here. Positions are (V, 3, B) for B instances.
"""

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np

from shapewright.modeling import Condition, ProceduralModel
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import Element, Target, image_matrix
from shapewright.modeling.frames import FrameSource, frame_of_element


def literal_control_points(model: ProceduralModel, settled: np.ndarray) -> np.ndarray:
    """Return the control points (B, V, 3) of settled rows of values (B, P)."""
    mesh, positions = ControlMesh(), np.zeros((0, 3, len(settled)))
    acting: dict[int, list[tuple[str, int]]] = defaultdict(list)
    for column, parameter in enumerate(model.parameters):
        for target in parameter.targets:
            acting[target.operation].append((target.mode, column))
    for index, operation in enumerate(model.operations):
        amounts = {name: np.full(len(settled), float(getattr(operation, name))) for name in operation.quantities}
        for mode, column in acting[index]:
            _change(amounts, operation.kind, mode, settled[:, column])
        positions = _moved(operation, mesh, positions, amounts)
    _draw_absent_parts_together(model, settled, mesh, positions)
    return positions[mesh.live_vertices()].transpose(2, 0, 1)


def literal_settled(model: ProceduralModel, row: np.ndarray) -> np.ndarray:
    """Return one row of values in its ranges, options whole, 1 where not active."""
    columns = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    settled = np.array(row)
    for column, parameter in enumerate(model.parameters):
        bounds = {"minimum": [parameter.minimum], "maximum": [parameter.maximum]}
        for limit in parameter.limits:
            bounds[limit.bound].append(limit.offset + limit.factor * settled[columns[limit.parameter]])
        low, high = max(bounds["minimum"]), min(bounds["maximum"])
        x = np.rint(row[column]) if parameter.options else row[column]
        settled[column] = min(max(x, min(low, high)), high) if _hold(model, parameter.active_when, settled) else 1.0
    return settled


def _hold(model: ProceduralModel, conditions: Iterable[Condition], row: np.ndarray) -> bool:
    columns = {parameter.name: column for column, parameter in enumerate(model.parameters)}
    return all(
        _hold(model, model.parameters[columns[one.parameter]].active_when, row)
        and one.minimum <= row[columns[one.parameter]] <= one.maximum
        for one in conditions
    )


def _change(amounts: dict[str, np.ndarray], kind: str, mode: str, x: np.ndarray) -> None:
    """Table 1."""
    if mode == "angle" and kind in ("drag", "extrude"):
        amounts["phi_deg"] = amounts["phi_deg"] + 180.0 * (x - 1.0)
    elif mode == "position":
        share = amounts["lambda1"]
        amounts["lambda1"] = np.where(share < 0.5, x * share, 1.0 - (2.0 - x) * (1.0 - share))
    else:
        acted_on = {
            "length": ("length",) if kind == "rotation_extrude" else ("rho", "z"),
            "height": ("z",), "sideways": ("rho",), "width": ("width",), "size": ("sigma",), "angle": ("alpha_deg",),
        }  # fmt: skip
        for name in acted_on[mode]:
            amounts[name] = amounts[name] * x


def _moved(operation: Any, mesh: ControlMesh, positions: np.ndarray, amounts: dict[str, np.ndarray]) -> np.ndarray:
    """Apply one operation; everything that it looks at is taken from before anything moves."""
    kind, before = operation.kind, positions
    targets: tuple[Target, ...] = getattr(operation, "targets", getattr(operation, "anchors", ()))
    if kind == "base":
        targets = targets or (Target((), "world"),)
    frames = _frames(mesh, before, targets)
    vertices = [mesh.vertices_of(target.elements) for target in targets]
    pivots = []
    for target, moved in zip(targets, vertices, strict=True):
        shared = (operation.pivot,) if getattr(operation, "pivot", None) else ()
        hinge = mesh.vertices_of(target.pivot or shared) or moved
        pivots.append(before[hinge].mean(axis=0) if hinge else np.zeros((3, before.shape[2])))
    if kind == "rotation_extrude":
        old, (start, end) = mesh.face(operation.face.id), mesh.edge(operation.edge.id)
        if old[(old.index(start) + 1) % len(old)] != end:
            start, end = end, start
        frames = [_frame_of(before, FrameSource((old,), (start, end)))]
    if kind == "insert_vertex":
        ends = []
        for edge, backwards in operation.edges:
            start, end = mesh.edge(edge.id)
            middle, _ = mesh.split_edge(edge.id)
            ends.append((middle, *((end, start) if backwards else (start, end))))
    else:
        operation.apply(mesh)
    positions = np.concatenate([before, np.zeros((mesh.n_vertices - len(before), 3, before.shape[2]))])
    if kind in ("drag", "extrude"):
        phi = np.radians(amounts["phi_deg"])
        way = np.stack([amounts["rho"] * np.cos(phi), amounts["rho"] * np.sin(phi), amounts["z"]])
    for number, target in enumerate(targets):
        frame, pivot, moved = frames[number], pivots[number], vertices[number]
        if kind == "base":
            points, _ = operation._shape()
            first = len(before) + len(points) * number
            positions[first : first + len(points)] = (
                np.einsum("ijb,nj->nib", frame, points + np.array(operation.offset)) + pivot
            )
        elif kind == "drag":
            positions[moved] += np.einsum("ijb,jb->ib", frame, way)
        elif kind == "extrude":
            new = mesh.face(target.elements[0].id)
            positions[list(new)] = before[moved] + np.einsum("ijb,jb->ib", frame, way)
        else:
            local = np.einsum("jib,njb->nib", frame, positions[moved] - pivot)
            if kind == "scale":
                for axis in operation.axes:
                    local[:, "uvz".index(axis)] *= amounts["sigma"]
            else:
                alpha, axis = np.radians(amounts["alpha_deg"]), "uvz".index(operation.axis)
                first, second = local[:, (axis + 1) % 3].copy(), local[:, (axis + 2) % 3].copy()
                local[:, (axis + 1) % 3] = np.cos(alpha) * first - np.sin(alpha) * second
                local[:, (axis + 2) % 3] = np.sin(alpha) * first + np.cos(alpha) * second
            positions[moved] = pivot + np.einsum("ijb,njb->nib", frame, local)
    if kind == "rotation_extrude":
        frame, centre = frames[0], before[list(old)].mean(axis=0)
        x, y, z = np.einsum("jib,njb->inb", frame, before[list(old)] - centre)
        turn, half = np.radians(operation.angle_deg), np.radians(operation.angle_deg) / 2
        y = y * amounts["width"]
        turned = np.stack([x, np.cos(turn) * y - np.sin(turn) * z, np.sin(turn) * y + np.cos(turn) * z])
        turned[1] -= np.sin(half) * amounts["length"]
        turned[2] += np.cos(half) * amounts["length"]
        positions[list(mesh.face(operation.face.id))] = centre + np.einsum("ijb,jnb->nib", frame, turned)
    if kind == "insert_vertex":
        for middle, start, end in ends:
            share = amounts["lambda1"]
            positions[middle] = share * positions[start] + (1.0 - share) * positions[end]
    return positions


def _frames(mesh: ControlMesh, positions: np.ndarray, targets: tuple[Target, ...]) -> list[np.ndarray]:
    frames: list[np.ndarray] = []
    world = np.repeat(np.eye(3)[:, :, None], positions.shape[2], axis=2)
    for target in targets:
        element: Element | None = target.elements[0] if target.frame == "own" and target.elements else None
        element = target.frame if isinstance(target.frame, Element) else element
        source = frame_of_element(mesh, element) if element else None
        frame = _frame_of(positions, source) if isinstance(source, FrameSource) else world
        if target.image:
            frame = np.einsum("ij,jkb->ikb", image_matrix(target.image), frames[0] if frames else world)
        frames.append(frame)
    return frames


def _frame_of(positions: np.ndarray, source: FrameSource) -> np.ndarray:
    """Return the axes (3, 3, B) as columns."""
    total = np.zeros((3, positions.shape[2]))
    for loop in source.loops:
        spokes = positions[list(loop)] - positions[loop[0]]
        area = np.cross(spokes, np.roll(spokes, -1, axis=0), axis=1).sum(axis=0)
        length, size = np.linalg.norm(area, axis=0), (spokes**2).sum(axis=1).max(axis=0)
        has_direction = length > np.maximum(1e-9 * size, 1e-24)
        total += np.where(has_direction, area / np.where(has_direction, length, 1.0), 0.0)
    length = np.linalg.norm(total, axis=0)
    z = np.where(length > 1e-12, total / np.where(length > 1e-12, length, 1.0), np.array([[0.0], [0.0], [1.0]]))
    along = positions[source.first_edge[1]] - positions[source.first_edge[0]]
    u = along - (along * z).sum(axis=0) * z
    axis = np.eye(3)[np.argmin(np.abs(z), axis=0)].T
    is_along = (u**2).sum(axis=0) <= 1e-12 * np.maximum((along**2).sum(axis=0), 1e-24)
    u = np.where(is_along, axis - (axis * z).sum(axis=0) * z, u)
    u = u / np.linalg.norm(u, axis=0)
    return np.stack([u, np.cross(z, u, axis=0), z], axis=1)


def _draw_absent_parts_together(
    model: ProceduralModel, settled: np.ndarray, mesh: ControlMesh, positions: np.ndarray
) -> None:
    in_parts = {component.id for part in model.parts for component in part.components}
    homes = (mesh.vertices_of_component(c) for c in range(mesh.n_components) if c not in in_parts)
    home = next(vertices for vertices in homes if vertices)
    for part in model.parts:
        vertices = mesh.vertices_of(part.components)
        for b, row in enumerate(settled):
            if not _hold(model, part.present_when, row):
                positions[vertices, :, b] = positions[home, :, b].mean(axis=0)
