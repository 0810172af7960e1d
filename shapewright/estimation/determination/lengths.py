"""Which parameters are lengths."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.estimation.determination.information import Information
from shapewright.estimation.generator import ParameterInfo

_GROWS: Final = (0.75, 1.33)


def find_lengths(
    parameters: Sequence[ParameterInfo], values: Float[np.ndarray, " A"], information: Information
) -> Bool[np.ndarray, " A"]:
    """Tell which of the parameters of an information are lengths, whose ratios mean something.

    The kind that the model declares decides. A parameter without one is a length if the model grows by growing it:
    where everything is larger by a small share, it is larger by about that share. One whose range reaches 0 or below
    has no ratios and is left out.
    """
    found = np.zeros(len(parameters), dtype=bool)
    shares = information.growth * information.ranges
    for i, parameter in enumerate(parameters):
        if not (parameter.minimum > 0 and values[i] > 0) or (parameter.base_value or 1.0) <= 0:
            continue
        if parameter.kind is not None:
            found[i] = parameter.kind == "length"
        else:
            found[i] = _GROWS[0] <= shares[i] / values[i] <= _GROWS[1]
    return found
