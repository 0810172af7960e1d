"""What a shell says of an estimation."""

import io
from typing import Any, get_args

import numpy as np
import pytest
from ell_generator import EllGenerator
from rich.console import Console

from cli import estimate as verb
from cli.estimation_text import LAYERS, print_estimation
from cli.report import STATUS_TEXTS
from shapewright.estimation import EstimationSettings, estimate
from shapewright.estimation.query import AXES, UNITS
from shapewright.estimation.result import Layer, ParameterStatus
from shapewright.estimation.settings import EstimatorName

COARSE = EstimationSettings(
    samples=20, surface_points=100, image_size=16, model_points="vertices", step_sizes=(0.5,), estimator="reference"
)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    generator = EllGenerator("length")
    return estimate(generator.mesh(np.array([1.2])), generator, COARSE).to_dict()


def printed(document: dict[str, Any]) -> str:
    console = Console(file=io.StringIO(), width=140, highlight=False)
    print_estimation(console, document, seconds=2.0)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def test_options_and_texts_are_those_of_the_library() -> None:
    assert set(verb.UNITS) == set(UNITS)
    assert set(verb.AXES) == set(AXES)
    assert set(verb.ESTIMATORS) == set(get_args(EstimatorName))
    assert set(STATUS_TEXTS) == set(get_args(ParameterStatus))
    assert set(LAYERS) == set(get_args(Layer))


def test_an_answer_of_the_reference_has_no_columns_that_it_cannot_fill(document: dict[str, Any]) -> None:
    text = printed(document)
    assert "ell rebuilds the mesh" in text
    assert f"Layer {document['layer']} of 3" in text
    assert "reference estimator" in text
    assert "interval" not in text
    assert "Other answers" not in text


def test_what_is_known_stands_beside_each_value(document: dict[str, Any]) -> None:
    parameter = {**document["parameters"][0], "value": 1.2, "status": "determined_up_to_scale", "interval": [1.1, 1.3]}
    residuals = {
        "tolerance": 0.04, "mean": 0.1, "followed_share": 0.8, "invented_share": 0.1,
        "by_part": [
            {"name": "handle", "share_of_area": 0.2, "mean": 0.2, "p95": 0.3, "invented_share": 0.5},
            {"name": "cup", "share_of_area": 0.8, "mean": 0.0, "p95": 0.0, "invented_share": 0.0},
        ],
    }  # fmt: skip
    failed = [{"name": "zbuffer", "value": 0.81, "threshold": 0.7}]
    ratio = {"numerator": "a", "denominator": "b", "label": "Stem : Bowl", "value": 1.5, "interval": [1.4, 1.6]}
    text = printed(
        {
            **document,
            "layer": 2,
            "complete": False,
            "parameters": [parameter],
            "ratios": [{**ratio, "status": "determined"}],
            "alternatives": [
                {"kind": "pose", "label": "upside down", "distances": {**document["distances"], "zbuffer": 0.82}}
            ],
            "verdict": {"layer": 2, "failed": failed, "residuals": residuals},
        }
    )
    for expected in (
        "stopped before its end",
        "11 … 13 mm",
        "up to scale",
        "Stem : Bowl = 1.5 (90 %: 1.4 … 1.6)",
        "1. upside down, z-buffer distance 0.82",
        "z-buffer distance is 0.81; it should be below 0.7",
        "follows 80 % of the mesh",
        "handle (50 % of it)",
    ):
        assert expected in text


def test_a_stopped_search_says_what_it_did_not_reach(document: dict[str, Any]) -> None:
    tried = [
        {"model": {"id": "a", "name": "cup"}, "distances": document["distances"], "panorama": 0.1},
        {"model": {"id": "b", "name": "mug"}, "distances": None, "panorama": None},
    ]
    stopped = {
        **document,
        "layer": 1,
        "complete": False,
        "tried": tried,
        "verdict": {"layer": 1, "failed": [], "residuals": None},
    }
    text = printed(stopped)
    assert "had not come to the layers above" in text
    assert "Not fitted, as others were nearer or their turn had not come: mug." in text
