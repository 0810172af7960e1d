"""What a query says beside its mesh, and how an estimation keeps to it."""

import numpy as np
import pytest
from ell_generator import EllGenerator

from shapewright.distances.alignment import AlignmentSettings, Pose, rotations_24
from shapewright.errors import EstimationError
from shapewright.estimation import Estimation, EstimationSettings, Query, estimate
from shapewright.estimation.query import AXES, UNITS, axis_vector

COARSE = EstimationSettings(
    samples=40,
    surface_points=150,
    image_size=32,
    model_points="vertices",
    step_sizes=(0.5, 0.1, 0.02),
    alignment=AlignmentSettings(0.05, 0.05 * np.pi, 0.05),
    estimator="reference",
)
TRUTH = np.array([1.3, 0.8])
TURN = Pose(rotations_24()[14], np.array([40.0, -3.0, 12.0]), 0.1)
"""The model's coordinates are millimeters, those of the file centimeters."""


@pytest.fixture(scope="module")
def generator() -> EllGenerator:
    return EllGenerator("length", "height")


@pytest.fixture(scope="module")
def of_known_unit(generator: EllGenerator) -> Estimation:
    return estimate(Query(generator.mesh(TRUTH, TURN), units="cm"), generator, COARSE)


def test_with_a_known_unit_the_scale_is_known_and_lengths_are_in_it(of_known_unit: Estimation) -> None:
    assert all(stage.pose.scale == pytest.approx(0.1) for stage in of_known_unit.stages)
    np.testing.assert_allclose(of_known_unit.values, TRUTH, atol=0.1)
    length = of_known_unit.parameters[0]
    assert (length.unit, length.base_value) == ("cm", pytest.approx(1.0))
    assert length.displayed_value == pytest.approx(of_known_unit.values[0])


def test_without_a_unit_lengths_are_those_of_the_model(generator: EllGenerator) -> None:
    rigid = EllGenerator()
    assert estimate(rigid.mesh(np.empty(0)), rigid, COARSE).parameters == ()
    query = Query(generator.mesh(TRUTH, TURN))
    assert query.scale_of(generator.model.unit_m) is None
    assert Query(query.mesh, units="cm").scale_of(None) is None
    assert Query(query.mesh, units="in").scale_of(0.0254) == pytest.approx(1.0)


@pytest.mark.parametrize("axis", AXES)
def test_an_up_axis_leaves_four_of_the_rotations(generator: EllGenerator, axis: str) -> None:
    query = Query(generator.mesh(TRUTH), up=axis)
    allowed = [rotation for rotation in rotations_24() if query.allows(rotation)]
    assert len(allowed) == 4
    for rotation in allowed:
        np.testing.assert_allclose(rotation @ [0, 0, 1], axis_vector(axis), atol=1e-12)


def test_a_known_rotation_is_where_the_search_begins(generator: EllGenerator) -> None:
    reports: list[str] = []

    class Listening:
        def report(self, fraction: float, message: str) -> None:
            reports.append(message)

    query = Query(generator.mesh(TRUTH, TURN), rotation=TURN.rotation)
    found = estimate(query, generator, COARSE, progress=Listening())
    np.testing.assert_allclose(found.pose.rotation, TURN.rotation, atol=0.2)
    assert any("orientation 1 of 1" in message for message in reports)


def test_contradictions_and_unknown_words_are_refused(generator: EllGenerator) -> None:
    mesh = generator.mesh(TRUTH)
    assert set(UNITS) == {"mm", "cm", "m", "in"}
    Query(mesh, up="+z", rotation=np.eye(3))
    with pytest.raises(EstimationError, match="does not take") as caught:
        Query(mesh, up="-y", rotation=np.eye(3))
    assert caught.value.where == "rotation"
    with pytest.raises(EstimationError, match="proper rotation"):
        Query(mesh, rotation=np.diag([1.0, 1.0, -1.0]))
