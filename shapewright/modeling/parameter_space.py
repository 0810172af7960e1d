"""The space of a model's values: ranges, what depends on what, random rows, and rows from names.

A parameter may depend on those before it only, so one pass in their order settles everything.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from shapewright.errors import ModelError, ParameterError
from shapewright.modeling.dependence import Condition, Limit
from shapewright.modeling.fields import shown
from shapewright.modeling.parameter import Parameter

Values = Float[np.ndarray, "B P"]
_SLACK = 1e-9
"""Share of a range by which a value may miss a bound that was computed from another value."""


@dataclass(frozen=True, eq=False)
class FlatConditions:
    """N lists of conditions, one after the other.

    Attributes:
        starts: where each begins, and where the last one ends; N + 1 numbers.
        columns: of the parameters.
        ranges: the smallest and largest x.
    """

    starts: Int[np.ndarray, " N1"]
    columns: Int[np.ndarray, " C"]
    ranges: Float[np.ndarray, "C 2"]


class ParameterSpace:
    """What rows of values (B, P) mean, in the order of the parameters.

    A row is *settled* if every active parameter lies in its range there, options are whole, and parameters that are not
    active are 1.
    """

    def __init__(self, parameters: Sequence[Parameter]) -> None:
        """Take the parameters of a model.

        Raises:
            ModelError: a dependence on a parameter that is not there before it, or one that can leave no value or
                shuts out the base model; ``where`` says the place.
        """
        self.parameters = tuple(parameters)
        self.columns: Mapping[str, int] = {p.name: i for i, p in enumerate(self.parameters)}
        self.minimum: Float[np.ndarray, " P"] = np.array([p.minimum for p in parameters], dtype=np.float64)
        self.maximum: Float[np.ndarray, " P"] = np.array([p.maximum for p in parameters], dtype=np.float64)
        for i in range(len(self.parameters)):
            self._check(i)

    def check_conditions(self, conditions: Sequence[Condition], where: str, before: int | None = None) -> None:
        """Raise ModelError if a condition is on a parameter that is not there (before a column, if given)."""
        for j, condition in enumerate(conditions):
            column = self.columns.get(condition.parameter)
            if column is None or (before is not None and column >= before):
                raise ModelError(
                    f"there is no parameter {shown(condition.parameter)}{'' if before is None else ' before this one'}",
                    where=f"{where}[{j}].parameter",
                )
            parameter = self.parameters[column]
            if condition.maximum < parameter.minimum or condition.minimum > parameter.maximum:
                raise ModelError(f"{condition.parameter!r} never comes there", where=f"{where}[{j}].range")

    def base_values(self) -> Float[np.ndarray, " P"]:
        """Return the values of the base model: ones."""
        return np.ones(len(self.parameters))

    def random_values(self, rng: np.random.Generator, count: int, fixed: Mapping[str, float] | None = None) -> Values:
        """Return settled rows: each active parameter uniform in its range, or among its options (section 3.2).

        What is ``fixed`` by name is not drawn; where the range of a row leaves it out it is the nearest value within.

        Raises:
            ParameterError: a fixed value that :meth:`values_from_mapping` would refuse whatever the others are.
        """
        given = np.full(len(self.parameters), np.nan)
        for column, value in self._checked(fixed or {}).items():
            given[column] = value
        drawn = rng.random((count, len(self.parameters)))
        self._walk("DRAW", drawn, given)
        return drawn

    def settle(self, values: Values) -> Values:
        """Return the rows settled: moved into their ranges, options rounded, 1 where not active.

        Settled rows stay as they are, and the instance of a row is the instance of the settled row.
        """
        settled = np.array(values, dtype=np.float64, order="C")
        self._walk("SETTLE", settled)
        return settled

    def active(self, values: Values) -> Bool[np.ndarray, "B P"]:
        """Tell which parameters are active in settled rows."""
        return self._walk("KEEP", _plain(values))[2]

    def ranges(self, values: Values) -> tuple[Values, Values]:
        """Return the smallest and largest x of each parameter in settled rows."""
        return self._walk("KEEP", _plain(values))[:2]

    def settle_and_hold(self, lists: FlatConditions, values: Values) -> tuple[Values, Bool[np.ndarray, "B N"]]:
        """Return the rows settled, and in which of them all conditions of each list hold.

        A condition on a parameter that is not active does not hold.
        """
        from shapewright.modeling import parameter_kernels

        settled = np.array(values, dtype=np.float64, order="C")
        _, _, active = self._walk("SETTLE", settled)
        held = np.empty((len(settled), len(lists.starts) - 1), dtype=bool)
        parameter_kernels.hold_each(settled, active, lists.starts, lists.columns, lists.ranges, held)
        return settled, held

    def flat(self, lists: Sequence[Sequence[Condition]]) -> FlatConditions:
        """Return lists of conditions as :meth:`settle_and_hold` needs them."""
        conditions = [condition for each in lists for condition in each]
        ranges = [(condition.minimum, condition.maximum) for condition in conditions]
        return FlatConditions(
            starts=_starts(lists),
            columns=np.array([self.columns[condition.parameter] for condition in conditions], dtype=np.int64),
            ranges=np.array(ranges, dtype=np.float64).reshape(-1, 2),
        )

    def values_from_mapping(self, named: Mapping[str, float]) -> Float[np.ndarray, " P"]:
        """Return one settled row from names; what is not named is 1, or as near as its range allows.

        Raises:
            ParameterError: an unknown name, a value that is not finite, out of its range or no option.
        """
        values = self.base_values()
        for column, value in self._checked(named).items():
            values[column] = value
        settled = values[None].copy()
        lowest, highest, active = self._walk("SETTLE", settled)
        for i, parameter in enumerate(self.parameters):
            slack = _SLACK * (parameter.maximum - parameter.minimum)
            if parameter.name in named and active[0, i] and abs(settled[0, i] - values[i]) > slack:
                others = ", ".join(dict.fromkeys(limit.parameter for limit in parameter.limits))
                bounds = f"[{lowest[0, i]:g}, {highest[0, i]:g}]"
                raise ParameterError(
                    f"{shown(named[parameter.name])} is outside of {bounds}, given {others}",
                    where=f"values.{parameter.name}",
                )
        row: Float[np.ndarray, " P"] = settled[0]
        return row

    def _checked(self, named: Mapping[str, float]) -> dict[int, float]:
        for name, value in named.items():
            if name not in self.columns:
                known = ", ".join(self.columns) or "none"
                raise ParameterError(f"the model has no parameter {name!r}; it has: {known}", where=f"values.{name}")
            self._check_value(self.parameters[self.columns[name]], value)
        return {self.columns[name]: float(value) for name, value in named.items()}

    def _check_value(self, parameter: Parameter, value: float) -> None:
        where = f"values.{parameter.name}"
        if value != value or abs(value) == math.inf:  # math.isfinite overflows on very long whole numbers
            raise ParameterError("the value is not finite", where=where)
        if not parameter.minimum <= value <= parameter.maximum:
            bounds = f"[{parameter.minimum:g}, {parameter.maximum:g}]"
            raise ParameterError(f"{shown(value)} is outside of {bounds}", where=where)
        if parameter.options and value != round(value):
            known = ", ".join(f"{x:g} ({option})" for x, option in parameter.named_options())
            raise ParameterError(f"{shown(value)} is no option; there are: {known}", where=where)

    def _walk(
        self, how: str, values: Values, fixed: Float[np.ndarray, " P"] | None = None
    ) -> tuple[Values, Values, Bool[np.ndarray, "B P"]]:
        """Change values in place, as the kernel's constant ``how`` says; return lowest, highest and activity."""
        from shapewright.modeling import parameter_kernels

        lowest, highest, active = np.empty(values.shape), np.empty(values.shape), np.empty(values.shape, dtype=bool)
        parameter_kernels.walk(
            *(getattr(parameter_kernels, how), values, self.minimum if fixed is None else fixed),
            *(lowest, highest, active, self.minimum, self.maximum, *self._rules),
        )
        return lowest, highest, active

    @cached_property
    def _rules(self) -> tuple[Float[np.ndarray, "..."] | Int[np.ndarray, "..."] | Bool[np.ndarray, "..."], ...]:
        """Options, conditions and limits as the kernel needs them."""
        conditions = self.flat([parameter.active_when for parameter in self.parameters])
        limits = [limit for parameter in self.parameters for limit in parameter.limits]
        return (
            np.array([bool(parameter.options) for parameter in self.parameters], dtype=bool),
            *(conditions.starts, conditions.columns, conditions.ranges),
            _starts([parameter.limits for parameter in self.parameters]),
            np.array([self.columns[limit.parameter] for limit in limits], dtype=np.int64),
            np.array([limit.bound == "maximum" for limit in limits], dtype=bool),
            np.array([(limit.offset, limit.factor) for limit in limits], dtype=np.float64).reshape(-1, 2),
        )

    def _check(self, i: int) -> None:
        parameter = self.parameters[i]
        self.check_conditions(parameter.active_when, f"parameters[{i}].active_when", before=i)
        lows = [Limit("minimum", parameter.name, parameter.minimum, 0.0)]
        highs = [Limit("maximum", parameter.name, parameter.maximum, 0.0)]
        for j, limit in enumerate(parameter.limits):
            where = f"parameters[{i}].limits[{j}]"
            column = self.columns.get(limit.parameter)
            if column is None or column >= i:
                raise ModelError(f"there is no parameter {shown(limit.parameter)} before this one", where=where)
            base = limit.offset + limit.factor
            if (base > 1.0 + _SLACK) if limit.bound == "minimum" else (base < 1.0 - _SLACK):
                raise ModelError(f"the limit shuts out 1, the base model, where {limit.parameter!r} is 1", where=where)
            (lows if limit.bound == "minimum" else highs).append(limit)
            if min(self._least_room(low, high) for low in lows for high in highs) < -_SLACK:
                raise ModelError(f"the limit leaves no value where {limit.parameter!r} is at an end", where=where)

    def _least_room(self, low: Limit, high: Limit) -> float:
        """Smallest space between two bounds, wherever the values are that they follow."""
        terms = [(high.parameter, high.factor), (low.parameter, -low.factor)]
        if low.parameter == high.parameter:
            terms = [(low.parameter, high.factor - low.factor)]
        columns = [(self.columns[name], factor) for name, factor in terms]
        least = (min(factor * self.minimum[i], factor * self.maximum[i]) for i, factor in columns)
        return float(high.offset - low.offset + sum(least))


def _plain(values: Values) -> Values:
    return np.ascontiguousarray(values, dtype=np.float64)


def _starts(lists: Sequence[Sequence[object]]) -> Int[np.ndarray, " N1"]:
    """Return where each list begins when they are put one after the other, and where the last one ends."""
    return np.cumsum([0, *map(len, lists)])
