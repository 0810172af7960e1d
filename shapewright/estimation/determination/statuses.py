"""The status of each parameter: whether the query determines it."""

from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from shapewright.estimation.determination.information import Information
from shapewright.estimation.result import ParameterStatus

CHANGE: Final = 0.1
"""Share of a range whose effect is looked at: from 5 % below a value to 5 % above it."""
LEAST_EFFECT: Final = 5e-4
"""Root mean square movement of the surface, in half extents, that makes such a change count as determined."""
WIDEST: Final = 0.05
"""Half width of an interval, as a share of the range, above which the residual leaves nothing determined."""
WIDEST_AT_END: Final = 0.1
"""The same for a value at an end of its range: the residual that this leaves widens its interval."""
AT_END: Final = 1e-3
"""A value nearer to an end than this share of the range is at the end."""
END_PUSH: Final = 5e-3
"""Share of the range that a value at an end must want to move beyond it."""


def judge(
    information: Information,
    values: Float[np.ndarray, " A"],
    lowest: Float[np.ndarray, " A"],
    highest: Float[np.ndarray, " A"],
    deviation: float,
    gradient: Float[np.ndarray, " A"] | None = None,
) -> tuple[ParameterStatus, ...]:
    """Return the status of each active continuous parameter.

    A parameter is determined if the surfaces at 5 % of its range below and above its value differ by more than 5e-4 of
    the half extent with all else refitted, and if the residual leaves its interval narrow; up to scale, if that is so
    once the scale is known; and at the end of its range, if the query pulls it beyond and says so nearly as surely.

    Args:
        information: about the parameters in this order.
        values: x.
        lowest: ends of the ranges at these values.
        highest: the other ends.
        deviation: what the square root of a variance is multiplied by to give half of an interval.
        gradient: of half the mean squared residual by x, at the fit; without it no value is at an end.
    """
    determined = is_determined(information.effects, deviation)
    up_to_scale = is_determined(information.with_known_scale().effects, deviation)
    beyond = np.zeros(len(values), dtype=bool)
    if gradient is not None:
        step = -(gradient * information.ranges) / information.effects**2  # shares of the range; all else is at its best
        near = AT_END * information.ranges
        pulled = ((values <= lowest + near) & (step < -END_PUSH)) | ((values >= highest - near) & (step > END_PUSH))
        beyond = pulled & is_determined(information.with_known_scale().effects, deviation, WIDEST_AT_END)
    statuses: list[ParameterStatus] = []
    for i in range(len(values)):
        if beyond[i]:
            statuses.append("at_range_end")
        elif not up_to_scale[i]:
            statuses.append("not_determined")
        else:
            statuses.append("determined" if determined[i] else "determined_up_to_scale")
    return tuple(statuses)


def is_determined(effects: Float[np.ndarray, " K"], deviation: float, widest: float = WIDEST) -> Bool[np.ndarray, " K"]:
    """Tell which effects of a whole range are large enough to determine what has the range."""
    return np.asarray((CHANGE * effects > LEAST_EFFECT) & (deviation <= widest * effects))
