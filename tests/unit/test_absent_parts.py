"""A part that an instance lacks leaves no trace: pictures, descriptors and distances are those of the rest alone."""

import numpy as np
import pytest
from chair_model import armchair

from shapewright.classification.pictures import draw
from shapewright.classification.series import series_generators
from shapewright.distances.alignment import Pose, rotations_24
from shapewright.distances.panorama import panorama_descriptor, panorama_descriptors
from shapewright.distances.surface import SurfaceDistance, poisson_disk_points
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.estimation import EstimationSettings
from shapewright.estimation.comparison import Comparison
from shapewright.estimation.prepared_query import PreparedQuery
from shapewright.estimation.query import Query
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, compile_model
from shapewright.rendering.styles import PictureStyle
from shapewright.training import TrainingSettings
from shapewright.training.chunks import Chunk, chunk_images
from shapewright.training.sources import ModelSource


@pytest.fixture(scope="module")
def chair() -> CompiledModel:
    return compile_model(armchair())


@pytest.fixture(scope="module")
def rows(chair: CompiledModel) -> np.ndarray:
    """All combinations of options, the rest random."""
    rng = np.random.default_rng(3)
    choices = [{"back": back, "armrests": armrests} for back in (1, 2, 3) for armrests in (0, 1)]
    return np.concatenate([chair.random_values(rng, 1, fixed) for fixed in choices])


def rebuilt_from_scratch(chair: CompiledModel, row: np.ndarray) -> TriangleMesh:
    """A row of a batch without its faces of no area, as for files of others: that knows nothing of parts."""
    return TriangleMesh(chair.surface_points(row[None])[0], chair.surface_triangles()).cleaned()


@pytest.mark.parametrize("style", ["splats", "fused"])
def test_learning_pictures_are_those_of_single_instances(chair: CompiledModel, style: PictureStyle) -> None:
    count = 16
    settings = TrainingSettings(images_per_variation=2, image_size=96, style=style, broken=0.0)
    source = ModelSource(chair)
    chunk = Chunk(source, 0, count)
    values = source.values(series_generators(settings.seed, source.digest, 0)[0], count)
    rotations, scales = chunk.views(settings)
    assert not chair.parts_present(values).all()
    alone = [chair.instance(row) for row in values]
    shown = np.repeat(np.arange(count), 2)
    pictures = draw(alone, rotations.reshape(-1, 3, 3), scales.reshape(-1), settings.look, shown=shown)
    np.testing.assert_array_equal(chunk_images(chunk, settings), pictures)


def test_an_instance_is_the_cleaned_batch(chair: CompiledModel, rows: np.ndarray) -> None:
    for row in rows:
        instance, cleaned = chair.instance(row), rebuilt_from_scratch(chair, row)
        assert len(instance.faces) == len(cleaned.faces)
        np.testing.assert_allclose(instance.triangles, cleaned.triangles, atol=1e-12)
        np.testing.assert_allclose(instance.vertex_mean, cleaned.vertex_mean, atol=1e-9)
        assert instance.is_watertight


def test_descriptors_of_a_batch_are_those_of_single_instances(chair: CompiledModel, rows: np.ndarray) -> None:
    batch = panorama_descriptors(chair.surface_points(rows), chair.surface_triangles()).to_array()
    for row, descriptor in zip(rows, batch, strict=True):
        instance = chair.instance(row)
        alone = panorama_descriptor(instance.vertices, instance.faces).to_array()
        np.testing.assert_allclose(descriptor, alone, atol=2e-5)


def test_depth_images_of_a_batch_are_those_of_single_instances(chair: CompiledModel, rows: np.ndarray) -> None:
    query = chair.instance(rows[0]).normalized().mesh
    target = ZBufferTarget(query.vertices, query.faces, 64)
    pose = Pose(rotations_24()[5], np.array([0.05, 0.0, -0.1]), 0.6)
    for row, points in zip(rows, chair.surface_points(rows), strict=True):
        instance = chair.instance(row)
        alone = target.distance(pose.apply(instance.vertices), instance.faces)
        together = target.distance(pose.apply(points), chair.surface_triangles())
        assert alone.raw == pytest.approx(together.raw, rel=1e-9)


def test_an_estimation_measures_what_is_there(chair: CompiledModel, rows: np.ndarray) -> None:
    """A vertex mean or a mean over vertices that knew absent parts would give other poses and distances."""
    query = chair.instance(rows[1])
    settings = EstimationSettings(samples=1, surface_points=200, image_size=64, model_points="vertices")
    comparison = Comparison(PreparedQuery(Query(query), settings), chair, settings)
    normal = query.normalized().mesh
    surface = SurfaceDistance(poisson_disk_points(normal, 200, rng=np.random.default_rng(0).spawn(2)[1]))
    zbuffer = ZBufferTarget(normal.vertices, normal.faces, 64)
    for row in rows:
        cleaned = rebuilt_from_scratch(chair, row)
        instance = comparison.instance(row)
        pose = comparison.initial_pose(instance)
        placed = cleaned.normalized().mesh
        np.testing.assert_allclose(pose.apply(cleaned.vertices), placed.vertices, atol=1e-9)
        measured = comparison.distances(instance, pose)
        assert measured.surface == pytest.approx(surface(placed.vertices), rel=1e-9)
        assert measured.zbuffer == pytest.approx(zbuffer.distance(placed.vertices, placed.faces).normalized, rel=1e-6)
    own = comparison.instance(rows[1])
    assert comparison.distances(own, comparison.initial_pose(own)).zbuffer == pytest.approx(0, abs=1e-9)
