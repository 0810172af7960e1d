"""How a compiled model evaluates: what is the same for every instance is done once."""

import numpy as np
import pytest
from chair_model import armchair
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_models import Recipe, recipes

from shapewright.modeling import CompiledModel, ProceduralModel, compile_model, executable


def evaluated_step_by_step(model: ProceduralModel, values: np.ndarray) -> np.ndarray:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executable, "_split", lambda instructions, n_rows: ([], list(instructions)))
        patch.setattr(
            executable, "_guarded", lambda instructions, *_: (instructions, [np.int64(-1)] * len(instructions))
        )
        return CompiledModel(model).control_points(values)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(recipes(), st.integers(0, 2**32 - 1))
def test_steps_that_are_done_once_change_nothing(recipe: Recipe, seed: int) -> None:
    model = recipe.build()
    made = compile_model(model)
    values = made.random_values(np.random.default_rng(seed), 5)
    points = evaluated_step_by_step(model, values)
    scale = max(1.0, float(np.abs(points).max(initial=0.0)))
    np.testing.assert_allclose(made.control_points(values), points, atol=1e-9 * scale)


def test_so_it_is_for_a_model_with_parts() -> None:
    made = compile_model(armchair())
    values = made.random_values(np.random.default_rng(0), 20)
    np.testing.assert_allclose(made.control_points(values), evaluated_step_by_step(armchair(), values), atol=1e-12)


def test_instances_are_those_of_one_by_one_without_sharing_arrays() -> None:
    made = compile_model(armchair())
    values = made.random_values(np.random.default_rng(1), 12)
    for row, instance in zip(values, list(made.instances(values)), strict=True):
        alone = made.instance(row)
        np.testing.assert_allclose(instance.vertices, alone.vertices, atol=1e-12)
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
