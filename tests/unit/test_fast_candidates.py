"""Candidates of the search: samples of their instances, steps, and other choices of their options."""

import numpy as np
import pytest
from chair_model import armchair
from fast_support import angle_deg, candidate_at, lever, placed, random_pose, rigid, signs, target_of
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.estimation.fast.branches import DRAWS, other_choices, other_poses
from shapewright.estimation.fast.fitted_model import COARSE, FINE, FittedModel
from shapewright.modeling import Recorder, compile_model

CENTER = np.array([0.2, -0.1, 0.3])


@pytest.fixture(scope="module")
def chair() -> FittedModel:
    return FittedModel(compile_model(armchair()))


@pytest.mark.parametrize("steps", [COARSE, FINE])
def test_samples_are_linear_in_the_control_points_and_lie_on_the_surface(chair, steps):
    from shapewright.distances.triangles import TriangleDistance

    values = chair.compiled.random_values(np.random.default_rng(4), 2)
    first, second = chair.compiled.control_points(values)
    made, normals = chair.samples(first, 300, steps, 0.5)
    assert len(made) == 300
    np.testing.assert_allclose(made.points(np.ones_like(first)), 1.0)  # weights of each sample sum up to 1
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    on_surface = TriangleDistance(chair.compiled.instance(values[0], steps))
    assert on_surface(made.points(first)).max() < 1e-12
    middle = made.points(0.5 * first + 0.5 * second)
    np.testing.assert_allclose(middle, 0.5 * (made.points(first) + made.points(second)), atol=1e-12)


def test_parts_that_are_not_there_get_no_samples(chair):
    values = chair.settle(chair.compiled.values_from_mapping({"back": 3, "armrests": 0}))
    made, _ = chair.samples(chair.control_points(values), 400, COARSE, 0.5)
    top = made.points(chair.control_points(values))[:, 2].max()
    assert top <= 0.2 + 1e-9  # the seat's


def test_an_instance_without_area_has_no_samples(chair):
    collapsed = np.zeros_like(chair.control_points(chair.compiled.base_values()))
    assert chair.samples(collapsed, 100, FINE, 0.5) is None


def test_small_models_are_drawn_as_they_are_and_large_ones_with_fewer_triangles_of_the_same_shape():
    from models_store.library.shipped import load_shipped
    from shapewright.distances.triangles import TriangleDistance

    for compiled, drawn in ((lever(), FINE), (compile_model(load_shipped("glass_with_stem_shell")), COARSE)):
        model, values = FittedModel(compiled), compiled.base_values()
        points = model.outline.points(model.control_points(values))
        np.testing.assert_array_equal(model.outline_triangles, model.triangles[drawn])
        assert model.outline_triangles.max() < len(points)
        assert TriangleDistance(compiled.instance(values, FINE))(points).max() < 1e-12


def test_free_columns_are_active_measures_with_room(chair):
    names = [parameter.name for parameter in chair.compiled.model.parameters]
    without = chair.settle(chair.compiled.values_from_mapping({"armrests": 0}))
    columns, _, highest = chair.free_columns(without)
    assert [names[column] for column in columns] == ["leg_length", "ring_height"]
    assert highest[names.index("ring_height")] == pytest.approx(0.25 + 0.75 * without[names.index("leg_length")])
    with_arms = chair.settle(chair.compiled.values_from_mapping({"armrests": 1}))
    assert [names[column] for column in chair.free_columns(with_arms)[0]] == ["leg_length", "arm_height", "ring_height"]


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_step_and_its_opposite_lead_back(chair, seed):
    """Each kind of step by itself: rotations and shifts do not commute."""
    rng = np.random.default_rng(seed)
    values = chair.settle(np.array([1.0, 1.0, 1.0, 1.0, 0.8]))
    candidate = candidate_at(chair, values, random_pose(seed % 1000, 1.3, 0.5))
    columns = chair.free_columns(candidate.values)[0]
    count = len(columns)
    for part in (slice(0, count), slice(count, count + 3), slice(count + 3, count + 6), slice(count + 6, count + 7)):
        step = np.zeros(count + 7)
        step[part] = rng.uniform(-0.05, 0.05, len(step[part]))
        back = candidate.moved(columns, step, CENTER).moved(columns, -step, CENTER)
        np.testing.assert_allclose(back.values, candidate.values, atol=1e-12)
        np.testing.assert_allclose(back.rotation, candidate.rotation, atol=1e-12)
        np.testing.assert_allclose(back.translation, candidate.translation, atol=1e-12)
        assert back.scale == pytest.approx(candidate.scale)


def test_turns_and_growth_leave_the_center_in_place(chair):
    candidate = candidate_at(chair, chair.compiled.base_values(), random_pose(2, 1.3, 0.5))
    columns = chair.free_columns(candidate.values)[0]
    step = np.zeros(len(columns) + 7)
    step[len(columns) : len(columns) + 3] = (0.3, -0.2, 0.1)
    step[-1] = 0.4
    at_center = candidate.pose.inverse().apply(CENTER[None])
    moved = candidate.moved(columns, step, CENTER)
    np.testing.assert_allclose(moved.placed(at_center)[0], CENTER, atol=1e-12)
    assert moved.scale == pytest.approx(candidate.scale * np.exp(0.4))


def test_a_step_settles_the_values_and_forgets_what_was_measured(chair):
    from dataclasses import replace

    candidate = replace(candidate_at(chair, chair.compiled.base_values(), random_pose(0)), misfit=0.1, zbuffer=0.2)
    columns = chair.free_columns(candidate.values)[0]
    step = np.zeros(len(columns) + 7)
    step[: len(columns)] = (-0.2, 5.0, 5.0)
    moved = candidate.moved(columns, step, CENTER)
    np.testing.assert_array_equal(chair.settle(moved.values), moved.values)
    assert (moved.misfit, moved.zbuffer) == (np.inf, np.inf)
    np.testing.assert_array_equal(candidate.values, chair.compiled.base_values())


def test_placed_points_are_those_of_the_pose(chair):
    candidate = candidate_at(chair, chair.compiled.base_values(), random_pose(3, 0.7, 2.0))
    points = np.random.default_rng(0).normal(size=(10, 3))
    np.testing.assert_allclose(candidate.placed(points), candidate.pose.apply(points), atol=1e-12)


# ---------------------------------------------------------------------- options


def test_every_other_choice_is_offered_once_and_the_rest_is_inherited(chair):
    values = chair.settle(chair.compiled.values_from_mapping({"back": 2, "armrests": 0, "leg_length": 1.4}))
    candidate = candidate_at(chair, values, random_pose(1, 1.5))
    found = list(other_choices(candidate, np.random.default_rng(0)))
    once = [(1.0, 0.0), (2.0, 1.0), (3.0, 0.0)]  # and armrests, whose height is new, from random heights, too
    assert sorted(tuple(one.values[:2]) for one in found) == sorted([*once, *[(2.0, 1.0)] * DRAWS])
    for one in found:
        np.testing.assert_array_equal(one.values[[2, 4]], values[[2, 4]])
        assert one.scale == candidate.scale
        assert one.zbuffer == np.inf
    with_arms = next(one for one in found if one.values[1] == 1.0)
    assert with_arms.values[3] == 1.0  # what became active begins at its base value first
    assert len({one.values[3] for one in found if one.values[1] == 1.0}) == 1 + DRAWS


def test_a_model_without_options_has_no_other_choices():
    candidate = candidate_at(FittedModel(rigid()), np.zeros(0), random_pose(0))
    assert list(other_choices(candidate, np.random.default_rng(0))) == []


def test_models_of_options_alone_have_nothing_free():
    model = FittedModel(signs())
    candidate = candidate_at(model, model.compiled.base_values(), random_pose(0))
    assert len(model.free_columns(candidate.values)[0]) == 0
    found = other_choices(candidate, np.random.default_rng(0))
    assert sorted(tuple(one.values) for one in found) == [
        (1.0, 0.0),
        (2.0, 1.0),
        (3.0, 1.0),
    ]


# ---------------------------------------------------------------------- poses


def test_half_turns_leave_the_center_of_the_query_where_it_is_and_symmetry_prunes_them(chair):
    candidate = candidate_at(chair, chair.compiled.base_values(), random_pose(1, 1.5, 0.3))
    target = target_of(placed(chair.compiled, candidate.values, candidate.pose))
    at_center = candidate.pose.inverse().apply(target.center[None])
    found = list(other_poses(candidate, target))
    assert len(found) == 3  # a mirror is no rotation
    for one in found:
        assert angle_deg(one.rotation, candidate.rotation) == pytest.approx(180.0)
        np.testing.assert_allclose(one.placed(at_center)[0], target.center, atol=1e-9)
    recorder = Recorder("bar", "bar")
    recorder.box(1.0, 2.0, 3.0)
    recorder.symmetry(axis="z", order=2)
    bar = FittedModel(compile_model(recorder.build()))
    assert len(list(other_poses(candidate_at(bar, np.zeros(0), random_pose(1)), target))) == 2
