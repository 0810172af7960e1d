"""What a recorded model declares beside its operations: parameters, what they depend on, parts, symmetry."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Literal

from shapewright.errors import ModelError
from shapewright.modeling.component import Component
from shapewright.modeling.dependence import Condition, Limit
from shapewright.modeling.elements import Axis, Element
from shapewright.modeling.parameter import Parameter, ParameterTarget
from shapewright.modeling.part import Part
from shapewright.modeling.symmetry import NO_SYMMETRY, Symmetry
from shapewright.modeling.units import ParameterKind, kind_of_unit


class Declarations:
    """The declaring half of a recorder."""

    def __init__(self) -> None:
        self._declared: dict[str, Parameter] = {}
        self._parts: list[Part] = []
        self._symmetry = NO_SYMMETRY

    def parameter(
        self,
        name: str,
        label: str,
        minimum: float,
        maximum: float,
        *,
        unit: str | None = None,
        base_value: float | None = None,
        kind: ParameterKind | None = None,
        active_when: Sequence[Condition] = (),
    ) -> None:
        """Declare a parameter; the order of declaration is the order in the model.

        Its kind need not be given where the unit tells it.
        """
        self._declare(
            Parameter(
                name,
                label,
                minimum,
                maximum,
                targets=(ParameterTarget(0, ""),),  # a placeholder
                unit=unit,
                base_value=base_value,
                active_when=tuple(active_when),
                kind=kind or kind_of_unit(unit),
            )
        )

    def switch(
        self,
        name: str,
        label: str,
        options: tuple[str, str] = ("without", "with"),
        *,
        active_when: Sequence[Condition] = (),
    ) -> None:
        """Declare a parameter that is 0 or 1; the base model has it at 1."""
        self._declare(Parameter(name, label, 0.0, 1.0, (), options=options, active_when=tuple(active_when)))

    def choice(self, name: str, label: str, options: Sequence[str], *, active_when: Sequence[Condition] = ()) -> None:
        """Declare a parameter that is 1, 2, ... with these options; the base model has the first."""
        named = tuple(options)
        self._declare(Parameter(name, label, 1.0, len(named), (), options=named, active_when=tuple(active_when)))

    def limit(
        self,
        name: str,
        *,
        minimum: tuple[str, float, float] | None = None,
        maximum: tuple[str, float, float] | None = None,
    ) -> None:
        """Narrow the range of a declared parameter by (another parameter, offset, factor): offset + factor * x."""
        if name not in self._declared:
            raise ModelError(f"parameter {name!r} is limited but not declared")
        bounds: list[tuple[Literal["minimum", "maximum"], tuple[str, float, float] | None]]
        bounds = [("minimum", minimum), ("maximum", maximum)]
        added = tuple(Limit(bound, *given) for bound, given in bounds if given)
        declared = self._declared[name]
        self._declared[name] = replace(declared, limits=declared.limits + added)

    def part(self, name: str, components: Iterable[Component | Element], present_when: Sequence[Condition]) -> None:
        """Declare components as a part that is there where all conditions hold."""
        wholes = tuple(item.whole if isinstance(item, Component) else item for item in components)
        self._parts.append(Part(name, wholes, tuple(present_when)))

    def symmetry(
        self,
        mirrors: Iterable[Axis] = (),
        axis: Axis | None = None,
        order: int = 1,
        *,
        apart: Iterable[Component | Element] = (),
    ) -> None:
        """Declare mirror planes by their normals, a rotation by axis and order, and components that are left out."""
        left_out = tuple(item.whole if isinstance(item, Component) else item for item in apart)
        self._symmetry = Symmetry(tuple(mirrors), axis, order, left_out)

    def _declare(self, parameter: Parameter) -> None:
        if parameter.name in self._declared:
            raise ModelError(f"parameter {parameter.name!r} is declared twice")
        self._declared[parameter.name] = parameter
