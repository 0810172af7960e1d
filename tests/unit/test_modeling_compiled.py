"""How a compiled model evaluates: as the definitions say, whatever is done ahead, together or not at all."""

import numpy as np
import pytest
from chair_model import armchair
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from literal_evaluation import literal_control_points, literal_settled
from random_models import Recipe, recipes
from scipy import sparse

from shapewright.errors import ModelError
from shapewright.modeling import CompiledModel, ProceduralModel, Recorder, compile_model, executable, when

few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def assert_literal(made: CompiledModel, values: np.ndarray) -> None:
    settled = made.settle(values)
    literal = literal_control_points(made.model, settled)
    scale = max(1.0, float(np.abs(literal).max(initial=0.0)))
    np.testing.assert_allclose(made.control_points(values), literal, rtol=0.0, atol=1e-12 * scale)


def evaluated_step_by_step(model: ProceduralModel, values: np.ndarray) -> np.ndarray:
    """Evaluate with nothing done ahead and nothing skipped."""
    with pytest.MonkeyPatch.context() as patch:
        everything = np.int64(-1)
        patch.setattr(executable, "_split", lambda instructions, n_rows: ([], list(instructions)))
        patch.setattr(executable, "_guarded", lambda written, *_: (written, [everything] * len(written)))
        return CompiledModel(model).control_points(values)


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_random_models_are_what_their_definitions_say(recipe: Recipe, seed: int) -> None:
    made = compile_model(recipe.build())
    rng = np.random.default_rng(seed)
    wild = rng.normal(1.0, 2.0, (4, made.n_parameters))
    for row, settled in zip(wild, made.settle(wild), strict=True):
        np.testing.assert_array_equal(settled, literal_settled(made.model, row))
    assert_literal(made, np.concatenate([made.random_values(rng, 3), wild]))


def test_shipped_models_are_what_their_definitions_say(library_models: dict[str, ProceduralModel]) -> None:
    rng = np.random.default_rng(0)
    one_of_each_class = {model.class_name: model for model in library_models.values()}
    for model in (*one_of_each_class.values(), library_models["helicopter_attack"]):
        made = compile_model(model)
        wild = rng.normal(1.0, 2.0, (20, made.n_parameters))
        np.testing.assert_array_equal(made.settle(wild), [literal_settled(model, row) for row in wild])
        assert_literal(made, np.stack([*made.random_values(rng, 2), made.minimum, made.maximum]))


def test_a_row_of_a_batch_is_the_instance_of_its_values_alone_to_the_last_bit(
    library_models: dict[str, ProceduralModel],
) -> None:
    for name in ("helicopter_attack", "spider_scorpion", "office_chair"):
        made = compile_model(library_models[name])
        values = np.concatenate([made.random_values(np.random.default_rng(1), 19), made.base_values()[None]])
        batch, surface = made.control_points(values), made.surface_points(values)
        for row, points, refined in zip(values, batch, surface, strict=True):
            np.testing.assert_array_equal(made.control_points(row[None])[0], points)
            np.testing.assert_array_equal(made.surface_points(row[None])[0], refined)
        np.testing.assert_array_equal(made.control_points(values[3:14]), batch[3:14])


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_what_is_done_ahead_or_skipped_changes_nothing(recipe: Recipe, seed: int) -> None:
    model = recipe.build()
    made = compile_model(model)
    values = made.random_values(np.random.default_rng(seed), 5)
    np.testing.assert_array_equal(made.control_points(values), evaluated_step_by_step(model, values))


def test_so_it_is_for_models_with_parts(library_models: dict[str, ProceduralModel]) -> None:
    for model in (armchair(), library_models["helicopter_attack"], library_models["gun_rifle"]):
        made = compile_model(model)
        values = made.random_values(np.random.default_rng(0), 30)
        np.testing.assert_array_equal(made.control_points(values), evaluated_step_by_step(model, values))


def test_more_parts_than_a_guard_has_bits_are_drawn_together_too() -> None:
    recorder = Recorder("many", "many")
    recorder.parameter("size", "Size", 0.5, 2.0)
    recorder.box(1.0, 1.0, 1.0)
    for i in range(70):
        recorder.switch(f"part{i}", "Part")
        made = recorder.box(0.1, 0.1, 0.1, offset=(float(i), 0.0, 0.0))
        recorder.scale(made.whole, 1.0, size="size")
        recorder.part(f"part {i}", [made], [when(f"part{i}", 1)])
    compiled = compile_model(recorder.build())
    values = compiled.random_values(np.random.default_rng(0), 12)
    assert_literal(compiled, values)
    assert_literal(compiled, np.where(np.arange(71) == 0, values, 0.0))


def test_a_face_that_collapses_in_some_instances_only_has_the_axes_of_the_world_there() -> None:
    recorder = Recorder("spike", "spike")
    recorder.parameter("size", "Size", 0.0, 2.0)
    box = recorder.box(1.0, 1.0, 1.0)
    side = box.sides[0]
    recorder.scale(side, 1.0, size="size")
    recorder.extrude(side, 0.5, 0.25, 30.0)
    recorder.rotate(side, 20.0, "u")
    made = compile_model(recorder.build())
    values = np.array([[0.0], [1.0], [1e-13], [1e-3], [0.5], [0.0], [2.0], [1.0], [0.0]])
    assert_literal(made, values)
    assert np.isfinite(made.surface_points(values)).all()
    tip = made.control_points(values)[0, 8:]
    np.testing.assert_allclose(np.ptp(tip, axis=0), 0.0, atol=1e-15)
    assert tip[0, 2] == pytest.approx(1.0)


@pytest.mark.parametrize("steps", [0, 1, 2, 3])
def test_one_matrix_makes_the_surface_of_control_points(steps: int) -> None:
    made = compile_model(armchair())
    values = made.random_values(np.random.default_rng(3), 5)
    matrix = made.surface_matrix(steps)
    np.testing.assert_allclose(matrix.sum(axis=1), 1.0, atol=1e-12)
    for points, surface in zip(made.control_points(values), made.surface_points(values, steps), strict=True):
        np.testing.assert_allclose(matrix @ points, surface, atol=1e-12)


def test_points_at_fixed_places_are_those_of_the_surface(monkeypatch: pytest.MonkeyPatch) -> None:
    made = compile_model(armchair())
    values = made.random_values(np.random.default_rng(4), 21)
    triangles = made.surface_triangles(1)
    weights = np.full(triangles.size, 1.0 / 3.0)
    middles = sparse.csr_array((weights, (np.repeat(np.arange(len(triangles)), 3), triangles.ravel())))
    expected = made.surface_points(values, 1)[:, triangles].mean(axis=2)
    matrix = middles @ made.surface_matrix(1)
    np.testing.assert_allclose(made.combined_points(values, matrix), expected, atol=1e-12)
    monkeypatch.setattr("shapewright.modeling.compiled._CHUNK_BYTES", 5 * expected[0].nbytes)
    np.testing.assert_allclose(made.combined_points(values, matrix), expected, atol=1e-12)
    with pytest.raises(ModelError, match="expected a matrix of"):
        made.combined_points(values, middles)


def test_a_matrix_that_would_fill_the_memory_is_refused_and_the_surface_made_without_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recorder = Recorder("corners", "corners")
    recorder.base("prism", (1.0, 1.0, 1.0), sides=100)
    made = compile_model(recorder.build())
    monkeypatch.setattr("shapewright.modeling.surface_levels.MAX_SURFACE_WEIGHTS", 50_000)
    assert np.isfinite(made.surface_points(np.ones((1, 0)), 2)).all()
    with pytest.raises(ModelError, match="too many corners for a matrix"):
        made.surface_matrix(2)


def test_instances_are_those_of_one_by_one_without_sharing_arrays() -> None:
    made = compile_model(armchair())
    values = made.random_values(np.random.default_rng(1), 12)
    for row, instance in zip(values, list(made.instances(values)), strict=True):
        alone = made.instance(row)
        np.testing.assert_array_equal(instance.vertices, alone.vertices)
        np.testing.assert_array_equal(instance.faces, alone.faces)


def test_fixed_values_stay_and_what_depends_on_them_is_drawn() -> None:
    made = compile_model(armchair())
    columns = made.space.columns
    drawn = made.random_values(np.random.default_rng(2), 200, {"armrests": 1.0, "ring_height": 1.4})
    np.testing.assert_array_equal(made.settle(drawn), drawn)
    assert (drawn[:, columns["armrests"]] == 1.0).all()
    assert np.ptp(drawn[:, columns["arm_height"]]) > 1.0
    room = 0.25 + 0.75 * drawn[:, columns["leg_length"]]
    np.testing.assert_allclose(drawn[:, columns["ring_height"]], np.minimum(1.4, room))


def test_empty_batches_have_their_shape() -> None:
    made = compile_model(armchair())
    none = np.zeros((0, made.n_parameters))
    n_controls = len(made.control_vertex_ids)
    assert made.control_points(none).shape == (0, n_controls, 3)
    assert made.surface_points(none, 1).shape == (0, made.surface_polygons(1).n_vertices, 3)
    assert made.settle(none).shape == none.shape
