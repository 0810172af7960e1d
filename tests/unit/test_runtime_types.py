"""The tests check the library's types and shapes at run time; this tests that they really do."""

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from shapewright.distances.alignment import Pose
from shapewright.mesh.file import load_mesh
from shapewright.modeling import Condition
from shapewright.training.calibration import calibration_error


def test_shapes_that_do_not_agree_are_noticed() -> None:
    with pytest.raises(TypeCheckError, match="right"):
        calibration_error(np.full(3, 0.5), np.ones(4, dtype=bool))


def test_a_wrong_type_is_noticed() -> None:
    with pytest.raises(TypeCheckError, match="confidence"):
        calibration_error([0.5], np.ones(1, dtype=bool))  # type: ignore[arg-type]


def test_a_wrong_type_is_noticed_where_there_are_no_arrays() -> None:
    with pytest.raises(TypeCheckError, match="path"):
        load_mesh(3)  # type: ignore[arg-type]


def test_the_fields_of_values_are_checked() -> None:
    with pytest.raises(TypeCheckError, match="minimum"):
        Condition("back", minimum="low", maximum=1.0)  # type: ignore[arg-type]
    with pytest.raises(TypeCheckError, match="rotation"):
        Pose(np.eye(2), np.zeros(3), 1.0)


def test_an_int_may_stand_for_a_float() -> None:
    assert Condition("back", minimum=0, maximum=1).maximum == 1
