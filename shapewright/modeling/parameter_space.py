"""The space of a model's values: ranges, what depends on what, random rows, and rows from names.

A parameter may depend on those before it only, so one pass in their order settles everything.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float

from shapewright.errors import ModelError, ParameterError
from shapewright.modeling.dependence import Condition, Limit
from shapewright.modeling.fields import shown
from shapewright.modeling.parameter import Parameter

Values = Float[np.ndarray, "B P"]
Column = Float[np.ndarray, " B"]
_SLACK = 1e-9
"""Share of a range by which a value may miss a bound that was computed from another value."""


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
        given = self._checked(fixed or {})
        shares = rng.random((count, len(self.parameters)))
        values = np.empty_like(shares)
        for i, low, high, active in self._bounds(values):
            if i in given:
                drawn = np.clip(given[i], low, high)
            elif self.parameters[i].options:
                drawn = np.minimum(low + np.floor(shares[:, i] * (high - low + 1.0)), high)
            else:
                drawn = low + shares[:, i] * (high - low)
            values[:, i] = np.where(active, drawn, 1.0)
        return values

    def settle(self, values: Values) -> Values:
        """Return the rows settled: moved into their ranges, options rounded, 1 where not active.

        Settled rows stay as they are, and the instance of a row is the instance of the settled row.
        """
        settled = np.array(values, dtype=np.float64)
        for i, low, high, active in self._bounds(settled):
            column = np.rint(settled[:, i]) if self.parameters[i].options else settled[:, i]
            settled[:, i] = np.where(active, np.clip(column, low, high), 1.0)
        return settled

    def active(self, values: Values) -> Bool[np.ndarray, "B P"]:
        """Tell which parameters are active in settled rows."""
        active = np.ones(values.shape, dtype=bool)
        for i, column in self._activity(values).items():
            active[:, i] = column
        return active

    def ranges(self, values: Values) -> tuple[Values, Values]:
        """Return the smallest and largest x of each parameter in settled rows."""
        lowest, highest = np.empty(values.shape), np.empty(values.shape)
        for i, low, high, _ in self._bounds(values):
            lowest[:, i], highest[:, i] = low, high
        return lowest, highest

    def holds_each(self, each: Sequence[Sequence[Condition]], values: Values) -> Bool[np.ndarray, "B N"]:
        """Tell in which settled rows all conditions of each list hold; one on an inactive parameter does not."""
        activity = self._activity(values)
        held = np.empty((len(values), len(each)), dtype=bool)
        for number, conditions in enumerate(each):
            held[:, number] = self._hold(conditions, values, activity)
        return held

    def values_from_mapping(self, named: Mapping[str, float]) -> Float[np.ndarray, " P"]:
        """Return one settled row from names; what is not named is 1, or as near as its range allows.

        Raises:
            ParameterError: an unknown name, a value that is not finite, out of its range or no option.
        """
        values = self.base_values()
        for column, value in self._checked(named).items():
            values[column] = value
        settled = self.settle(values[None])
        for i, low, high, active in self._bounds(settled):
            parameter = self.parameters[i]
            slack = _SLACK * (parameter.maximum - parameter.minimum)
            if parameter.name in named and active[0] and abs(settled[0, i] - values[i]) > slack:
                others = ", ".join(dict.fromkeys(limit.parameter for limit in parameter.limits))
                raise ParameterError(
                    f"{shown(named[parameter.name])} is outside of [{low[0]:g}, {high[0]:g}], given {others}",
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

    def _bounds(self, values: Values) -> Iterator[tuple[int, Column, Column, Bool[np.ndarray, " B"]]]:
        """Yield (column, lowest, highest, active) in order; the columns before must be settled by then."""
        activity: dict[int, Bool[np.ndarray, " B"]] = {}
        for i, parameter in enumerate(self.parameters):
            activity[i] = self._hold(parameter.active_when, values, activity)
            low, high = (np.full(len(values), bound) for bound in (parameter.minimum, parameter.maximum))
            for limit in parameter.limits:
                bound = limit.offset + limit.factor * values[:, self.columns[limit.parameter]]
                if limit.bound == "minimum":
                    low = np.maximum(low, bound)
                else:
                    high = np.minimum(high, bound)
            if parameter.limits:
                low = np.minimum(low, high)  # rounding, where they meet
            yield i, low, high, activity[i]

    def _activity(self, values: Values) -> dict[int, Bool[np.ndarray, " B"]]:
        activity: dict[int, Bool[np.ndarray, " B"]] = {}
        for i, parameter in enumerate(self.parameters):
            activity[i] = self._hold(parameter.active_when, values, activity)
        return activity

    def _hold(
        self, conditions: Sequence[Condition], values: Values, activity: Mapping[int, Bool[np.ndarray, " B"]]
    ) -> Bool[np.ndarray, " B"]:
        all_hold = np.ones(len(values), dtype=bool)
        for condition in conditions:
            column = self.columns[condition.parameter]
            x = values[:, column]
            all_hold &= activity[column] & (condition.minimum <= x) & (x <= condition.maximum)
        return all_hold

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
