"""Compiled kernels of :mod:`shapewright.modeling.parameter_space`: what rows of values mean.

They share one file on purpose: numba's cache looks at the date of the file in which a kernel stands, not at those of
what it calls.
"""

from typing import Final, no_type_check

import numpy as np
from numba import njit

KEEP: Final = 0
"""Rows are settled, and stay as they are."""
SETTLE: Final = 1
"""Rows are moved into their ranges, options rounded."""
DRAW: Final = 2
"""Rows hold shares in [0, 1), which become values in the ranges of their parameters."""


@njit(cache=True, nogil=True)
@no_type_check
def walk(
    how, values, fixed, lowest, highest, active,
    minimum, maximum, whole, condition_starts, condition_columns, condition_ranges,
    limit_starts, limit_columns, limit_is_maximum, limit_terms,
):  # fmt: skip
    """Walk through the parameters in their order, once for each row of values.

    ``values`` (B, P) are changed in place, as ``how`` says; ``fixed`` (P,) are values that are not drawn, NaN for those
    that are. ``lowest``, ``highest`` (B, P) take the ranges and ``active`` (B, P) the activity.

    ``minimum``, ``maximum``, ``whole`` (P,) describe the parameters. Parameter i has the conditions from
    ``condition_starts[i]`` to ``condition_starts[i + 1]``, in ``condition_columns`` (C,) and ``condition_ranges``
    (C, 2), and in the same way limits: ``limit_columns``, ``limit_is_maximum`` (L,), and offsets and factors in
    ``limit_terms`` (L, 2).
    """
    for b in range(values.shape[0]):
        for i in range(values.shape[1]):
            first, end = condition_starts[i], condition_starts[i + 1]
            acts = _hold(values, active, b, first, end, condition_columns, condition_ranges)
            low, high = minimum[i], maximum[i]
            for j in range(limit_starts[i], limit_starts[i + 1]):
                bound = limit_terms[j, 0] + limit_terms[j, 1] * values[b, limit_columns[j]]
                if limit_is_maximum[j]:
                    high = bound if bound < high else high
                else:
                    low = bound if bound > low else low
            low = high if high < low else low  # rounding, where they meet
            active[b, i], lowest[b, i], highest[b, i] = acts, low, high
            if how == KEEP:
                continue
            x = values[b, i]
            if how == SETTLE:
                if whole[i]:
                    x = np.rint(x)
            elif not np.isnan(fixed[i]):
                x = fixed[i]
            elif whole[i]:
                x = low + np.floor(x * (high - low + 1.0))
            else:
                x = low + x * (high - low)
            x = low if x < low else x
            x = high if x > high else x
            values[b, i] = x if acts else 1.0


@njit(cache=True, nogil=True)
@no_type_check
def hold_each(values, active, starts, columns, ranges, held):
    """Write to ``held`` (B, N) in which settled rows all conditions of each of N lists hold.

    The other arrays are as in :func:`walk`.
    """
    for b in range(values.shape[0]):
        for n in range(held.shape[1]):
            held[b, n] = _hold(values, active, b, starts[n], starts[n + 1], columns, ranges)


@njit(cache=True, nogil=True)
@no_type_check
def _hold(values, active, b, first, end, columns, ranges):
    """Tell whether all conditions hold in row ``b``; one on a parameter that is not active does not."""
    all_hold = True
    for k in range(first, end):  # without branches: what holds is different from row to row
        column = columns[k]
        x = values[b, column]
        all_hold &= active[b, column] & (ranges[k, 0] <= x) & (x <= ranges[k, 1])
    return all_hold
