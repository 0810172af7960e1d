"""Poses, the 24 rotations and the greedy realignment."""

import numpy as np
import pytest
from ell_generator import EllGenerator
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import AlignmentSettings, Pose, realign, rotations_24
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.errors import Cancelled, EstimationError

POINTS = np.random.default_rng(5).normal(size=(20, 3))

poses = st.builds(
    lambda vector, shift, scale: Pose(Rotation.from_rotvec(vector).as_matrix(), np.array(shift), scale),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.tuples(*[st.floats(-10, 10)] * 3),
    st.floats(0.1, 10),
)


@settings(max_examples=50, deadline=None)
@given(poses, poses, poses)
def test_poses_compose_like_functions_and_are_a_group(a: Pose, b: Pose, c: Pose) -> None:
    close = {"atol": 1e-7, "rtol": 1e-9}
    np.testing.assert_allclose(a.compose(b).apply(POINTS), a.apply(b.apply(POINTS)), **close)
    left, right = a.compose(b).compose(c), a.compose(b.compose(c))
    np.testing.assert_allclose(left.apply(POINTS), right.apply(POINTS), **close)
    for undone in (a.compose(a.inverse()), a.inverse().compose(a)):
        np.testing.assert_allclose(undone.apply(POINTS), POINTS, **close)
    np.testing.assert_array_equal(Pose().compose(a).apply(POINTS), a.apply(POINTS))


def test_pose_is_scale_times_rotation_plus_translation() -> None:
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    pose = Pose(quarter, np.array([1.0, 2.0, 3.0]), 2.0)
    np.testing.assert_allclose(pose.apply(np.array([[1.0, 0.0, 0.5]])), [[1.0, 4.0, 4.0]])
    assert pose.to_dict() == {"rotation": quarter.tolist(), "translation": [1.0, 2.0, 3.0], "scale": 2.0}


@pytest.mark.parametrize(
    ("parts", "match"),
    [
        ({"rotation": np.diag([1.0, 1.0, -1.0])}, "proper rotation"),
        ({"rotation": 2 * np.eye(3)}, "proper rotation"),
        ({"translation": np.array([0.0, np.nan, 0.0])}, "NaN"),
        ({"scale": 0.0}, "positive"),
        ({"scale": -1.0}, "positive"),
    ],
)
def test_what_is_no_pose_is_refused(parts, match: str) -> None:
    with pytest.raises(EstimationError, match=match):
        Pose(**parts)


def test_the_24_rotations_are_the_group_of_the_cube() -> None:
    rotations = rotations_24()
    assert rotations.shape == (24, 3, 3)
    np.testing.assert_array_equal(rotations[0], np.eye(3))
    keys = {tuple(rotation.astype(int).ravel()) for rotation in rotations}
    assert len(keys) == 24
    np.testing.assert_array_equal(np.linalg.det(rotations).round(12), 1.0)
    for a in rotations:
        np.testing.assert_array_equal(a @ a.T, np.eye(3))
        assert {tuple((a @ b).astype(int).ravel()) for b in rotations} == keys
    targets = rotations[:, :, 0]  # where the x-axis goes: each of 6 directions, 4 times
    assert {tuple(row) for row in targets.tolist()} == {tuple(row) for row in (*np.eye(3), *-np.eye(3))}
    assert all((targets == target).all(axis=1).sum() == 4 for target in targets)


def test_realignment_undoes_a_small_misplacement() -> None:
    mesh = EllGenerator().mesh(np.empty(0)).normalized().mesh
    target = ZBufferTarget(mesh.vertices, mesh.faces)
    misplacement = Pose(Rotation.from_rotvec([0.15, -0.1, 0.2]).as_matrix(), np.array([0.08, -0.05, 0.06]), 0.9)
    points = misplacement.apply(mesh.vertices)

    def distance(posed: np.ndarray) -> float:
        return target.distance(posed, mesh.faces).normalized

    end = realign(points, distance, Pose())
    assert end.distance < 0.1 * distance(points)
    assert end.distance == distance(end.pose.apply(points))
    np.testing.assert_allclose(end.pose.compose(misplacement).apply(mesh.vertices), mesh.vertices, atol=0.04)


def test_realignment_ends_where_no_single_step_helps_and_never_gets_worse() -> None:
    rng = np.random.default_rng(2)
    goal = rng.normal(size=(20, 3))
    seen: list[float] = []

    def distance(posed: np.ndarray) -> float:
        seen.append(float(np.abs(posed - goal).mean()))
        return seen[-1]

    end = realign(POINTS, distance, Pose())
    assert end.distance == pytest.approx(min(seen), rel=1e-9)
    assert end.probes == len(seen)
    assert len(seen) > 14
    again = realign(POINTS, distance, end.pose, original_scale=1.0)
    assert again.pose is end.pose


def test_scale_stays_within_its_limits_of_the_original() -> None:
    limits = AlignmentSettings(scale_limits=(0.8, 1.25))
    for direction, limit in ((-1.0, 1.25), (1.0, 0.8)):

        def size(posed: np.ndarray, direction: float = direction) -> float:
            return direction * float(np.linalg.norm(posed - posed.mean(axis=0)))

        end = realign(POINTS, size, Pose(scale=4.0), limits)
        assert end.pose.scale / 4.0 == pytest.approx(limit, abs=1e-9)


def test_turning_and_scaling_keep_the_mean_of_the_points() -> None:
    points = POINTS + 7.0
    pose = Pose(translation=np.array([1.0, 2.0, 3.0]))
    mean = pose.apply(points).mean(axis=0)
    seen: list[np.ndarray] = []

    def record(posed: np.ndarray) -> float:
        seen.append(posed.mean(axis=0))
        return 0.0

    realign(points, record, pose)
    np.testing.assert_allclose(seen[7:], np.broadcast_to(mean, (8, 3)), atol=1e-12)
    np.testing.assert_allclose(np.abs(np.array(seen[1:7]) - mean).sum(axis=1), 0.01)


def test_realignment_can_be_stopped_at_every_round() -> None:
    rounds = []

    def checkpoint() -> None:
        rounds.append(1)
        if len(rounds) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        realign(POINTS, lambda posed: float(posed[:, 0].mean()), Pose(), checkpoint=checkpoint)


@pytest.mark.parametrize(
    ("setting", "where"),
    [
        ({"translation_step": 0.0}, "translation_step"),
        ({"rotation_step_rad": -1.0}, "rotation_step_rad"),
        ({"scale_step": float("nan")}, "scale_step"),
        ({"scale_limits": (1.1, 1.5)}, "scale_limits"),
        ({"scale_limits": (0.0, 1.5)}, "scale_limits"),
    ],
)
def test_settings_out_of_range_are_refused(setting, where: str) -> None:
    with pytest.raises(EstimationError) as caught:
        AlignmentSettings(**setting)
    assert caught.value.where == where
