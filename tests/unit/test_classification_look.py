"""The look of pictures: values that make sense, and their way through JSON."""

import json
from dataclasses import replace

import pytest

from shapewright.classification.look import Look
from shapewright.errors import ClassifierError
from shapewright.rendering.styles import FRAMINGS, PICTURE_STYLES

SPLATS = Look("splats", 128, "sphere", 1.0, (0.7, 1.0))
TRIANGLES = Look("fused", 64, "paper", 2.0, (0.8, 2.0))


@pytest.mark.parametrize("look", [SPLATS, TRIANGLES])
def test_a_look_survives_json(look: Look) -> None:
    assert Look.from_dict(json.loads(json.dumps(look.to_dict()))) == look
    assert Look.from_dict(look.to_dict() | {"name of a later version": 1}) == look


@pytest.mark.parametrize("style", PICTURE_STYLES)
@pytest.mark.parametrize("framing", FRAMINGS)
@pytest.mark.parametrize("window", [1.0, 2.0])
def test_splats_know_one_framing_and_one_window(style, framing, window: float) -> None:
    def made() -> Look:
        return Look(style, 128, framing, window, (1.0, 1.0))

    if style == "splats" and (framing, window) != ("sphere", 1.0):
        with pytest.raises(ClassifierError):
            made()
    else:
        assert made().style == style


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("image_size", 0),
        ("framing", "paper"),
        ("window", 2.0),
        ("window", 0.0),
        ("window", float("nan")),
        ("scale_range", (1.0, 0.5)),
        ("scale_range", (0.0, 1.0)),
        ("scale_range", (float("nan"), 1.0)),
    ],
)
def test_values_that_make_no_sense_are_refused_by_name(name: str, value) -> None:
    with pytest.raises(ClassifierError) as caught:
        replace(SPLATS, **{name: value})
    assert caught.value.where == name
    assert repr(value) in str(caught.value)


@pytest.mark.parametrize("change", [{"style": "cubist"}, {"framing": "gold"}])
def test_unknown_names_are_refused(change: dict) -> None:
    with pytest.raises((ClassifierError, TypeError)):  # TypeError: the tests' checks of types come first
        Look.from_dict(SPLATS.to_dict() | change)


@pytest.mark.parametrize(
    "change", [{"scale_range": [1.0]}, {"scale_range": 1.0}, {"image_size": "large"}, {"window": None}]
)
def test_values_of_other_types_are_refused(change: dict) -> None:
    with pytest.raises((TypeError, ValueError)):
        Look.from_dict(SPLATS.to_dict() | change)


@pytest.mark.parametrize("name", SPLATS.to_dict())
def test_nothing_may_be_missing(name: str) -> None:
    values = SPLATS.to_dict()
    del values[name]
    with pytest.raises(KeyError):
        Look.from_dict(values)
