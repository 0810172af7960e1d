"""Noise of a query: when a surface is smoothed before it is searched for, and that this brings the shape back."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from shapewright.distances.even_places import even_places
from shapewright.distances.triangles import TriangleDistance
from shapewright.errors import Cancelled
from shapewright.estimation import EstimationSettings, Query, estimate
from shapewright.estimation.noise import FEWEST_VERTICES, without_noise
from shapewright.evaluation.anew import cut_anew
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges
from shapewright.modeling import CompiledModel, compile_model


def noisy(mesh: TriangleMesh, strength: float) -> TriangleMesh:
    return CORRUPTIONS["noise"](mesh, strength, np.random.default_rng(1))


def apart(mesh: TriangleMesh, truth: TriangleMesh) -> float:
    """Mean distance of even places of a mesh from another, as a share of the diagonal."""
    faces, weights = even_places(mesh.face_areas, 2000)
    points = np.einsum("nk,nkd->nd", weights, mesh.triangles[faces])
    return float(TriangleDistance(truth)(points).mean() / np.linalg.norm(np.ptp(truth.vertices, axis=0)))


@pytest.fixture(scope="module")
def glass(library_models) -> CompiledModel:
    return compile_model(library_models["glass_with_stem"])


@pytest.fixture(scope="module")
def goblet(glass: CompiledModel) -> TriangleMesh:
    return glass.instance(glass.base_values())


def box() -> TriangleMesh:
    return cut_edges(TriangleMesh.from_trimesh(trimesh.creation.box((1.0, 2.0, 3.0))), 0.1)


def wavy() -> TriangleMesh:
    """A sphere with waves that are several edges long: a shape, and no noise."""
    sphere = trimesh.creation.icosphere(4)
    waves = 0.02 * np.sin(12.0 * sphere.vertices).sum(axis=1)
    return TriangleMesh(sphere.vertices * (1.0 + waves)[:, None], sphere.faces)


@pytest.mark.parametrize("strength", [0.002, 0.005, 0.01])
def test_noise_is_smoothed_away_and_the_shape_comes_back(goblet, strength):
    rough = noisy(goblet, strength)
    smooth = without_noise(rough)
    assert apart(smooth, goblet) < 0.6 * apart(rough, goblet)
    np.testing.assert_allclose(smooth.bounds, goblet.bounds, atol=4.0 * strength * np.ptp(goblet.vertices))


def test_flat_faces_get_flat_again():
    rough = noisy(box(), 0.005)
    up = np.abs(without_noise(rough).face_normals).max(axis=1)
    assert np.median(np.abs(rough.face_normals).max(axis=1)) < 0.98 < 0.995 < np.median(up)


@pytest.mark.parametrize("make", [box, wavy], ids=["box", "waves"])
def test_a_surface_without_noise_stays_as_it_is(make):
    mesh = make()
    assert len(mesh.vertices) >= FEWEST_VERTICES
    assert without_noise(mesh) is mesh


@pytest.mark.parametrize("name", ["glass_with_stem", "bicycle", "table", "spider", "gun_rifle"])
def test_instances_of_models_have_no_noise(library_models, name):
    compiled = compile_model(library_models[name])
    rng = np.random.default_rng(3)
    for values in compiled.random_values(rng, 2):
        mesh = cut_anew(compiled.instance(values), rng)
        assert without_noise(mesh) is mesh


def test_what_has_no_neighbors_or_few_vertices_is_left_alone(goblet):
    rough = noisy(goblet, 0.005)
    soup = TriangleMesh(rough.triangles.reshape(-1, 3), np.arange(3 * len(rough.faces)).reshape(-1, 3))
    assert apart(without_noise(soup), goblet) < 0.6 * apart(rough, goblet), "equal positions are one vertex"
    rng = np.random.default_rng(0)
    torn = TriangleMesh(soup.vertices + rng.normal(0.0, 1e-4, soup.vertices.shape), soup.faces)
    assert without_noise(torn) is torn
    few = TriangleMesh.from_trimesh(trimesh.creation.icosphere(2))
    assert without_noise(few) is few


def test_noise_is_seen_whichever_way_faces_look(goblet):
    rough = noisy(goblet, 0.005)
    flipped = np.random.default_rng(2).random(len(rough.faces)) < 0.5
    faces = np.where(flipped[:, None], rough.faces[:, ::-1], rough.faces)
    smooth = without_noise(TriangleMesh(rough.vertices, faces))
    np.testing.assert_allclose(smooth.vertices, without_noise(rough).vertices, atol=1e-9)


def test_smoothing_can_be_stopped(goblet):
    calls = []

    def stop() -> None:
        calls.append(None)
        if len(calls) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        without_noise(noisy(goblet, 0.005), stop)


def test_a_scanned_goblet_is_rebuilt_in_spite_of_its_noise(glass, goblet):
    """With the rough surface as the target, fewer values are determined."""
    unit_m = glass.model.unit_m
    assert unit_m is not None
    rotation = Rotation.from_rotvec([0.3, -1.1, 0.6]).as_matrix()
    shape = goblet.transformed(rotation, np.array([1.0, 2.0, 3.0]), 1000.0 * unit_m)
    scan = noisy(shape, 0.005)
    answer = estimate(Query(scan, units="mm"), glass, EstimationSettings(surface_points=300))
    determined = [i for i, one in enumerate(answer.parameters) if one.status == "determined"]
    assert len(determined) >= 6
    shares = np.abs(answer.values - glass.base_values())[determined] / (glass.maximum - glass.minimum)[determined]
    assert (shares < 0.05).all()
    assert apart(answer.mesh, shape) < apart(without_noise(scan), shape), "the fit is nearer to the shape than the scan"
    assert answer.distances.zbuffer > 0.05, "the verdict is about the query as it is"
