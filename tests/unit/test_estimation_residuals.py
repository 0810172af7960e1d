"""Where a fit and its query part, as numbers and as colors."""

import io

import chair_model
import numpy as np
import pytest
import simple_shapes
import trimesh
from scipy.spatial.transform import Rotation

from shapewright.errors import EstimationError
from shapewright.estimation.residual_views import ResidualViews, divided
from shapewright.estimation.residuals import even_points, measure_residuals
from shapewright.mesh.file import parse_mesh
from shapewright.modeling import compile_model
from shapewright.modeling.regions import find_regions


def armchair(**values):
    model = chair_model.armchair()
    compiled, regions = compile_model(model), find_regions(model)
    row = compiled.values_from_mapping(values)
    return compiled.instance(row), regions.names, regions.of_instance(compiled, row)


def test_a_mesh_follows_itself():
    mesh, names, regions = armchair()
    residuals = measure_residuals(mesh, mesh, region_names=names, regions=regions)
    assert residuals.query_to_fit.max() < 1e-9
    assert residuals.fit_to_query.max() < 1e-9
    assert (residuals.followed_share, residuals.invented_share) == (1.0, 0.0)
    assert sum(part.share_of_area for part in residuals.by_part) == pytest.approx(1.0)
    assert all(part.invented_share == 0 for part in residuals.by_part)


def test_a_part_that_the_query_lacks_is_invented_and_one_that_the_fit_lacks_not_followed():
    with_arms, names, regions = armchair(armrests=1)
    without, _, _ = armchair(armrests=0)
    residuals = measure_residuals(without, with_arms, region_names=names, regions=regions)
    invented = {part.name: part.invented_share for part in residuals.by_part}
    assert invented["armrests"] > 0.6, "but for the ends, which are near the back and the seat"
    assert all(share == 0 for name, share in invented.items() if name != "armrests")
    assert residuals.followed_share == 1.0
    arms = next(part for part in residuals.by_part if part.name == "armrests")
    assert residuals.invented_share == pytest.approx(arms.share_of_area * arms.invented_share, abs=0.005)
    other_way = measure_residuals(with_arms, without)
    assert other_way.followed_share < 1.0
    assert other_way.invented_share == 0.0


def test_units_are_those_in_which_the_query_reaches_from_minus_1_to_1():
    query = simple_shapes.box((2.0, 2.0, 2.0))
    fit = simple_shapes.box((2.2, 2.2, 2.2))
    turn = Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix()
    for scale in (1e-3, 1.0, 1e4):
        moved = [mesh.transformed(turn, scale * np.array([3.0, 1.0, 7.0]), scale) for mesh in (query, fit)]
        residuals = measure_residuals(*moved)
        assert residuals.query_to_fit == pytest.approx(np.full(8, 0.1))
        assert residuals.fit_to_query == pytest.approx(np.full(8, 0.1 * np.sqrt(3)))
        assert residuals.invented_share == 1.0
        assert measure_residuals(*moved, tolerance=0.11).followed_share == 1.0


def test_points_stand_for_equal_areas():
    mesh = simple_shapes.joined([simple_shapes.box((1, 1, 1)), simple_shapes.box((1, 1, 3), (5, 0, 0))])
    points, faces = even_points(mesh, 3000)
    assert (points[:, 0] > 2).mean() == pytest.approx(14 / 20, abs=0.002)
    assert np.allclose(points[faces < 12].mean(axis=0), 0.0, atol=0.02)
    assert np.array_equal(points, even_points(mesh, 3000)[0])


def test_regions_must_fit():
    mesh = simple_shapes.box()
    with pytest.raises(EstimationError, match="expected 8 regions"):
        measure_residuals(mesh, mesh, region_names=["a"], regions=np.zeros(3, dtype=np.int64))
    with pytest.raises(EstimationError, match="regions from 0 to 0"):
        measure_residuals(mesh, mesh, region_names=["a"], regions=np.full(8, 1))
    with pytest.raises(EstimationError, match="tolerance"):
        measure_residuals(mesh, mesh, tolerance=0.0)


def test_dividing_keeps_the_surface_and_the_first_vertices():
    mesh = simple_shapes.box((1.0, 2.0, 3.0))
    fine = divided(mesh, 0.2)
    assert fine.area == pytest.approx(mesh.area)
    assert np.array_equal(fine.vertices[:8], mesh.vertices)
    edges = fine.triangles - np.roll(fine.triangles, 1, axis=1)
    assert np.linalg.norm(edges, axis=2).max() <= 0.2
    assert np.einsum("fk,fk->f", fine.face_normals, fine.triangles.mean(axis=1)).min() > 0, "windings are kept"
    assert len(divided(mesh, 1e-6, most_faces=500).faces) <= 500


def colors_of(document: bytes) -> dict[str, np.ndarray]:
    scene = trimesh.load(io.BytesIO(document), file_type="glb", process=False)
    return {name: scene.geometry[name].visual.vertex_attributes["color"] for name in ("fit", "query")}


def test_the_scene_colors_what_is_far():
    query = simple_shapes.box()
    fit = simple_shapes.joined([query, simple_shapes.box((0.2, 0.2, 1.0), (0, 0, 1.0))])
    document = ResidualViews.of(query, fit).glb()
    assert parse_mesh(document, "glb").bounds == pytest.approx(fit.bounds), "any reader takes it"
    fit_colors, query_colors = (colors_of(document)[name][:, :3] for name in ("fit", "query"))
    near, far = query_colors[0], fit_colors[fit_colors[:, 1].argmin()]
    assert np.allclose(query_colors, near), "the fit follows it everywhere"
    assert np.allclose(near, [0.982, 0.799, 0.0185], atol=1e-3), "viridis ends yellow, in linear light"
    assert np.allclose(far, [0.0578, 0.0003, 0.0887], atol=1e-3), "and begins dark violet"
    assert np.allclose(fit_colors[:8], near)


def test_the_picture_shows_it_too_and_marks_the_tolerance():
    query = simple_shapes.box()
    fit = simple_shapes.box((1.0, 1.0, 1.0), (2.0, 0.0, 0.0))
    apart = ResidualViews.of(query, fit).picture(rotation=np.eye(3), size=120).astype(int)
    same = ResidualViews.of(query, query).picture(rotation=np.eye(3), size=120).astype(int)
    assert apart.shape == (176, 240, 3)
    left, middle = apart[60, 8], same[60, 60]
    assert left[2] > left[1] + 40, "far is violet"
    assert middle[0] > middle[2] + 60, "near is yellow"
    bar = same[128 + 20]
    assert bar[14:40].sum() > bar[200:226].sum()
    quarter = 14 + (240 - 28) // 4
    assert bar[quarter].max() < 60, "a dark line at the tolerance, a quarter of the bar"
