"""A sheet of small pictures of one model: the base, each parameter at its ends, random variations."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from shapewright.modeling import CompiledModel
from shapewright.modeling.contexts import active_row, distinct_values
from shapewright.modeling.parameter import Parameter
from shapewright.rendering.pictures import draw_together
from shapewright.rendering.sheet import Cell, check_sheet_size, compose_sheet
from shapewright.rendering.styles import STYLES, ImageStyle
from shapewright.rendering.views import three_quarter_view


def compose_contact_sheet(
    compiled: CompiledModel,
    *,
    base: Float[np.ndarray, " P"] | None = None,
    variations: int = 24,
    rng: np.random.Generator | None = None,
    rotation: Float[np.ndarray, "3 3"] | None = None,
    size: int = 192,
    columns: int = 8,
    style: ImageStyle = "shaded",
) -> UInt8[np.ndarray, "H W 3"]:
    """Draw what a person must look at before a model is done.

    The pictures of one parameter share their framing, so that sizes can be compared; every other picture is
    filled by its object. A parameter that the base leaves without effect is shown where it is active.

    Args:
        base: values that everything but the variations starts from; the base model's if not given.
        variations: random ones.
        rng: source of their values; seeded with 0 if not given.
        rotation: turns every mesh; by default :func:`three_quarter_view`, z upwards.
        size: pixels a side of each picture.
        columns: pictures in a row.
        style: as in :func:`shapewright.rendering.render_mesh`.

    Raises:
        ParameterError: not P values, or NaN.
        RenderingError: no headless OpenGL, or a sheet of more than MAX_SIDE pixels a side.
    """
    turned = three_quarter_view("z") if rotation is None else rotation
    start = compiled.settle((compiled.base_values() if base is None else base)[None])[0]
    counts = [1 + sum(len(p.options) or 2 for p in compiled.model.parameters), variations]
    check_sheet_size(counts, size, columns)
    drawing = _Drawing(compiled, turned, size, style)
    sections = [
        (f"{compiled.model.name}: base and parameters", list(drawing.parameters(start))),
        ("random variations", list(drawing.variations(np.random.default_rng(0) if rng is None else rng, variations))),
    ]
    return compose_sheet([section for section in sections if section[1]], size, columns)


@dataclass(frozen=True)
class _Drawing:
    compiled: CompiledModel
    rotation: Float[np.ndarray, "3 3"]
    size: int
    style: ImageStyle

    def parameters(self, start: Float[np.ndarray, " P"]) -> Iterator[Cell]:
        yield Cell(self._drawn(start[None])[0], "base", f"{len(self.compiled.model.parameters)} parameters")
        space = self.compiled.space
        for column, parameter in enumerate(space.parameters):
            row = active_row(space, column, start)
            if row is None:
                continue
            rows = distinct_values(space, column, row)
            changed = [f"{space.parameters[i].name} {row[i]:g}" for i in np.flatnonzero(row != start) if i != column]
            for pixels, values in zip(self._drawn(rows, beside=row), rows, strict=True):
                caption = ", ".join([_measure(parameter, float(values[column])), *changed])
                yield Cell(pixels, parameter.label, caption)

    def variations(self, rng: np.random.Generator, count: int) -> Iterator[Cell]:
        for number, row in enumerate(self.compiled.random_values(rng, count)):
            yield Cell(self._drawn(row[None])[0], f"variation {number}", "")

    def _drawn(
        self, rows: Float[np.ndarray, "B P"], beside: Float[np.ndarray, " P"] | None = None
    ) -> UInt8[np.ndarray, "B H W 3"]:
        meshes = [self.compiled.instance(row) for row in (rows if beside is None else [*rows, beside])]
        return draw_together(meshes, [1] * len(rows), self.rotation, self.size, STYLES[self.style])


def _measure(parameter: Parameter, x: float) -> str:
    options = dict(parameter.named_options())
    if options:
        return options[x]
    shown = f"x = {x:.3g}"
    if parameter.base_value is None:
        return shown
    return f"{shown}: {x * parameter.base_value:.3g} {parameter.unit or ''}".strip()
