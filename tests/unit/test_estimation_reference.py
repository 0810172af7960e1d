"""The reference estimator from end to end, on a tiny model."""

import json
from pathlib import Path

import numpy as np
import pytest
from ell_generator import EllGenerator

from shapewright.distances.alignment import AlignmentSettings, Pose, rotations_24
from shapewright.errors import Cancelled, EstimationError, MeshError
from shapewright.estimation import (
    Estimation,
    EstimationCancelled,
    EstimationSettings,
    PanoramaBank,
    build_bank,
    estimate,
)
from shapewright.mesh import TriangleMesh
from shapewright.progress import CallbackProgress

SMALL = EstimationSettings(
    samples=60,
    surface_points=300,
    image_size=64,
    model_points="vertices",  # fewer, and as even: the boxes are subdivided
    step_sizes=(0.5, 0.1, 0.02),
    alignment=AlignmentSettings(0.03, 0.03 * np.pi, 0.03),
    estimator="reference",
)
COARSE = EstimationSettings(  # where only the course of the work matters
    samples=60,
    surface_points=150,
    image_size=32,
    model_points="vertices",
    step_sizes=(0.5, 0.1),
    alignment=AlignmentSettings(0.08, 0.05 * np.pi, 0.08),
    estimator="reference",
)
TRUTH = np.array([1.35, 0.8])
TURN = Pose(rotations_24()[14], np.array([40.0, -3.0, 12.0]), 7.5)


@pytest.fixture(scope="module")
def generator() -> EllGenerator:
    return EllGenerator("length", "height")


@pytest.fixture(scope="module")
def bank(generator: EllGenerator) -> PanoramaBank:
    return build_bank(generator, SMALL.samples)


@pytest.fixture(scope="module")
def query(generator: EllGenerator) -> TriangleMesh:
    return generator.mesh(TRUTH, TURN)


@pytest.fixture(scope="module")
def estimation(generator: EllGenerator, bank: PanoramaBank, query: TriangleMesh) -> Estimation:
    return estimate(query, generator, SMALL, banks=lambda *_: bank)


def test_known_parameters_and_pose_are_estimated_back(
    generator: EllGenerator, query: TriangleMesh, estimation: Estimation
) -> None:
    assert estimation.layer == 3
    assert estimation.complete
    assert estimation.distances.zbuffer < 0.08
    np.testing.assert_allclose(estimation.values, TRUTH, atol=0.1)
    np.testing.assert_allclose(estimation.pose.rotation, TURN.rotation, atol=0.1)
    assert estimation.pose.scale == pytest.approx(TURN.scale, rel=0.06)
    size = np.ptp(query.vertices, axis=0).max()
    np.testing.assert_allclose(estimation.mesh.vertices, query.vertices, atol=0.05 * size)


def test_the_pose_takes_the_instance_to_the_fitted_mesh(generator: EllGenerator, estimation: Estimation) -> None:
    instance = generator.mesh(estimation.values)
    np.testing.assert_allclose(estimation.pose.apply(instance.vertices), estimation.mesh.vertices, atol=1e-9)


def test_stages_are_the_four_optimisations_and_improve_what_they_optimise(estimation: Estimation) -> None:
    panorama, surface, first, second = estimation.stages
    assert [stage.name for stage in estimation.stages] == ["panorama", "surface", "surface+zbuffer", "zbuffer"]
    assert [stage.layer for stage in estimation.stages] == [1, 2, 3, 3]
    assert surface.distances.surface <= panorama.distances.surface
    assert first.distances.zbuffer <= surface.distances.zbuffer
    assert second.distances.zbuffer <= panorama.distances.zbuffer
    best = min((first, second), key=lambda stage: stage.distances.zbuffer)
    assert estimation.distances == best.distances


def test_the_answer_is_plain_json_and_names_its_parameters(estimation: Estimation) -> None:
    document = json.loads(json.dumps(estimation.to_dict()))
    assert document["layer"] == 3
    assert [item["name"] for item in document["parameters"]] == ["length", "height"]
    assert document["parameters"][0]["value"] == estimation.values[0]
    assert estimation.parameters[0].displayed_value == pytest.approx(10 * estimation.values[0])
    assert len(document["stages"]) == 4
    assert set(document["distances"]) == {"panorama", "surface", "zbuffer", "zbuffer_raw"}


def test_the_same_seed_gives_the_same_answer_from_a_mapped_bank_too(
    generator: EllGenerator, query: TriangleMesh, bank: PanoramaBank, estimation: Estimation, tmp_path: Path
) -> None:
    bank.save(tmp_path / "bank.npz")
    again = estimate(query, generator, SMALL, banks=lambda *_: PanoramaBank.load(tmp_path / "bank.npz"))
    assert again.to_dict() == estimation.to_dict()


def test_alignment_probes_generate_nothing(generator: EllGenerator, query: TriangleMesh, bank: PanoramaBank) -> None:
    generator.generated = 0
    probes = 0

    def count(fraction: float, message: str) -> None:
        nonlocal probes
        probes += 1

    estimate(query, generator, COARSE, banks=lambda *_: bank, progress=CallbackProgress(count))
    assert generator.generated < probes  # a realignment of several rounds reports each, and generates once


def test_progress_rises_and_tells_layer_and_distance(generator: EllGenerator, query: TriangleMesh) -> None:
    reports: list[tuple[float, str]] = []
    estimate(query, generator, COARSE, progress=CallbackProgress(lambda *report: reports.append(report)))
    fractions = [fraction for fraction, _ in reports]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0.0, 1.0)
    text = "\n".join(message for _, message in reports)
    for expected in (
        "ell: random instances: 0 of 60",
        "layer 1: step 0.5, panorama distance 0.",
        "orientation 24 of 24, surface distance 0.",
        "layer 2: step 0.5, surface distance 0.",
        "layer 3 after layer 2: step 0.1, z-buffer distance 0.",
        "layer 3 after layer 1: step",
    ):
        assert expected in text


@pytest.mark.parametrize(
    ("phase", "layers", "poorest"),
    [
        ("layer 1:", [1], 1),
        ("orientation 3", [1], 1),
        ("layer 2:", [1, 2], 1),
        ("layer 3 after layer 2:", [1, 2, 3], 3),
        ("layer 3 after layer 1:", [1, 2, 3, 3], 3),
    ],
)
def test_a_cancelled_estimation_keeps_its_best_so_far(
    generator: EllGenerator, query: TriangleMesh, bank: PanoramaBank, phase: str, layers: list[int], poorest: int
) -> None:
    seen = 0

    def cancel_in_phase(fraction: float, message: str) -> None:
        nonlocal seen
        seen += phase in message
        if seen == 4:
            raise Cancelled

    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, generator, COARSE, banks=lambda *_: bank, progress=CallbackProgress(cancel_in_phase))
    best = caught.value.best
    assert isinstance(caught.value, Cancelled)
    assert best is not None
    assert not best.complete
    assert [stage.layer for stage in best.stages] == layers
    assert best.layer >= poorest
    assert np.isfinite(list(best.distances.to_dict().values())).all()
    assert (generator.minimum <= best.values).all()
    assert (best.values <= generator.maximum).all()


def test_cancelled_while_the_bank_is_built(
    generator: EllGenerator, query: TriangleMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    def cancel_at(part: str):
        def report(fraction: float, message: str) -> None:
            if part in message:
                raise Cancelled

        return CallbackProgress(report)

    monkeypatch.setattr("shapewright.estimation.bank._CHUNK_BYTES", 24 * 20 * 196)
    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, generator, COARSE, progress=cancel_at("40 of 60"))
    assert caught.value.best is not None
    assert caught.value.best.layer == 1
    with pytest.raises(EstimationCancelled) as caught:
        estimate(query, generator, COARSE, progress=cancel_at("instances: 0 of 60"))
    assert caught.value.best is None


def test_a_model_without_parameters_is_only_posed() -> None:
    rigid = EllGenerator()
    answer = estimate(rigid.mesh(np.empty(0), TURN), rigid, SMALL)
    assert answer.values.shape == (0,)
    assert answer.parameters == ()
    assert answer.distances.zbuffer < 0.05
    np.testing.assert_allclose(answer.pose.rotation, TURN.rotation, atol=0.1)


def test_soup_is_a_query_like_any_other(generator: EllGenerator, query: TriangleMesh, bank: PanoramaBank) -> None:
    rng = np.random.default_rng(8)
    corners = query.triangles[rng.random(len(query.faces)) < 0.97]
    flipped = np.where(rng.random(len(corners))[:, None, None] < 0.5, corners, corners[:, ::-1])
    soup = TriangleMesh(flipped.reshape(-1, 3), np.arange(flipped.size // 3).reshape(-1, 3))
    answer = estimate(soup, generator, SMALL, banks=lambda *_: bank)
    np.testing.assert_allclose(answer.values, TRUTH, atol=0.15)
    assert answer.layer == 3


def test_refuses_a_point_and_a_foreign_bank(generator: EllGenerator, query: TriangleMesh, bank: PanoramaBank) -> None:
    point = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(MeshError):
        estimate(point, generator, SMALL, banks=lambda *_: bank)
    foreign = PanoramaBank(bank.values, bank.descriptors, "another model")
    with pytest.raises(EstimationError, match="another model"):
        estimate(query, generator, SMALL, banks=lambda *_: foreign)
