"""Jacobians of shipped and small models by finite differences, in units of the half extent, as estimators make them."""

from dataclasses import dataclass

import numpy as np
import trimesh

from shapewright.estimation.determination.determine import continuous_columns
from shapewright.estimation.determination.information import pose_columns
from shapewright.estimation.residuals import even_points
from shapewright.mesh import TriangleMesh

STEP = 1e-4


@dataclass(frozen=True)
class Linearized:
    """A model at values: what :func:`determine` takes."""

    parameters: tuple
    values: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    active: np.ndarray
    jacobian: np.ndarray

    def arguments(self):
        return self.parameters, self.values, self.lowest, self.highest, self.active, self.jacobian


def linearized(compiled, values, *, points=1500, visible=None) -> Linearized:
    """Differentiate the instance of settled values; ``visible`` chooses points by their place."""
    values = compiled.settle(np.asarray(values, dtype=float)[None])[0]
    faces = compiled.surface_triangles(1)
    base = TriangleMesh(compiled.surface_points(values[None], 1)[0], faces)
    extent = np.ptp(base.vertices, axis=0).max() / 2
    places, numbers = even_points(base, points)
    weights = trimesh.triangles.points_to_barycentric(base.triangles[numbers], places)
    normals = base.face_normals[numbers]
    if visible is not None:
        kept = visible(places)
        places, numbers, weights, normals = places[kept], numbers[kept], weights[kept], normals[kept]
    lowest, highest = compiled.space.ranges(values[None])
    active = compiled.space.active(values[None])[0]
    columns = []
    for column in continuous_columns(compiled.model.parameters, active):
        step = STEP * (highest[0, column] - lowest[0, column])
        step = -step if values[column] + step > highest[0, column] else step
        changed = values.copy()
        changed[column] += step
        moved = compiled.surface_points(changed[None], 1)[0][faces[numbers]]
        places_moved = np.einsum("nk,nkd->nd", weights, moved - base.triangles[numbers])
        columns.append(np.einsum("nd,nd->n", places_moved, normals) / (step * extent))
    pose = pose_columns(places / extent, normals)
    jacobian = np.concatenate([np.array(columns).reshape(len(columns), len(places)).T, pose], axis=1)
    return Linearized(compiled.model.parameters, values, lowest[0], highest[0], active, jacobian)
