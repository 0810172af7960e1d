"""Estimating with a class: the right model is found, and what depends on other values is respected."""

import weakref
from dataclasses import replace

import numpy as np
import pytest
from chair_model import armchair

from shapewright.distances.alignment import AlignmentSettings, Pose, rotations_24
from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation import (
    Estimation,
    EstimationCancelled,
    EstimationSettings,
    InstanceGenerator,
    PanoramaBank,
    build_bank,
    estimate,
)
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, Recorder, compile_model
from shapewright.progress import NULL_PROGRESS, CallbackProgress, Progress

SMALL = EstimationSettings(
    samples=100,
    surface_points=100,
    image_size=32,
    subdivision_steps=1,
    model_points="vertices",
    step_sizes=(0.5, 0.15),
    alignment=AlignmentSettings(0.1, 0.06 * np.pi, 0.1),
    estimator="reference",
)
TURN = Pose(rotations_24()[9], np.array([4.0, 0.0, -2.0]), 3.0)


def plank(name: str, length: float) -> CompiledModel:
    recorder = Recorder(name, "chair")
    box = recorder.box(length, 1.0, 0.2)
    recorder.extrude(box.top, 0.3, length="height")
    recorder.parameter("height", "Height", 0.5, 2.0)
    return compile_model(recorder.build())


@pytest.fixture(scope="module")
def generators() -> list[CompiledModel]:
    return [plank("plank", 3.0), compile_model(armchair()), plank("board", 5.0)]


@pytest.fixture(scope="module")
def banks(generators: list[CompiledModel]) -> dict[str, PanoramaBank]:
    return {one.model.digest: build_bank(one, SMALL.samples, subdivision_steps=1) for one in generators}


@pytest.fixture(scope="module")
def query(generators: list[CompiledModel]) -> TriangleMesh:
    """A low chair without armrests."""
    compiled = generators[1]
    values = compiled.values_from_mapping({"back": 1, "armrests": 0, "leg_length": 0.7, "ring_height": 0.4})
    return compiled.instance(values).transformed(TURN.rotation, TURN.translation, TURN.scale)


Reports = list[tuple[float, str]]


def run(query: TriangleMesh, generators, banks, progress: Progress = NULL_PROGRESS) -> Estimation:
    return estimate(query, generators, SMALL, progress=progress, banks=lambda one, _: banks[one.model.digest])


@pytest.fixture(scope="module")
def reports() -> Reports:
    return []


@pytest.fixture(scope="module")
def found(query: TriangleMesh, generators, banks, reports: Reports) -> Estimation:
    return run(query, generators, banks, CallbackProgress(lambda *report: reports.append(report)))


def test_the_model_that_made_the_query_is_found_and_its_answer_is_that_of_an_estimation(
    query: TriangleMesh, generators, banks, found: Estimation
) -> None:
    assert found.model.name == "armchair"
    alone = run(query, generators[1:2], banks)
    assert {**found.to_dict(), "tried": None} == {**alone.to_dict(), "tried": None}
    assert [one.distances is not None for one in found.tried] == [True, True, False]
    assert found.tried[0].panorama == alone.tried[0].panorama == min(one.panorama for one in found.tried)
    assert found.tried[0].distances == found.distances
    document = found.to_dict()
    assert document["tried"][0]["model"] == document["model"] == {"id": found.model.digest, "name": "armchair"}
    assert document["estimator"] == "reference"


def test_as_many_models_are_refined_as_the_settings_say(query: TriangleMesh, generators, banks) -> None:
    one = estimate(query, generators, replace(SMALL, refined_models=1), banks=lambda one, _: banks[one.model.digest])
    assert [tried.distances is not None for tried in one.tried] == [True, False, False]


def test_options_have_names_and_what_means_nothing_is_inactive(generators, found: Estimation) -> None:
    by_name = {parameter.name: parameter for parameter in found.parameters}
    assert by_name["back"].option == "low back"
    assert (by_name["armrests"].value, by_name["arm_height"].active) == (0.0, False)
    assert (by_name["arm_height"].value, by_name["leg_length"].active) == (1.0, True)
    assert by_name["ring_height"].maximum == pytest.approx(0.25 + 0.75 * by_name["leg_length"].value)
    for stage in found.stages:
        np.testing.assert_array_equal(generators[1].settle(stage.values[None])[0], stage.values)
    lacking = len(generators[1].surface_triangles()) - len(found.mesh.faces)
    assert lacking == 3 * 192  # three boxes of 6 faces, subdivided twice


def test_the_banks_of_far_models_are_let_go(query: TriangleMesh) -> None:
    many = [plank(f"plank_{n}", 2.0 + n) for n in range(5)]
    alive: list[weakref.ref[PanoramaBank]] = []

    def bank_of(generator: InstanceGenerator, progress: Progress) -> PanoramaBank:
        assert sum(reference() is not None for reference in alive) <= 1
        bank = build_bank(generator, 10, subdivision_steps=1)
        alive.append(weakref.ref(bank))
        return bank

    coarse = EstimationSettings(
        samples=10, surface_points=50, image_size=16, subdivision_steps=1, step_sizes=(1.0,),
        alignment=AlignmentSettings(0.3, 0.2 * np.pi, 0.3), estimator="reference",
    )  # fmt: skip
    estimate(query, many, coarse, banks=bank_of)
    assert len(alive) == 5


def cancelling(part: str, count: int = 1) -> Progress:
    seen = 0

    def report(fraction: float, message: str) -> None:
        nonlocal seen
        seen += part in message
        if seen >= count:
            raise Cancelled

    return CallbackProgress(report)


@pytest.mark.parametrize(
    ("part", "model", "stages"),
    [
        ("board: random instances", "armchair", 1),  # in the scan, after two of three
        ("armchair: layer 2:", "armchair", 2),
        ("layer 1: step", "armchair", 1),
    ],
)
def test_a_cancelled_estimation_keeps_its_best_so_far(
    query: TriangleMesh, generators, banks, part: str, model: str, stages: int
) -> None:
    with pytest.raises(EstimationCancelled) as caught:
        run(query, generators, banks, cancelling(part))
    best = caught.value.best
    assert best is not None
    assert (best.model.name, len(best.stages)) == (model, stages)
    assert not best.complete


def test_cancelled_in_the_scan_the_nearest_row_is_the_answer_as_it_is(query: TriangleMesh, generators, banks) -> None:
    with pytest.raises(EstimationCancelled) as caught:
        run(query, generators, banks, cancelling("board: random instances"))
    best = caught.value.best
    assert best is not None
    bank = banks[best.model.digest]
    row = int(np.abs(bank.values - best.values).sum(axis=1).argmin())
    np.testing.assert_array_equal(bank.values[row], best.values)
    assert best.distances.panorama == pytest.approx(best.tried[0].panorama, abs=1e-5)
    assert [(one.model.name, one.distances is None, one.panorama is None) for one in best.tried][-1] == (
        "board",
        True,
        True,
    )


def test_cancelled_in_the_second_model_the_first_one_counts(query: TriangleMesh, generators, banks, found) -> None:
    second = found.tried[1].model.name
    with pytest.raises(EstimationCancelled) as caught:
        run(query, generators, banks, cancelling(f"{second}: layer 2:"))
    best = caught.value.best
    assert best.model.name == "armchair"
    np.testing.assert_array_equal(best.values, found.values)
    assert not best.complete


def test_cancelled_while_the_first_bank_is_built(
    query: TriangleMesh, generators, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, generators, SMALL, progress=cancelling("instances: 0 of"))
    assert caught.value.best is None
    monkeypatch.setattr("shapewright.estimation.bank._CHUNK_BYTES", 24 * 50 * 50)
    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, generators, SMALL, progress=cancelling("instances: ", count=4))
    assert caught.value.best.model.name == "plank"


def test_progress_rises_and_names_the_model(found: Estimation, reports: Reports) -> None:
    fractions = [fraction for fraction, _ in reports]
    assert fractions == sorted(fractions)
    assert fractions[-1] == pytest.approx(1.0)
    titles = [message.split(":")[0] for _, message in reports]
    assert (titles[0], titles[-1]) == ("preparing the query", "estimated")
    assert set(titles[1:-1]) == {"plank", "armchair", "board"}


def test_refuses_no_models_and_a_foreign_bank(query: TriangleMesh, generators, banks) -> None:
    with pytest.raises(EstimationError, match="at least one model"):
        estimate(query, [], SMALL)
    foreign = banks[generators[0].model.digest]
    with pytest.raises(EstimationError, match="another model"):
        estimate(query, generators[1:], SMALL, banks=lambda *_: foreign)
