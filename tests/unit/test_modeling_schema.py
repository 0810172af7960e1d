"""The published schema and the reader agree: what one takes the other takes, as far as a schema can say."""

import copy
import json
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.errors import ModelError
from shapewright.modeling import Element, ProceduralModel, Recorder, json_schema, mirrored, turned, when
from shapewright.modeling.elements import edge, vertex

SCHEMA = jsonschema.Draft202012Validator(dict(json_schema()))

BEYOND_A_SCHEMA = (
    "excludes 1, the base model, or is empty",  # of a range [1, 1]
    "every extent of a base must be above 0",
    "the tube of a ring must be thinner",
    "lambda1 must lie between",
    "there is no operation",
    "has no mode",
    "a second parameter",
    "one whole number for each of its options",
    "must begin at a whole number",
    "neither limits nor a base value",
    "there is no parameter",
    "never comes there",
    "has an empty or endless range",  # of a condition, [2, 1]
    "shuts out 1, the base model",
    "the limit leaves no value",
    "must consist of components",
    "only components can be apart",
    "an axis needs an order above 1",
)


def every_operation() -> dict[str, Any]:
    """Return a document with every operation and every kind of field."""
    recorder = Recorder("all", "all", description="every operation", closed=False)
    recorder.parameter("height", "Height", 0.5, 2, unit="cm", base_value=45)
    recorder.parameter("depth", "Depth", 0.25, 2)
    box = recorder.box(1, 1, 1)
    top, right, left = box.top, box.sides[1], box.sides[3]
    recorder.extrude([right, mirrored("x", left)], 1, length="height")
    recorder.rotation_extrude(top, recorder.edges_of(top)[0], 20, 1)
    inserted = recorder.insert_vertex(edge(0), (edge(1), True), lambda1=0.3)
    recorder.drag(right, 0.1, length="depth")
    recorder.scale(right, 0.5, "uv", pivot=top)
    recorder.rotate(right, 30)
    recorder.mark_sharp(top, vertex(0))
    recorder.base("prism", (1, 1, 1), sides=6, anchors=[top, turned("z", 120, top)])
    recorder.remove(inserted[0])
    corners = recorder.vertices_of(box.bottom)
    recorder.connect(corners[0], corners[2])
    recorder.choice("kind", "Kind", ("one", "two"))
    recorder.switch("lid", "Lid", active_when=[when("kind", 1, 2), when("height", 1, 2)])
    recorder.limit("depth", minimum=("height", 0, 0.5), maximum=("height", 1, 1))
    recorder.part("lid", [recorder.box(0.5, 0.5, 0.1)], [when("lid", 1)])
    recorder.symmetry(mirrors="xy", axis="z", order=2, apart=[Element("component", 0)])
    document: dict[str, Any] = json.loads(recorder.build().to_json())
    return document


DOCUMENT = every_operation()


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the path of every value inside a document."""
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield (*path, key)
        yield from places(child, (*path, key))


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.sampled_from([0, 1, 2, 3, 4.0, 4.5, -0.0, -1, 257, 10**6, 10**6 + 1, 10**400, 1e300])
    | st.sampled_from(["", " ", "f0", "-e0", "e01", "-f0", "c0", "world", "own", "x", "z", "length", "box", "ring"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["elements", "mirror"]), inner),
    max_leaves=3,
)


@st.composite
def changed_documents(draw: st.DrawFn) -> Any:
    """Draw the document with one value replaced, removed, or put in where there was none."""
    document = copy.deepcopy(DOCUMENT)
    path = draw(st.sampled_from(list(places(document))))
    holder: Any = document
    for key in path[:-1]:
        holder = holder[key]
    action = draw(st.sampled_from(["replace", "remove", "add", "again"]))
    if action == "remove":
        del holder[path[-1]]
    elif action == "replace":
        holder[path[-1]] = draw(json_values)
    elif isinstance(holder, list):
        holder.append(copy.deepcopy(holder[path[-1]]) if action == "again" else draw(json_values))
    else:
        added = draw(st.sampled_from(["frame", "image", "surprise", "unit", "sharp", "options", "limits"]))
        holder[added] = draw(json_values)
    return document


def refusal(document: Any) -> ModelError | None:
    """Return why the reader refuses a document."""
    try:
        ProceduralModel.from_document(document)
    except ModelError as error:
        return error
    return None


@settings(max_examples=400, deadline=None)
@given(changed_documents())
def test_reader_and_schema_agree(document: Any) -> None:
    error = refusal(document)
    if error is None:
        SCHEMA.validate(document)
        model = ProceduralModel.from_document(document)
        again = ProceduralModel.from_json(model.to_json())
        assert again == model
        assert again.to_json() == model.to_json()
    else:
        assert len(str(error)) < 500
        assert any(rule in error.message for rule in BEYOND_A_SCHEMA) or not SCHEMA.is_valid(document), error


def test_whole_numbers_and_floats_write_the_same_document() -> None:
    def document(number: type[int] | type[float]) -> str:
        recorder = Recorder("a", "a")
        recorder.parameter("h", "h", number(0), number(2), base_value=number(45))
        box = recorder.box(number(1), number(1), number(1))
        recorder.extrude([box.top, turned("z", number(90), box.bottom)], number(1), length="h")
        return recorder.build().to_json()

    assert document(int) == document(float)
    assert ProceduralModel.from_json(document(int)).to_json() == document(int)


def test_equal_models_have_equal_texts_whatever_the_sign_of_zero() -> None:
    plus, minus = copy.deepcopy(DOCUMENT), copy.deepcopy(DOCUMENT)
    plus["operations"][1]["rho"], minus["operations"][1]["rho"] = 0.0, -0.0
    first, second = ProceduralModel.from_document(plus), ProceduralModel.from_document(minus)
    assert first == second
    assert first.digest == second.digest


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), 1e9])
def test_a_recorder_takes_no_number_that_a_document_could_not_hold(wrong: float) -> None:
    recorder = Recorder("a", "a")
    box = recorder.box(1, 1, 1)
    with pytest.raises(ModelError) as caught:
        recorder.extrude(box.top, wrong)
    assert caught.value.where == "operations[1].z"
    with pytest.raises(ModelError, match="base value"):
        recorder.parameter("a", "a", 0, 2, base_value=wrong)
    with pytest.raises(ModelError, match="unit"):
        recorder.parameter("a", "a", 0, 2, unit="x" * 21)


def test_a_number_too_large_for_a_float_is_refused_with_its_place() -> None:
    document = copy.deepcopy(DOCUMENT)
    document["parameters"][0]["range"][1] = 10**400
    with pytest.raises(ModelError, match="beyond") as caught:
        ProceduralModel.from_json(json.dumps(document))
    assert caught.value.where == "parameters[0].range[1]"


def test_a_recorder_takes_no_name_that_a_document_could_not_hold() -> None:
    for name, class_name, description, where in (
        ("My glass", "glass", "", "name"),
        ("glass", "../glass", "", "class"),
        ("glass", "glass", "x" * 5001, "description"),
    ):
        recorder = Recorder(name, class_name, description=description)
        recorder.box(1, 1, 1)
        with pytest.raises(ModelError) as caught:
            recorder.build()
        assert caught.value.where == where
