"""What a query says about parameters: statuses, intervals, ratios, sums."""

from dataclasses import replace

import numpy as np
import pytest
from surface_jacobian import linearized

from shapewright.errors import EstimationError
from shapewright.estimation.determination.determine import RESIDUAL_FLOOR, determine
from shapewright.estimation.determination.information import N_POSE, Information, pose_columns
from shapewright.modeling import Recorder, compile_model, group

RESIDUAL = 1e-3


def boxes(build):
    """A compiled model that ``build`` records."""
    recorder = Recorder("boxes", "block")
    build(recorder)
    return compile_model(recorder.build())


def three_lengths(recorder):
    for name, axis in (("length", "u"), ("width", "v"), ("height", "z")):
        recorder.parameter(name, name.capitalize(), 0.5, 2.0, unit="m", base_value=1.0 + "uvz".index(axis))
    whole = recorder.box(1.0, 2.0, 3.0).whole
    for name, axis in (("length", "u"), ("width", "v"), ("height", "z")):
        recorder.scale(group(whole, frame="world"), 1.0, axis, size=name)


def judged(linear, **changed):
    arguments = {"mean_residual": RESIDUAL, "factor": 1.0, "scale_known": False, **changed}
    return determine(*linear.arguments(), **arguments)


def test_a_box_has_determined_ratios_and_with_a_known_scale_determined_lengths():
    linear = linearized(boxes(three_lengths), [1.2, 0.8, 1.0])
    free, known = judged(linear), judged(linear, scale_known=True)
    assert free.statuses == ("determined_up_to_scale",) * 3
    assert known.statuses == ("determined",) * 3
    for found in (free, known):
        assert len(found.ratios) == 2, "one length is the reference of the others"
        for ratio in found.ratios:
            assert ratio.status == "determined"
            low, high = ratio.interval
            assert low < ratio.value < high < 1.1 * low
    shown = {"Length": 1.2, "Width": 1.6, "Height": 3.0}
    for ratio in free.ratios:
        top, bottom = ratio.label.split(" : ")
        assert ratio.value == pytest.approx(shown[top] / shown[bottom])
    for column in range(3):
        assert free.intervals[column] == (0.5, 2.0), "any size will do"
        low, high = known.intervals[column]
        assert 0.9 * linear.values[column] < low < linear.values[column] < high < 1.1 * linear.values[column]


def test_a_length_and_a_mere_factor_have_no_ratio():
    def build(recorder):
        recorder.parameter("length", "Length", 0.5, 2.0, unit="m", base_value=1.0)
        recorder.parameter("width", "Width", 0.5, 2.0)
        whole = group(recorder.box(1.0, 2.0, 3.0).whole, frame="world")
        recorder.scale(whole, 1.0, "u", size="length")
        recorder.scale(whole, 1.0, "vz", size="width")

    assert judged(linearized(boxes(build), [1.2, 0.8])).ratios == ()


def test_lengths_without_a_unit_are_told_by_how_the_model_grows():
    def build(recorder):
        recorder.parameter("side", "Side", 0.5, 2.0, base_value=1.5)
        recorder.parameter("thick", "Thickness (of the side)", 0.5, 2.0, base_value=0.5)
        recorder.parameter("height", "Height", 0.5, 2.0, base_value=3.0)
        recorder.parameter("lean", "Lean (deg)", 0.5, 2.0, base_value=20.0, unit="deg")
        box = recorder.box(1.0, 2.0, 3.0)
        whole = group(box.whole, frame="world")
        recorder.scale(whole, 1.0, "uv", size="side")
        recorder.scale(whole, 1.0, "v", size="thick")
        recorder.scale(whole, 1.0, "z", size="height")
        recorder.rotate(box.top, 20.0, "u", angle="lean")

    linear = linearized(boxes(build), [1.0, 1.0, 1.0, 1.0])
    (ratio,) = judged(linear).ratios
    assert {ratio.numerator, ratio.denominator} == {"side", "height"}
    assert judged(linear).statuses[1::2] == ("determined", "determined"), "neither depends on the scale"


def test_what_is_hidden_inside_is_not_determined():
    def build(recorder):
        recorder.parameter("outer", "Outer length", 0.5, 2.0, unit="m", base_value=2.0)
        recorder.parameter("inner", "Inner length", 0.5, 2.0, unit="m", base_value=0.5)
        recorder.scale(group(recorder.box(2.0, 2.0, 2.0).whole, frame="world"), 1.0, "u", size="outer")
        recorder.scale(
            group(recorder.box(0.5, 0.5, 0.5, offset=(0, 0, 1.0)).whole, frame="world"), 1.0, "u", size="inner"
        )

    linear = linearized(boxes(build), [1.0, 1.0], visible=lambda places: np.abs(places - [0, 0, 1.2]).max(axis=1) > 0.5)
    known = judged(linear, scale_known=True)
    assert known.statuses == ("determined", "not_determined")
    assert known.intervals[1] == (0.5, 2.0), "it may be anything"
    assert not known.ratios


def test_a_sum_is_determined_though_its_members_are_not():
    def build(recorder):
        recorder.parameter("neck", "Neck length", 0.5, 2.0, unit="m", base_value=1.0)
        recorder.parameter("stem", "Stem length", 0.5, 2.0, unit="m", base_value=2.0)
        box = recorder.box(1.0, 1.0, 4.0)
        recorder.drag(box.top, 1.0, length="neck")
        recorder.drag(box.top, 2.0, length="stem")

    known = judged(linearized(boxes(build), [1.0, 1.0]), scale_known=True)
    assert known.statuses == ("not_determined",) * 2
    (combination,) = known.combinations
    assert combination.label in ("Neck length + Stem length", "Stem length + Neck length")
    assert combination.weights == pytest.approx({"neck": 1.0, "stem": 1.0}, rel=1e-3)
    assert combination.interval_share < 0.05


def test_options_and_what_is_inactive_have_no_interval(library_models):
    compiled = compile_model(library_models["table"])
    values = compiled.values_from_mapping({"apron": 3})
    linear = linearized(compiled, values)
    found = judged(linear)
    by_name = dict(
        zip([p.name for p in linear.parameters], zip(found.statuses, found.intervals, strict=True), strict=True)
    )
    assert by_name["apron"] == (None, None)
    assert by_name["apron_height"] == ("inactive", None)
    assert by_name["top_length"][0] == "determined_up_to_scale"


def test_a_value_at_the_end_that_is_pulled_beyond_it_says_so():
    linear = linearized(boxes(three_lengths), [0.5, 2.0, 1.0])
    outward = np.array([0.05, -0.05, 0.05])  # the residual falls with x, with -x, and with x inside of the range
    found = judged(linear, scale_known=True, gradient=outward)
    assert found.statuses == ("at_range_end", "at_range_end", "determined")
    assert judged(linear, scale_known=True, gradient=-outward).statuses == ("determined",) * 3
    assert judged(linear, scale_known=True, gradient=1e-9 * outward).statuses == ("determined",) * 3
    low, high = found.intervals[0]
    assert low == 0.5 < high < 0.6


def test_a_range_that_the_others_leave_no_room_is_at_its_end():
    linear = linearized(boxes(three_lengths), [1.0, 1.0, 1.0])
    tight = replace(linear, lowest=np.array([1.0, 0.5, 0.5]), highest=np.array([1.0, 2.0, 2.0]))
    found = judged(tight)
    assert found.statuses == ("at_range_end", "determined", "determined"), "its size gives the scale away"
    assert found.intervals[0] == (1.0, 1.0)


def test_intervals_grow_with_residual_and_factor_down_to_a_floor():
    linear = linearized(boxes(three_lengths), [1.0, 1.0, 1.0])
    one = judged(linear, scale_known=True).half_widths
    assert judged(linear, scale_known=True, mean_residual=2 * RESIDUAL).half_widths == pytest.approx(2 * one)
    assert judged(linear, scale_known=True, factor=3.0).half_widths == pytest.approx(3 * one)
    floor = judged(linear, scale_known=True, mean_residual=0.0).half_widths
    assert floor == pytest.approx(one * RESIDUAL_FLOOR / RESIDUAL)


def test_a_model_without_parameters_has_nothing_to_judge():
    found = judged(linearized(boxes(lambda recorder: recorder.box(1.0, 2.0, 3.0)), []))
    assert (found.statuses, found.intervals, found.ratios, found.combinations) == ((), (), (), ())


def test_a_large_residual_leaves_nothing_determined():
    linear = linearized(boxes(three_lengths), [1.0, 1.0, 1.0])
    far = judged(linear, scale_known=True, mean_residual=1.0)
    assert far.statuses == ("not_determined",) * 3
    assert not far.ratios


def test_what_is_known_of_the_pose_only_adds(library_models):
    compiled = compile_model(library_models["glass_with_stem"])
    linear = linearized(compiled, compiled.random_values(np.random.default_rng(0), 1)[0])
    free, known = judged(linear).information, judged(linear, scale_known=True).information
    pose_known = linear.jacobian.copy()
    pose_known[:, -N_POSE:] = 0.0
    all_known = Information(pose_known, free.ranges)
    assert (known.effects >= free.effects * (1 - 1e-9)).all()
    assert (all_known.effects >= known.effects * (1 - 1e-9)).all()


def test_pose_columns_are_derivatives():
    rng = np.random.default_rng(0)
    points, normals = rng.normal(size=(20, 3)), rng.normal(size=(20, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    centre, step = points.mean(axis=0), 1e-6
    columns = pose_columns(points, normals)
    for axis in range(3):
        turned = np.cross(np.eye(3)[axis], points - centre)
        assert columns[:, axis] == pytest.approx(np.einsum("nd,nd->n", turned, normals))
        assert columns[:, 3 + axis] == pytest.approx(normals[:, axis])
    grown = centre + (points - centre) * np.exp(step) - points
    assert columns[:, 6] == pytest.approx(np.einsum("nd,nd->n", grown, normals) / step, rel=1e-5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"factor": 0.0}, "positive factor"),
        ({"jacobian": np.zeros((5, 4))}, "3 \\+ 7 columns"),
        ({"jacobian": np.full((5, 10), np.nan)}, "finite"),
        ({"jacobian": np.zeros((0, 10))}, "at least one point"),
    ],
)
def test_refusals(change, message):
    linear = linearized(boxes(three_lengths), [1.0, 1.0, 1.0])
    *arguments, jacobian = linear.arguments()
    settings = {"jacobian": jacobian, "mean_residual": RESIDUAL, "factor": 1.0, "scale_known": False, **change}
    with pytest.raises(EstimationError, match=message):
        determine(*arguments, **settings)
