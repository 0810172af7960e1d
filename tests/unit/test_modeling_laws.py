"""Laws that hold for every procedural model, checked on random ones."""

from dataclasses import replace

import numpy as np
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_models import Recipe, recipes

from shapewright.modeling import CompiledModel, ProceduralModel, compile_model
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.subdivision import subdivide

few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def topology(model: ProceduralModel) -> tuple[dict[int, tuple[int, ...]], dict[int, tuple[int, int]], set[int]]:
    mesh = ControlMesh()
    for operation in model.operations:
        operation.apply(mesh)
    return mesh.faces, mesh.edges, mesh.sharp_edges


@few
@given(recipes())
def test_a_document_replays_to_the_same_model_ids_and_mesh(recipe: Recipe) -> None:
    model = recipe.build()
    model = recipe.build()
    again = ProceduralModel.from_json(model.to_json())
    assert again == model
    assert again.digest == model.digest
    assert topology(again) == topology(model)
    ones = np.ones((1, len(model.parameters)))
    np.testing.assert_array_equal(compile_model(model).control_points(ones), compile_model(again).control_points(ones))


@few
@given(recipes())
def test_ones_give_the_base_model(recipe: Recipe) -> None:
    model = recipe.build()
    bare = compile_model(replace(model, parameters=(), parts=()))
    compiled = compile_model(model)
    base, ones = bare.surface_points(np.ones((1, 0))), compiled.surface_points(compiled.base_values()[None])
    np.testing.assert_allclose(ones, base, atol=1e-12)


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_a_batch_equals_one_by_one(recipe: Recipe, seed: int) -> None:
    model = recipe.build()
    compiled = compile_model(model)
    values = compiled.random_values(np.random.default_rng(seed), 5)
    batch = compiled.surface_points(values)
    for row, points in zip(values, batch, strict=True):
        np.testing.assert_allclose(compiled.surface_points(row[None])[0], points, atol=1e-9)
    controls = compiled.control_points(values)
    for row, points in zip(values, controls, strict=True):
        np.testing.assert_allclose(compiled.control_points(row[None])[0], points, atol=1e-9)


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_instances_are_finite_and_keep_a_closed_manifold_topology(recipe: Recipe, seed: int) -> None:
    compiled = compile_model(recipe.build())
    assert compiled.is_closed
    points = compiled.surface_points(compiled.random_values(np.random.default_rng(seed), 3))
    assert np.isfinite(points).all()
    surface = trimesh.Trimesh(points[0], compiled.surface_triangles(), process=False)
    assert surface.is_watertight
    assert surface.is_winding_consistent
    assert set(np.unique(compiled.surface_triangles())) == set(range(points.shape[1]))


@few
@given(recipes())
def test_every_parameter_moves_something(recipe: Recipe) -> None:
    model = recipe.build()
    compiled = compile_model(model)
    for column, parameter in enumerate(model.parameters):
        if parameter.options or any(_vanishes(compiled, target.operation) for target in parameter.targets):
            continue
        values = np.ones((2, compiled.n_parameters))
        values[1, column] = parameter.minimum
        base, varied = compiled.control_points(values)
        assert np.abs(base - varied).max() > 1e-6


def _vanishes(compiled: CompiledModel, operation: int) -> bool:
    """An operation may have moved only vertices that a later one removed."""
    return any(op.kind == "remove" for op in compiled.model.operations[operation:])


@few
@given(recipes())
def test_a_face_stays_a_face_under_subdivision(recipe: Recipe) -> None:
    polygons = compile_model(recipe.build()).surface_polygons(0)
    step = subdivide(polygons)
    quads = iter(step.refined.loops)
    n_edges = step.refined.n_vertices - polygons.n_vertices - len(polygons.loops)
    for index, loop in enumerate(polygons.loops):
        patch = [next(quads) for _ in loop]
        assert {quad[0] for quad in patch} == set(loop)
        assert {quad[2] for quad in patch} == {polygons.n_vertices + n_edges + index}


@few
@given(recipes())
def test_subdivision_weights_sum_to_one_and_ids_come_first(recipe: Recipe) -> None:
    polygons = compile_model(recipe.build()).surface_polygons(0)
    step = subdivide(polygons)
    np.testing.assert_allclose(step.matrix.sum(axis=1), 1.0)
    assert step.matrix.shape == (step.refined.n_vertices, polygons.n_vertices)
    assert subdivide(step.refined).refined.n_vertices > step.refined.n_vertices
