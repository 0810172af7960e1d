"""Choices, conditions, limits and optional parts: laws on random models, and each refusal on a small one."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_models import Recipe, recipes

from shapewright.distances.panorama import panorama_descriptor
from shapewright.errors import ModelError, ParameterError
from shapewright.modeling import CompiledModel, ProceduralModel, Recorder, compile_model, group, when
from shapewright.modeling.upgrade import VERSION

few = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def chair_recorder() -> Recorder:
    """A seat with a back (three kinds) and armrests, whose pads are there only with armrests."""
    recorder = Recorder("seat", "seat")
    recorder.choice("back", "Back", ("low", "high", "none"))
    recorder.switch("arms", "Armrests")
    recorder.switch("pads", "Armrest pads", ("bare", "padded"), active_when=[when("arms", 1)])
    recorder.parameter("width", "Seat width", 0.5, 2.0, unit="m", base_value=0.5)
    recorder.parameter("arm_height", "Armrest height", 0.5, 2.0, active_when=[when("arms", 1)])
    recorder.parameter("pad_length", "Pad length", 0.4, 1.6, active_when=[when("pads", 1)])
    recorder.limit("arm_height", minimum=("width", -0.5, 0.5), maximum=("width", 0.5, 0.75))
    seat = recorder.box(1.0, 1.0, 0.2)
    low = recorder.box(1.0, 0.1, 0.4, anchor=seat.top)
    high = recorder.box(1.0, 0.1, 0.9, anchor=seat.top)
    arm = recorder.box(0.1, 0.8, 0.3, offset=(0.45, 0.0, 0.0), anchor=seat.top)
    pad = recorder.box(0.2, 0.7, 0.1, anchor=arm.top)
    recorder.scale(group(arm.whole, frame="world"), 1.0, "z", size="arm_height")
    recorder.scale(group(pad.whole, frame="world"), 1.0, "v", size="pad_length")
    recorder.scale(group(seat.whole, low.whole, high.whole, frame="world"), 1.0, "u", size="width")
    recorder.part("low back", [low], [when("back", 1)])
    recorder.part("high back", [high], [when("back", 2)])
    recorder.part("arms", [arm], [when("arms", 1)])
    recorder.part("pads", [pad], [when("pads", 1)])
    return recorder


def chair() -> CompiledModel:
    return compile_model(chair_recorder().build())


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_settling_is_idempotent_and_random_rows_are_settled(recipe: Recipe, seed: int) -> None:
    compiled = compile_model(recipe.build())
    rng = np.random.default_rng(seed)
    drawn = compiled.random_values(rng, 20)
    np.testing.assert_array_equal(compiled.settle(drawn), drawn)
    wild = rng.normal(1.0, 2.0, drawn.shape)
    settled = compiled.settle(wild)
    np.testing.assert_array_equal(compiled.settle(settled), settled)
    lowest, highest = compiled.space.ranges(settled)
    active = compiled.space.active(settled)
    assert ((lowest <= settled) & (settled <= highest))[active].all()
    assert (settled[~active] == 1.0).all()
    np.testing.assert_array_equal(compiled.control_points(wild), compiled.control_points(settled))


@few
@given(recipes(), st.integers(0, 2**32 - 1))
def test_an_instance_is_the_row_of_a_batch_without_its_absent_parts(recipe: Recipe, seed: int) -> None:
    compiled = compile_model(recipe.build())
    values = compiled.random_values(np.random.default_rng(seed), 4)
    batch, present = compiled.surface_points(values), compiled.parts_present(values)
    parts, triangles = compiled.surface_parts(), compiled.surface_triangles()
    for row, points, there in zip(values, batch, present, strict=True):
        instance = compiled.instance(row)
        kept = np.append(there, True)[parts]
        np.testing.assert_allclose(instance.vertices, points[kept], atol=1e-9)
        assert len(instance.faces) == np.count_nonzero(kept[triangles].all(axis=1))
        if not kept.all():
            np.testing.assert_allclose(np.ptp(points[~kept], axis=0), 0.0, atol=1e-9)
        low, high = instance.vertices.min(axis=0), instance.vertices.max(axis=0)
        whole = compiled.control_points(row[None])[0]
        assert (whole.min(axis=0) <= low + 1e-9).all()
        assert (high <= whole.max(axis=0) + 1e-9).all()


def test_an_absent_part_leaves_no_trace_in_a_descriptor() -> None:
    compiled = chair()
    values = compiled.random_values(np.random.default_rng(3), 12)
    assert not compiled.parts_present(values).all()
    for row, points in zip(values, compiled.surface_points(values), strict=True):
        instance = compiled.instance(row)
        np.testing.assert_allclose(
            panorama_descriptor(instance.vertices, instance.faces).to_array(),
            panorama_descriptor(points, compiled.surface_triangles()).to_array(),
            atol=1e-6,
        )


def test_options_are_drawn_evenly_and_a_range_that_depends_is_drawn_throughout() -> None:
    compiled = chair()
    values = compiled.random_values(np.random.default_rng(0), 3000)
    _, counts = np.unique(values[:, 0], return_counts=True)
    assert (np.abs(counts / 3000 - 1 / 3) < 0.04).all()
    lowest, highest = compiled.space.ranges(values)
    active = compiled.space.active(values)[:, 4]
    share = ((values - lowest) / (highest - lowest))[active, 4]
    assert share.min() < 0.02 < 0.98 < share.max()
    assert abs(share.mean() - 0.5) < 0.03


def test_a_condition_on_an_inactive_parameter_does_not_hold() -> None:
    compiled = chair()
    row = compiled.values_from_mapping({"arms": 0, "pads": 1, "pad_length": 1.3})
    assert compiled.parts_present(row[None])[0].tolist() == [True, False, False, False]
    assert row.tolist() == [1, 0, 1, 1, 1, 1]
    assert compiled.space.active(row[None])[0].tolist() == [True, True, False, True, False, False]


def test_an_unnamed_value_follows_its_range_and_a_named_one_is_refused() -> None:
    compiled = chair()
    assert compiled.values_from_mapping({"width": 0.5})[4] == pytest.approx(0.875)
    with pytest.raises(ParameterError, match=r"1\.5 is outside of \[0\.5, 0\.875\], given width") as refused:
        compiled.values_from_mapping({"width": 0.5, "arm_height": 1.5})
    assert refused.value.where == "values.arm_height"
    with pytest.raises(ParameterError, match=r"1\.5 is no option; there are: 1 \(low\), 2 \(high\), 3 \(none\)"):
        compiled.values_from_mapping({"back": 1.5})
    with pytest.raises(ParameterError, match="outside"):
        compiled.values_from_mapping({"back": 4})


def test_a_document_holds_what_depends_on_what() -> None:
    model = chair_recorder().build()
    again = ProceduralModel.from_json(model.to_json())
    assert again == model
    document = model.to_document()
    assert document["parameters"][4]["limits"][1] == {
        "bound": "maximum",
        "parameter": "width",
        "offset": 0.5,
        "factor": 0.75,
    }
    assert document["parts"][2]["present_when"] == [{"parameter": "arms", "range": [1.0, 1.0]}]


def test_documents_of_version_1_are_read() -> None:
    recorder = Recorder("block", "block")
    recorder.box(1.0, 1.0, 1.0)
    model = recorder.build()
    old = {key: value for key, value in model.to_document().items() if key not in ("parts", "symmetry")}
    assert VERSION == 3
    assert ProceduralModel.from_document({**old, "version": 1}) == model


@pytest.mark.parametrize(
    ("path", "value", "where", "message"),
    [
        (("parameters", 1, "active_when"), [{"parameter": "width", "range": [1, 1]}], "parameters[1].active", "before"),
        (("parameters", 1, "active_when"), [{"parameter": "back", "range": [9, 9]}], "parameters[1].active", "never"),
        (("parameters", 4, "limits", 0, "parameter"), "nobody", "parameters[4].limits[0]", "no parameter"),
        (("parameters", 4, "limits", 0, "offset"), 0.9, "parameters[4].limits[0]", "shuts out 1"),
        (("parameters", 4, "limits", 1), {"bound": "maximum", "parameter": "width", "offset": -2.0, "factor": 3.5},
         "parameters[4].limits[1]", "leaves no value"),
        (("parameters", 0, "options"), ["one", "two"], "parameters[0]", "one whole number for each"),
        (("parameters", 0, "options"), ["one", "two", "one"], "parameters[0]", "two options of one name"),
        (("parameters", 4, "active_when", 0, "range"), [2, 1], "parameters[4].active_when[0].range", "empty"),
        (("parts", 0, "present_when", 0, "range"), [2, 1], "parts[0].present_when[0].range", "empty"),
        (("parts", 0, "present_when"), [], "parts[0]", "no condition"),
        (("parts", 0, "present_when", 0, "parameter"), "nobody", "parts[0].present_when[0]", "no parameter"),
        (("parts", 0, "components"), ["c9"], "parts[0].components", "does not exist"),
        (("parts", 0, "components"), ["c2"], "parts[1].components", "two parts"),
        (("parts", 0, "components"), ["f2"], "parts[0]", "must consist of components"),
        (("parts", 0, "components"), ["c0", "c1"], "parts", "must belong to no part"),
        (("symmetry", "order"), 3, "symmetry.order", "axis"),
        (("symmetry", "apart"), ["c77"], "symmetry.apart", "does not exist"),
    ],
)  # fmt: skip
def test_a_wrong_dependence_is_refused_with_its_place(
    path: tuple[str | int, ...], value: object, where: str, message: str
) -> None:
    document = json.loads(chair_recorder().build().to_json())
    item = document
    for step in path[:-1]:
        item = item[step]
    item[path[-1]] = value
    with pytest.raises(ModelError, match=message) as refused:
        compile_model(ProceduralModel.from_document(document))
    assert refused.value.where is not None
    assert refused.value.where.startswith(where)


@pytest.mark.parametrize("path", [("parameters", 4, "active_when", 0), ("parts", 0, "present_when", 0)])
def test_a_reference_to_nothing_is_refused_before_anything_is_built(path: tuple[str | int, ...]) -> None:
    document = json.loads(chair_recorder().build().to_json())
    item = document
    for step in path:
        item = item[step]
    item["parameter"] = "nobody"
    with pytest.raises(ModelError, match="no parameter 'nobody'"):
        ProceduralModel.from_document(document)


def corridor(room: float) -> Recorder:
    """A parameter that must lie a little above another one, at most ``room`` above it."""
    recorder = Recorder("corridor", "corridor")
    recorder.parameter("inner", "Inner radius", 0.5, 2.0)
    recorder.parameter("outer", "Outer radius", 0.4, 2.5)
    recorder.limit("outer", minimum=("inner", 0.0, 1.0), maximum=("inner", room, 1.0))
    inside = recorder.box(1.0, 1.0, 1.0)
    recorder.scale(inside.whole, 1.0, size="inner")
    recorder.scale(recorder.box(1.0, 1.0, 1.1).whole, 1.0, size="outer")
    return recorder


def test_two_limits_by_one_parameter_may_leave_a_narrow_range_everywhere() -> None:
    values = compile_model(corridor(0.2).build()).random_values(np.random.default_rng(0), 200)
    above = values[:, 1] - values[:, 0]
    assert above.min() >= -1e-12
    assert above.max() <= 0.2 + 1e-12
    crossed = corridor(0.2)
    crossed.limit("outer", minimum=("inner", -0.5, 1.5))
    with pytest.raises(ModelError, match="leaves no value"):
        crossed.build()


def test_a_part_that_is_connected_to_the_rest_is_refused() -> None:
    recorder = Recorder("stuck", "stuck")
    recorder.switch("lid", "Lid")
    below, above = recorder.box(1.0, 1.0, 1.0), recorder.box(1.0, 1.0, 1.0, offset=(0.0, 0.0, 2.0))
    recorder.connect(below.top, above.bottom)
    recorder.part("lid", [above], [when("lid", 1)])
    with pytest.raises(ModelError, match="connects it with what is not part of it") as refused:
        recorder.build()
    assert refused.value.where == "parts[0]"


def test_something_is_always_there() -> None:
    recorder = Recorder("nothing", "nothing")
    recorder.switch("box", "Box")
    recorder.part("box", [recorder.box(1.0, 1.0, 1.0)], [when("box", 1)])
    with pytest.raises(ModelError, match="at least one component must belong to no part"):
        recorder.build()
