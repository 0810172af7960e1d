"""What a validation finds: nothing in a good model, and each thing that can be wrong in a model that has it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from shapewright.modeling import CompiledModel, ProceduralModel, Recorder, compile_model, group, variation_checks, when
from shapewright.modeling.contexts import active_row, distinct_values
from shapewright.modeling.validation import (
    CHECKS,
    effect_faults,
    replay_faults,
    symmetry_faults,
    topology_faults,
    validate_model,
)
from shapewright.modeling.variation_checks import check_variations


def post(**symmetry: Any) -> Recorder:
    """A box on whose top a narrower post of variable length stands."""
    recorder = Recorder("post", "post")
    recorder.parameter("length", "Length", 0.5, 2.0)
    box = recorder.box(1.0, 1.0, 0.3)
    recorder.extrude(box.top, 0.05)
    recorder.scale(box.top, 0.3)
    recorder.extrude(box.top, 1.0, length="length")
    if symmetry:
        recorder.symmetry(**symmetry)
    return recorder


def stretched(minimum: float, maximum: float, size: float = 1.0, axes: str = "uvz") -> ProceduralModel:
    """A box of which a parameter scales everything, or some axes of it."""
    recorder = Recorder("stretched", "box")
    recorder.parameter("size", "Size", minimum, maximum)
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.scale(group(box.whole, frame="world"), size, axes, size="size")
    return recorder.build()


def bench() -> ProceduralModel:
    """A seat with two kinds of backs or none, and two armrests, whose height depends on the seat's, or none."""
    recorder = Recorder("bench", "bench")
    recorder.choice("back", "Back", ("low", "high", "none"))
    recorder.switch("arms", "Armrests")
    recorder.parameter("thickness", "Thickness", 0.5, 2.0)
    recorder.parameter("arm_height", "Armrest height", 0.5, 2.0, active_when=[when("arms", 1)])
    recorder.limit("arm_height", maximum=("thickness", 0.5, 1.0))
    seat = recorder.box(1.0, 1.0, 0.2)
    backs = [recorder.box(0.1, 0.9, height, offset=(-0.2, 0.0, 0.0)) for height in (0.4, 0.9)]
    arms = [recorder.box(0.7, 0.1, 0.4, offset=(0.0, side, 0.0)) for side in (0.2, -0.2)]
    for component in (seat, *backs, *arms):
        recorder.mark_sharp(*component.faces)
    recorder.scale(group(seat.whole, frame="world"), 1.0, "z", size="thickness")
    recorder.scale([group(arm.whole, frame="world") for arm in arms], 1.0, "z", size="arm_height")
    for number, back in enumerate(backs, start=1):
        recorder.part(f"back {number}", [back], [when("back", number)])
    recorder.part("arms", arms, [when("arms", 1)])
    recorder.symmetry(mirrors="y")
    return recorder.build()


def found(model: ProceduralModel, **options: Any) -> dict[str, list[str]]:
    """Places and messages of the findings, by check."""
    by_check: dict[str, list[str]] = {}
    for finding in validate_model(model, variations=options.pop("variations", 60), **options):
        assert finding.model == model.name
        assert finding.check in CHECKS
        by_check.setdefault(finding.check, []).append(f"{finding.where}: {finding.message}")
    return by_check


@pytest.mark.parametrize("model", [post(mirrors="xy", axis="z", order=4).build(), bench()], ids=["post", "bench"])
def test_a_good_model_has_no_finding(model: ProceduralModel) -> None:
    assert found(model, document=model.to_json()) == {}


def test_an_object_without_parameters_can_be_validated() -> None:
    recorder = Recorder("plain", "plain")
    recorder.box(1.0, 1.0, 1.0)
    assert found(recorder.build()) == {}


# ---------------------------------------------------------------------- replay


class ForgettingModel(ProceduralModel):
    """Writes a document without its parameters."""

    def to_document(self) -> dict[str, Any]:
        return {**super().to_document(), "parameters": []}


class RoundingModel(ProceduralModel):
    """Writes the height of its base in whole numbers."""

    def to_document(self) -> dict[str, Any]:
        document = super().to_document()
        first = document["operations"][0]
        first["size"] = [round(number + 1) for number in first["size"]]
        return document


@pytest.mark.parametrize(("kind", "lost"), [(ForgettingModel, "other parameters"), (RoundingModel, "other instances")])
def test_what_writing_loses_is_found(kind: type[ProceduralModel], lost: str) -> None:
    model = post().build()
    bad = kind(model.name, model.class_name, model.operations, model.parameters)
    assert lost in " ".join(replay_faults(compile_model(bad), np.ones((1, 1))))


def test_a_document_that_is_not_canonical_is_found_if_it_must_be() -> None:
    model = post().build()
    assert found(model, document=model.to_json() + " ") == {"replay": [": the document is not what the model writes"]}


# ---------------------------------------------------------------------- topology


def test_edges_of_three_faces_and_faces_wound_against_each_other_are_found() -> None:
    assert topology_faults([(0, 1, 2), (1, 0, 3)]) == []
    assert [place for place, _ in topology_faults([(0, 1, 2), (1, 0, 3), (0, 1, 4)])] == ["edge 0-1"]
    assert "against each other" in topology_faults([(0, 1, 2), (0, 1, 3)])[0][1]


def test_an_open_model_that_says_it_is_closed_is_found() -> None:
    recorder = Recorder("open_box", "box", closed=False)
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.remove(box.top)
    model = recorder.build()
    assert found(model) == {}
    assert "open edges" in found(replace(model, closed=True))["topology"][0]


# ---------------------------------------------------------------------- symmetry


def leaning(low: float = 0.5, **symmetry: Any) -> CompiledModel:
    """A box whose top a parameter moves along x, by nothing at x = 0 only."""
    recorder = Recorder("leaning", "leaning")
    recorder.parameter("lean", "Lean", low, 2.0)
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.drag(group(box.top, frame="world"), rho=0.2, sideways="lean")
    recorder.symmetry(**symmetry)
    return compile_model(recorder.build())


def test_a_declared_symmetry_that_does_not_hold_is_found() -> None:
    assert symmetry_faults(leaning(mirrors="y"), np.ones((1, 1))) == []
    (name, message, row), *others = symmetry_faults(leaning(mirrors="xy"), np.array([[1.0], [2.0]]))
    assert (name, row, others) == ("mirror x", 1, [])
    assert "variation 0" in message
    assert [name for name, *_ in symmetry_faults(leaning(axis="z", order=2), np.ones((1, 1)))] == [
        "turn 180 deg about z"
    ]


def test_a_symmetry_that_only_the_base_model_has_is_found() -> None:
    recorder = Recorder("leaning", "leaning")
    recorder.parameter("lean", "Lean", 0.0, 2.0)
    box = recorder.box(1.0, 1.0, 1.0)
    upright = group(box.top, frame="world")
    recorder.drag(upright, rho=0.2, sideways="lean")
    recorder.drag(upright, rho=-0.2)
    recorder.symmetry(mirrors="x")
    findings = validate_model(recorder.build(), variations=5)
    assert [finding.check for finding in findings] == ["symmetry"]
    assert findings[0].values["lean"] != 1.0


def test_components_apart_and_absent_parts_are_left_out() -> None:
    recorder = Recorder("one_sided", "box")
    recorder.switch("lamp", "Lamp")
    recorder.box(1.0, 1.0, 1.0)
    lamp = recorder.box(0.2, 0.2, 0.2, offset=(0.55, 0.3, 0.5))
    recorder.part("lamp", [lamp], [when("lamp", 1)])
    recorder.symmetry(mirrors="y")
    bad = recorder.build()
    without, with_lamp = np.array([[0.0]]), np.array([[1.0]])
    assert symmetry_faults(compile_model(bad), without) == []
    assert "c1 is off" in symmetry_faults(compile_model(bad), with_lamp)[0][1]
    recorder.symmetry(mirrors="y", apart=[lamp])
    assert symmetry_faults(compile_model(recorder.build()), with_lamp) == []


# ---------------------------------------------------------------------- variations


class DisturbedModel(CompiledModel):
    """Gives the third row of values a vertex that is not a number."""

    def surface_chunks(self, values: np.ndarray, steps: int = 2) -> Iterator[tuple[int, np.ndarray]]:
        for start, chunk in super().surface_chunks(values, steps):
            disturbed = chunk.copy()
            disturbed[2, 3, 1] = np.nan
            yield start, disturbed


def test_a_coordinate_that_is_no_number_is_found() -> None:
    faults = check_variations(DisturbedModel(post().build()), np.ones((4, 1)))
    assert [(fault.check, fault.row) for fault in faults] == [("finite", 2)]


def test_a_face_without_area_is_found() -> None:
    recorder = Recorder("collapsed", "box")
    recorder.parameter("step", "Step height", 0.0, 2.0)
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.mark_sharp(*recorder.edges_of(box.top))
    recorder.extrude(box.top, 1e-14)
    recorder.mark_sharp(*recorder.edges_of(box.top))
    recorder.drag(box.top, 0.1, height="step")
    recorder.drag(box.top, -0.1)
    findings = validate_model(recorder.build(), variations=5)
    assert "component c0" in [finding.where for finding in findings if finding.check == "faces"]


def test_a_component_turned_inside_out_is_found() -> None:
    recorder = Recorder("inverted", "box")
    recorder.parameter("height", "Height", -1.0, 1.0)
    box = recorder.box(1.0, 1.0, 0.2)
    recorder.drag(box.top, 0.5, length="height")
    findings = validate_model(recorder.build(), variations=60)
    (finding,) = [finding for finding in findings if finding.check == "volume"]
    assert finding.where == "component c0"
    assert finding.values["height"] < -0.3


def test_a_component_that_floats_is_found() -> None:
    recorder = Recorder("flying_lid", "box")
    recorder.parameter("lift", "Lift", 0.0, 3.0)
    recorder.box(1.0, 1.0, 1.0)
    lid = recorder.box(1.0, 1.0, 0.2, offset=(0.0, 0.0, 0.55))
    upright = group(lid.whole, frame="world")
    recorder.drag(upright, 0.5, height="lift")
    recorder.drag(upright, -0.5)
    findings = validate_model(recorder.build(), variations=60)
    assert {finding.check for finding in findings} == {"together"}
    assert findings[0].values["lift"] > 1.5


def test_floating_clusters_are_told_by_component_however_few_pairs_fit_into_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recorder = Recorder("clusters", "box")
    for x in (0.0, 0.9, 1.8, 2.7, 5.0, 5.9, 9.0):
        recorder.box(1.0, 1.0, 1.0, offset=(x, 0.0, 0.0))
    compiled = compile_model(recorder.build())
    found = check_variations(compiled, np.ones((1, 0)))
    assert [(fault.check, fault.where) for fault in found] == [
        ("together", "component c4"), ("together", "component c5"), ("together", "component c6")
    ]  # fmt: skip
    monkeypatch.setattr(variation_checks, "_PAIRS", 1)
    assert check_variations(compiled, np.ones((1, 0))) == found


def test_a_model_too_large_to_be_subdivided_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shapewright.modeling.surface_levels.MAX_SURFACE_VERTICES", 20)
    assert "more than 20 vertices" in found(post().build())["topology"][0]


@pytest.mark.parametrize("times", [28, 60], ids=["large", "endless"])
def test_coordinates_without_bound_are_a_finding_and_no_warning(times: int) -> None:
    base, scale = stretched(0.5, 2.0, size=1e6).operations
    model = replace(stretched(0.5, 2.0), operations=(base, *[scale] * times))
    assert list(found(model, variations=2)) == ["finite"]


@pytest.mark.parametrize(
    ("model", "told"),
    [
        (stretched(0.02, 1.0), "too small"),
        (stretched(0.5, 30.0), "too large"),
        (stretched(0.001, 1.0, axes="z"), "flat"),
    ],
    ids=["small", "large", "flat"],
)
def test_an_extent_that_is_not_sane_is_found(model: ProceduralModel, told: str) -> None:
    findings = found(model, variations=400)
    assert set(findings) == {"extent"}
    assert told in " ".join(findings["extent"])


# ---------------------------------------------------------------------- effect


def test_a_parameter_without_effect_is_found() -> None:
    findings = found(stretched(0.999, 1.001))
    assert list(findings) == ["effect"]
    assert findings["effect"][0].startswith("size: it moves no vertex by more than 0.00")


def test_a_parameter_that_is_never_active_and_parts_that_never_change_are_found() -> None:
    recorder = Recorder("odd", "box")
    recorder.choice("kind", "Kind", ("one", "two"))
    recorder.parameter("height", "Height", 0.5, 2.0, active_when=[when("kind", 1.2, 1.8)])
    body = recorder.box(1.0, 1.0, 1.0)
    never = recorder.box(0.5, 0.5, 0.5)
    always = recorder.box(0.5, 0.5, 0.6)
    recorder.scale(body.whole, 1.0, size="height")
    recorder.part("never", [never], [when("kind", 1.2, 1.8)])
    recorder.part("always", [always], [when("kind", 1, 2)])
    compiled = compile_model(recorder.build())
    faults = effect_faults(compiled, compiled.random_values(np.random.default_rng(0), 50))
    assert [place for place, _ in faults] == ["kind", "height", "never", "always"]


def test_a_parameter_is_looked_at_where_it_is_active() -> None:
    recorder = Recorder("nested", "box")
    recorder.choice("kind", "Kind", ("plain", "with a knob", "with a ring"))
    recorder.switch("large", "Large knob", active_when=[when("kind", 2)])
    recorder.parameter("size", "Knob size", 0.5, 2.0, active_when=[when("large", 1)])
    recorder.box(1.0, 1.0, 1.0)
    knob = recorder.box(0.5, 0.5, 1.2)
    recorder.scale(knob.whole, 1.0, size="size")
    recorder.part("knob", [knob], [when("kind", 2)])
    space = compile_model(recorder.build()).space
    row = active_row(space, 2)
    assert row is not None
    assert row.tolist() == [2, 1, 1]
    assert distinct_values(space, 2, row)[:, 2].tolist() == [0.5, 2.0]
    assert distinct_values(space, 0, space.base_values())[:, 0].tolist() == [1, 2, 3]


def test_many_conditions_on_one_another_are_settled_in_one_pass() -> None:
    recorder = Recorder("chain", "box")
    recorder.box(1.0, 1.0, 1.0)
    for i in range(60):
        before = f"kind{i - 1}"
        conditions = [when(before, 2), when(before, 1.5, 2.5)] if i else []
        recorder.choice(f"kind{i}", "Kind", ("one", "two", "three"), active_when=conditions)
    space = compile_model(recorder.build()).space
    row = active_row(space, 59)
    assert row is not None
    assert row.tolist() == [2.0] * 59 + [1.0]


def test_a_choice_is_moved_to_an_option_within_the_condition() -> None:
    recorder = Recorder("nested", "box")
    recorder.choice("kind", "Kind", ("one", "two", "three", "four"))
    recorder.switch("knob", "Knob", active_when=[when("kind", 1.5, 2.5)])
    recorder.box(1.0, 1.0, 1.0)
    space = compile_model(recorder.build()).space
    for start in (1.0, 4.0):
        row = active_row(space, 1, np.array([start, 1.0]))
        assert row is not None
        assert row.tolist() == [2.0, 1.0]
