"""Where the surface distance measures an instance: evenly over its surface, at the same places of every instance."""

import numpy as np
import pytest
from chair_model import armchair
from scipy.spatial import cKDTree
from shipped_models import compiled_shipped

from models_store.library.shipped import list_shipped
from shapewright.distances.surface import uniform_points
from shapewright.estimation import EstimationSettings, Query
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.surface_samples import LEAST_SAMPLES, SurfaceSamples, spread_samples
from shapewright.modeling import CompiledModel, compile_model


@pytest.fixture(scope="module")
def chair() -> CompiledModel:
    return compile_model(armchair())


@pytest.fixture(scope="module")
def samples(chair: CompiledModel) -> SurfaceSamples:
    return spread_samples(chair, 2)


@pytest.mark.parametrize("name", list(list_shipped()))
def test_a_base_instance_passes_both_thresholds_against_itself(name: str) -> None:
    compiled = compiled_shipped(name)
    settings = EstimationSettings(image_size=64)
    instance = compiled.instance(compiled.base_values())
    comparison = Comparison(PreparedQuery(Query(instance), settings), compiled, settings)
    own = comparison.instance(compiled.base_values())
    assert len(own.samples) >= LEAST_SAMPLES
    distances = comparison.distances(own, comparison.initial_pose(own))
    assert distances.surface < settings.surface_threshold
    assert distances.zbuffer < settings.zbuffer_threshold


def test_samples_are_linear_in_the_vertices_and_the_same_each_time(
    chair: CompiledModel, samples: SurfaceSamples
) -> None:
    again = spread_samples(chair, 2)
    np.testing.assert_array_equal(samples.corners, again.corners)
    np.testing.assert_array_equal(samples.weights, again.weights)
    np.testing.assert_allclose(samples.weights.sum(axis=1), 1.0)
    assert (samples.weights >= 0).all()
    values = chair.random_values(np.random.default_rng(3), 2)
    own = samples.of_instance(np.ones(len(chair.model.parts), dtype=bool))
    first, second = chair.surface_points(values)
    half = own.points((first + second) / 2)
    np.testing.assert_allclose(half, (own.points(first) + own.points(second)) / 2, atol=1e-12)


def test_samples_lie_on_what_is_there_and_spread_over_all_of_it(chair: CompiledModel, samples: SurfaceSamples) -> None:
    for values in chair.random_values(np.random.default_rng(5), 12):
        instance = chair.instance(values)
        points = samples.of_instance(chair.parts_present(values[None])[0]).points(instance.vertices)
        dense = uniform_points(instance, 40_000, rng=np.random.default_rng(0))
        spacing = np.sqrt(instance.area / len(points))
        assert cKDTree(dense).query(points)[0].max() < spacing  # on the surface
        assert cKDTree(points).query(dense)[0].mean() < spacing  # and everywhere on it


def test_measuring_at_vertices_keeps_the_letter_of_the_paper(chair: CompiledModel) -> None:
    settings = EstimationSettings(surface_points=200, image_size=32, model_points="vertices")
    instance = chair.instance(chair.base_values())
    comparison = Comparison(PreparedQuery(Query(instance), settings), chair, settings)
    np.testing.assert_array_equal(comparison.instance(chair.base_values()).samples, instance.vertices)
