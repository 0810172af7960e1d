"""The tests check the library's types and shapes at run time; this tests that they really do."""

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from shapewright.training.calibration import calibration_error


def test_shapes_that_do_not_agree_are_noticed() -> None:
    with pytest.raises(TypeCheckError, match="right"):
        calibration_error(np.full(3, 0.5), np.ones(4, dtype=bool))


def test_a_wrong_type_is_noticed() -> None:
    with pytest.raises(TypeCheckError, match="confidence"):
        calibration_error([0.5], np.ones(1, dtype=bool))  # type: ignore[arg-type]
