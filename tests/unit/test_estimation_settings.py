"""Settings of an estimation and the choice among the layers."""

import json

import numpy as np
import pytest

from shapewright.distances.alignment import AlignmentSettings, Pose
from shapewright.errors import EstimationError
from shapewright.estimation import Distances, EstimationSettings, Stage
from shapewright.estimation.verdict import choose


def test_defaults_are_the_papers() -> None:
    settings = EstimationSettings()
    assert (settings.samples, settings.surface_points, settings.image_size) == (10_000, 2000, 256)
    assert (settings.surface_threshold, settings.zbuffer_threshold) == (0.04, 0.7)
    assert settings.step_sizes == (1.0, 0.5, 0.25, 0.1, 0.01)
    assert settings.alignment == AlignmentSettings(0.01, 0.01 * np.pi, 0.01, (0.5, 1.5))


def test_quick_settings_are_coarser_and_keep_the_thresholds() -> None:
    quick, usual = EstimationSettings.quick(samples=300, seed=4), EstimationSettings()
    assert (quick.samples, quick.seed) == (300, 4)
    assert (quick.surface_threshold, quick.zbuffer_threshold) == (usual.surface_threshold, usual.zbuffer_threshold)
    assert quick.surface_points < usual.surface_points
    assert quick.alignment.translation_step > usual.alignment.translation_step


def test_settings_survive_json() -> None:
    settings = EstimationSettings(samples=7, step_sizes=(0.5, 0.1), alignment=AlignmentSettings(scale_step=0.02))
    assert EstimationSettings.from_dict(json.loads(json.dumps(settings.to_dict()))) == settings
    assert EstimationSettings.from_dict({}) == EstimationSettings()


@pytest.mark.parametrize(
    ("document", "where"),
    [
        ({"samples": 0}, "samples"),
        ({"image_size": 255}, "image_size"),
        ({"subdivision_steps": 5}, "subdivision_steps"),
        ({"seed": -1}, "seed"),
        ({"step_sizes": []}, "step_sizes"),
        ({"step_sizes": [0.1, 0.5]}, "step_sizes"),
        ({"step_sizes": [0.5, 0.0]}, "step_sizes"),
        ({"step_sizes": [float("inf"), 1.0]}, "step_sizes"),
        ({"surface_threshold": -1.0}, "surface_threshold"),
        ({"zbuffer_threshold": float("nan")}, "zbuffer_threshold"),
        ({"sample": 5}, "sample"),
        ({"alignment": {"steps": 1}}, "alignment.steps"),
        ({"alignment": {"scale_limits": [2.0, 3.0]}}, "scale_limits"),
    ],
)
def test_settings_that_make_no_sense_are_refused(document, where: str) -> None:
    with pytest.raises(EstimationError) as caught:
        EstimationSettings.from_dict(document)
    assert caught.value.where == where


@pytest.mark.parametrize("document", [{"step_sizes": "fast"}, {"step_sizes": 3}, {"alignment": {"scale_limits": 1}}])
def test_settings_of_a_wrong_type_are_refused(document) -> None:
    with pytest.raises(EstimationError):
        EstimationSettings.from_dict(document)


def stages(surface: float, first_zbuffer: float, second_zbuffer: float) -> tuple[Stage, ...]:
    def stage(name, distances: Distances) -> Stage:
        return Stage(name, np.ones(1), Pose(), distances)

    return (
        stage("panorama", Distances(0.1, 0.01, 0.1, 1.0)),
        stage("surface", Distances(0.1, surface, 0.1, 1.0)),
        stage("surface+zbuffer", Distances(0.1, 0.01, first_zbuffer, 1.0)),
        stage("zbuffer", Distances(0.1, 0.01, second_zbuffer, 1.0)),
    )


@pytest.mark.parametrize(
    ("surface", "first", "second", "answer"),
    [
        (0.01, 0.3, 0.4, "surface+zbuffer"),
        (0.01, 0.9, 0.4, "zbuffer"),
        (0.50, 0.69, 0.9, "surface+zbuffer"),
        (0.01, 0.7, 0.7, "surface"),
        (0.04, 0.7, 0.7, "panorama"),
    ],
)
def test_the_answer_is_the_last_adequate_layer(surface: float, first: float, second: float, answer: str) -> None:
    assert choose(stages(surface, first, second), EstimationSettings()).name == answer


def test_layers_that_were_not_reached_cannot_be_chosen() -> None:
    everything = stages(0.01, 0.3, 0.4)
    assert choose(everything[:1], EstimationSettings()).layer == 1
    assert choose(everything[:2], EstimationSettings()).layer == 2
    assert choose(everything[:3], EstimationSettings()).name == "surface+zbuffer"
    with pytest.raises(ValueError, match="layer 1"):
        choose((), EstimationSettings())
