"""Laws that hold for every procedural model of the library, and what each single one must be able to become."""

import importlib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import models_store.library
from models_store.library.shipped import list_shipped, load_shipped, thumbnail_png
from shapewright.errors import ModelError
from shapewright.modeling import CompiledModel, ProceduralModel

NAMES = list(list_shipped())
MIRROR_PLANES = {"glass_with_stem": "xy", "table": "xy", "sword": "y"}
"""Axes whose mirror planes every variation has."""
TURN_ORDERS = {"glass_with_stem": 12, "table": 2, "sword": 1}
"""How often a turn about z maps every variation onto itself."""
EXTENTS = {"glass_with_stem": (0.2, 2.0), "table": (0.2, 3.0), "sword": (0.02, 2.0)}
"""Smallest and largest extent that any variation may have along any axis, in model units."""

every_model = pytest.mark.parametrize("name", NAMES)


@cache
def model_of(name: str) -> ProceduralModel:
    return load_shipped(name)


@cache
def compiled_model(name: str) -> CompiledModel:
    return model_of(name).compile()


@cache
def variations(name: str) -> np.ndarray:
    """Vertices (200, V, 3) of random variations."""
    compiled = compiled_model(name)
    return compiled.surface_points(compiled.random_values(np.random.default_rng(20), 200))


def base_points(compiled: CompiledModel) -> np.ndarray:
    return compiled.surface_points(compiled.base_values()[None])[0]


def farthest_from(points: np.ndarray, image: np.ndarray) -> float:
    return float(cKDTree(points).query(image)[0].max())


def test_the_library_has_its_three_models() -> None:
    assert {"glass_with_stem", "table", "sword"} <= set(NAMES)


def test_a_name_that_does_not_ship_is_refused() -> None:
    with pytest.raises(ModelError, match="glass_with_stem"):
        load_shipped("../glass_with_stem")
    with pytest.raises(ModelError, match="no such model"):
        thumbnail_png("spoon")


@every_model
def test_the_document_is_what_its_script_models(name: str) -> None:
    script = importlib.import_module(f"models_store.library.{name}.build")
    text = Path(models_store.library.__file__).parent.joinpath(name, "model.json").read_text(encoding="utf-8")
    assert script.build().to_json() == text, f"run: python -m models_store.library.{name}.build"


@every_model
def test_the_document_replays_to_the_same_ids_and_mesh(name: str) -> None:
    script = importlib.import_module(f"models_store.library.{name}.build")
    recorded, replayed = script.build().compile(), compiled_model(name)
    np.testing.assert_array_equal(recorded.control_vertex_ids, replayed.control_vertex_ids)
    assert recorded.control_faces == replayed.control_faces
    np.testing.assert_array_equal(base_points(recorded), base_points(replayed))


@every_model
def test_without_parameters_the_operations_give_the_base_model(name: str) -> None:
    model = model_of(name)
    bare = ProceduralModel(model.name, model.class_name, model.operations, (), model.description, model.closed)
    np.testing.assert_allclose(base_points(bare.compile()), base_points(compiled_model(name)), atol=1e-12)


@every_model
def test_parameters_are_plainly_named_and_vary_around_the_base(name: str) -> None:
    model = model_of(name)
    labels = [parameter.label for parameter in model.parameters]
    assert len(set(labels)) == len(labels)
    assert 5 <= len(model.parameters) <= 15
    for parameter in model.parameters:
        assert parameter.base_value is not None, parameter.name
        assert parameter.base_value > 0, parameter.name


@every_model
def test_each_end_of_each_range_moves_something(name: str) -> None:
    compiled = compiled_model(name)
    base = base_points(compiled)
    size = np.ptp(base, axis=0).max()
    for column, parameter in enumerate(compiled.model.parameters):
        for end in (parameter.minimum, parameter.maximum):
            if end == 1.0:
                continue
            values = compiled.base_values()
            values[column] = end
            moved = np.abs(compiled.surface_points(values[None])[0] - base).max()
            assert moved > 2e-3 * size, f"{parameter.name} = {end}"


@every_model
def test_a_model_is_fine_and_yet_cheap(name: str) -> None:
    assert 1_000 <= base_points(compiled_model(name)).shape[0] <= 5_000


@every_model
def test_variations_are_finite_and_of_sane_extent(name: str) -> None:
    points = variations(name)
    assert np.isfinite(points).all()
    extents = np.ptp(points, axis=1)
    smallest, largest = EXTENTS[name]
    assert extents.min() >= smallest
    assert extents.max() <= largest


@every_model
def test_variations_have_no_degenerate_face(name: str) -> None:
    corners = variations(name)[:, compiled_model(name).surface_triangles()]
    crosses = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    areas = np.linalg.norm(crosses, axis=2) / 2
    assert (areas.min(axis=1) / areas.mean(axis=1)).min() > 1e-5


@every_model
def test_every_part_of_every_variation_encloses_a_volume(name: str) -> None:
    compiled = compiled_model(name)
    assert compiled.model.closed
    parts = compiled.instance(compiled.base_values()).to_trimesh().split(only_watertight=False)
    base = base_points(compiled)
    for part in parts:
        assert part.is_watertight
        assert part.is_winding_consistent
        rows = cKDTree(base).query(part.vertices)[0]
        assert rows.max() == 0.0
    triangles = compiled.surface_triangles()
    for component in connected_triangles(triangles, len(base)):
        corners = variations(name)[:, component]
        volumes = np.einsum("bfi,bfi->b", corners[:, :, 0], np.cross(corners[:, :, 1], corners[:, :, 2])) / 6
        assert volumes.min() > 0.0


def connected_triangles(triangles: np.ndarray, count: int) -> list[np.ndarray]:
    """Triangles of each connected part."""
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components

    links = sparse.coo_array((np.ones(len(triangles) * 2), (triangles[:, [0, 0]].ravel(), triangles[:, 1:].ravel())))
    links.resize((count, count))
    n_parts, part = connected_components(links.tocsr(), directed=False)
    return [triangles[part[triangles[:, 0]] == i] for i in range(n_parts)]


@every_model
def test_every_variation_is_as_symmetric_as_its_class(name: str) -> None:
    for points in variations(name)[:20]:
        for axis in MIRROR_PLANES[name]:
            image = points.copy()
            image[:, "xyz".index(axis)] *= -1
            assert farthest_from(points, image) < 1e-9, axis
        angle = 2 * np.pi / TURN_ORDERS[name]
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        assert farthest_from(points, points @ turn.T) < 1e-9


@every_model
def test_the_thumbnail_is_a_picture_of_its_own(name: str) -> None:
    from io import BytesIO

    from PIL import Image

    with Image.open(BytesIO(thumbnail_png(name))) as picture:
        assert picture.size == (256, 256)
        assert np.ptp(np.asarray(picture.convert("L"))) > 60


# ---------------------------------------------------------------------- single models


def instance_points(name: str, **values: float) -> np.ndarray:
    compiled = compiled_model(name)
    return compiled.surface_points(compiled.values_from_mapping(values)[None])[0]


def test_a_sword_without_curvature_is_mirrored_at_its_spine_too() -> None:
    points = instance_points("sword", blade_curvature=0.0)
    assert farthest_from(points, points * np.array([-1.0, 1.0, 1.0])) < 1e-9


def test_the_displayed_sizes_are_those_of_the_mesh() -> None:
    shown = {p.name: p.base_value for name in NAMES for p in model_of(name).parameters}
    table, glass = instance_points("table"), instance_points("glass_with_stem")
    assert np.ptp(table[:, 0]) == pytest.approx(shown["top_length"])
    assert np.ptp(table[:, 1]) == pytest.approx(shown["top_width"])
    assert np.ptp(table[:, 2]) == pytest.approx(shown["leg_length"] + shown["top_thickness"])
    foot = glass[glass[:, 2] < 0.01]
    rim = glass[glass[:, 2] > glass[:, 2].max() - 1e-9]
    assert np.ptp(foot[:, 0]) == pytest.approx(shown["foot_diameter"], rel=0.02)
    assert np.ptp(rim[:, 0]) == pytest.approx(shown["rim_diameter"], rel=0.02)


def test_the_walls_of_a_bowl_do_not_cross() -> None:
    """At each height above its floor the inner wall of a glass lies within the outer one."""
    compiled = compiled_model("glass_with_stem")
    model = compiled.model
    base = base_points(compiled)
    thicker = instance_points("glass_with_stem", rim_diameter=1.2)
    bowl = np.abs(thicker - base).max(axis=1) > 1e-9
    normals_out = outward(compiled, base)
    inner, outer = bowl & ~normals_out, bowl & normals_out
    assert model.closed
    for points in variations("glass_with_stem")[:100]:
        radius, height = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        order = np.argsort(height[outer])
        wall = np.interp(height[inner], height[outer][order], radius[outer][order])
        assert (radius[inner] <= wall + 1e-9).all()


def outward(compiled: CompiledModel, points: np.ndarray) -> np.ndarray:
    """Which vertices of a round object belong to faces that look away from its axis, or down."""
    triangles = compiled.surface_triangles()
    a, b, c = points[triangles].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    middle = (a + b + c) / 3
    away = (normals[:, :2] * middle[:, :2]).sum(axis=1) - 1e-3 * normals[:, 2] > 0
    marks = np.zeros(len(points), dtype=bool)
    marks[triangles[away].ravel()] = True
    return marks


def test_the_feet_of_a_table_stay_under_its_corners() -> None:
    for length, width in ((0.6, 1.4), (1.5, 0.6)):
        straight = {"leg_splay": 0.0, "leg_inset": 0.0, "leg_inset_sides": 0.0, "foot_thickness": 1.25}
        points = instance_points("table", top_length=length, top_width=width, **straight)
        top = points[points[:, 2] > 0.0][:, :2]
        feet = points[points[:, 2] < points[:, 2].min() + 1e-9][:, :2]
        np.testing.assert_allclose(feet.max(axis=0), top.max(axis=0), atol=1e-9)
        np.testing.assert_allclose(feet.min(axis=0), top.min(axis=0), atol=1e-9)


def test_edges_of_a_table_top_and_of_a_blade_stay_sharp() -> None:
    table = instance_points("table")
    corners = np.array([[x, y, z] for x in (-0.75, 0.75) for y in (-0.4, 0.4) for z in (0.0, 0.04)])
    assert farthest_from(table, corners) < 1e-9
    sword = instance_points("sword", blade_curvature=0.0, blade_taper=0.0)
    blade = sword[(sword[:, 2] > 0.1) & (sword[:, 2] < 0.5)]
    half_width = np.abs(blade[:, 0]).max()
    assert half_width == pytest.approx(0.025)
    np.testing.assert_allclose(blade[np.abs(blade[:, 0]) > half_width - 1e-9][:, 1], 0.0, atol=1e-9)


def test_a_glass_with_a_short_stem_still_stands_on_a_foot() -> None:
    tall = np.ptp(instance_points("glass_with_stem")[:, 2])
    short = np.ptp(instance_points("glass_with_stem", stem_length=0.1)[:, 2])
    assert tall - short == pytest.approx(0.9 * 0.38)
