"""The annotations of the paper's eight objects: whole, true to their models, and what their scripts say."""

import importlib
import json
from dataclasses import replace
from pathlib import Path

import pytest

import models_store.library
from models_store.library.annotations import (
    ANNOTATIONS,
    AnnotatingRecorder,
    Annotation,
    Group,
    Judgement,
    Variation,
    variations_of,
)
from models_store.library.shipped import load_shipped
from shapewright.errors import ModelError
from shapewright.modeling import ProceduralModel

PATHS = {path.parent.name: path for path in Path(models_store.library.__file__).parent.glob(f"*/*/{ANNOTATIONS}")}
NAMES = sorted(PATHS)

every_object = pytest.mark.parametrize("name", NAMES)


def read(name: str) -> Annotation:
    return Annotation.from_json(PATHS[name].read_bytes())


def test_the_objects_of_table_2_are_annotated() -> None:
    assert set(NAMES) == {"airplane", "ship", "stool", "animal", "spaceship", "tower", "humanoid", "chair"}


@every_object
def test_an_annotation_is_about_every_variation_of_its_model(name: str) -> None:
    read(name).check(load_shipped(name))


@every_object
def test_the_script_says_the_same(name: str) -> None:
    script = importlib.import_module(f"models_store.library.{load_shipped(name).class_name}.{name}.build")
    shipped = read(name)
    assert script.model().annotation() == shipped
    assert Annotation.from_json(shipped.to_json()) == shipped


@every_object
def test_both_answers_occur_and_groups_too(name: str) -> None:
    annotation = read(name)
    assert 5 <= len(annotation.important) < len(annotation.judgements)
    assert len(annotation.groups) >= 3


@every_object
def test_variations_that_belong_together_are_judged_alike(name: str) -> None:
    annotation = read(name)
    for group in annotation.groups:
        assert len({member in annotation.important for member in group.members}) == 1, group.label


def two_legs() -> AnnotatingRecorder:
    recorder = AnnotatingRecorder("legs", "stool")
    recorder.parameter("length", "Length", 0.5, 2.0)
    for sign in (1.0, -1.0):
        leg = recorder.box(0.1, 0.1, 0.2, offset=(sign, 0.0, 0.0))
        recorder.extrude(leg.top)  # by nothing: there is nothing to judge
        recorder.judge("length", important=True, direction="lean")
        recorder.extrude(leg.top, 1.0, 0.5, 90.0 * sign, length="length")
        recorder.judge("thickness", important=False)
        recorder.scale(leg.whole, 1.0)
    return recorder


def legs() -> tuple[ProceduralModel, Annotation]:
    recorder = two_legs()
    return recorder.build(), recorder.annotation()


def test_headings_become_judgements_and_equal_labels_groups() -> None:
    model, annotation = legs()
    annotation.check(model)
    assert [(j.variation, j.label, j.important) for j in annotation.judgements[:3]] == [
        (Variation(2, "length"), "length", True),
        (Variation(2, "angle"), "lean", False),
        (Variation(3, "size"), "thickness", False),
    ]
    assert annotation.important == {Variation(2, "length"), Variation(6, "length")}
    assert [group.label for group in annotation.groups] == ["length", "lean", "thickness"]
    assert annotation.groups[0].members == (Variation(2, "length"), Variation(6, "length"))


def test_only_what_changes_something_is_judged() -> None:
    recorder = AnnotatingRecorder("box", "stool")
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.extrude(box.top)
    recorder.drag(box.top)
    recorder.rotate(box.top, 0.0)
    assert recorder.annotation().judgements == ()
    model, _ = legs()
    assert len(variations_of(model.operations)) == 6


def test_an_operation_without_a_heading_is_refused() -> None:
    recorder = AnnotatingRecorder("box", "stool")
    box = recorder.box(1.0, 1.0, 1.0)
    with pytest.raises(ModelError, match="nobody says"):
        recorder.extrude(box.top, 1.0)


def broken(annotation: Annotation, how: str) -> Annotation:
    first = annotation.judgements[0]
    group = annotation.groups[0]
    match how:
        case "not of":
            return replace(annotation, model="table")
        case "has no 'size'":
            other = Judgement(Variation(2, "size"), "length", True)
            return replace(annotation, judgements=(other, *annotation.judgements[1:]))
        case "operation 99":
            other = Judgement(Variation(99, "size"), "length", True)
            return replace(annotation, judgements=(other, *annotation.judgements[1:]))
        case "one for each":
            return replace(annotation, judgements=(first, *annotation.judgements))
        case "at least two":
            return replace(annotation, groups=(Group("one", group.members[:1]),))
        case "not judged":
            return replace(annotation, groups=(Group("far", (Variation(2, "length"), Variation(98, "length"))),))
        case "different kinds":
            return replace(annotation, groups=(Group("mixed", (Variation(2, "length"), Variation(3, "size"))),))
        case _:
            return replace(annotation, groups=(group, Group("again", group.members)))


@pytest.mark.parametrize(
    "how",
    [
        "not of",
        "has no 'size'",
        "operation 99",
        "one for each",
        "at least two",
        "not judged",
        "different kinds",
        "shares a member",
    ],
)
def test_an_annotation_that_does_not_fit_is_refused(how: str) -> None:
    model, annotation = legs()
    with pytest.raises(ModelError, match=how):
        broken(annotation, how).check(model)


@pytest.mark.parametrize(
    "change", [{"version": 2}, {"judgements": [{"operation": "2"}]}, {"groups": None}, {"model": ()}]
)
def test_a_document_that_is_no_annotation_is_refused(change: dict[str, object]) -> None:
    document = json.loads(legs()[1].to_json()) | change
    if change == {"model": ()}:
        del document["model"]
    with pytest.raises(ModelError):
        Annotation.from_json(json.dumps(document))
    with pytest.raises(ModelError):
        Annotation.from_json("{")
    for text in (b"\xff", "[" * 100_000, "[]", "null", '{"format": "shapewright-annotations", "version": 1}'):
        with pytest.raises(ModelError, match="not an annotation"):
            Annotation.from_json(text)
