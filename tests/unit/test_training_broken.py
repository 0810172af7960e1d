"""Broken variations: each break does what it says, as far as its strength allows, and repeats with its generator."""

from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest
import simple_shapes
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from models_store.library.shipped import load_shipped
from shapewright.classification.series import SERIES
from shapewright.distances.triangles import TriangleDistance
from shapewright.errors import MeshError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.modeling import compile_model
from shapewright.training.broken import BREAK_NAMES, MOST_BROKEN, blocks, holes, noise, one_sided, rounded, sparse
from shapewright.training.broken.breaking import BREAKS, HARDEST, broken, is_broken
from shapewright.training.broken.dense_points import dense_points

MODELS = ("table_wire", "fish", "glass_with_stem", "spider")
SEEDS = range(6)


@cache
def variation(name: str) -> TriangleMesh:
    compiled = compile_model(load_shipped(name))
    return compiled.instance(compiled.random_values(np.random.default_rng(7), 1)[0])


@pytest.fixture(params=MODELS)
def mesh(request: pytest.FixtureRequest) -> TriangleMesh:
    return variation(request.param)


def positions(outcome: TriangleMesh | PointCloud) -> np.ndarray:
    return outcome.points if isinstance(outcome, PointCloud) else outcome.vertices


def diagonal(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def outcomes(name: str, mesh: TriangleMesh) -> Iterator[tuple[int, np.ndarray]]:
    """What a break leaves of a mesh with several generators, and the seed of each."""
    for seed in SEEDS:
        yield seed, positions(BREAKS[name](mesh, np.random.default_rng(seed)))


def first_turn(seed: int) -> np.ndarray:
    """The turn that a break draws before anything else."""
    return Rotation.random(rng=np.random.default_rng(seed)).as_matrix()


def test_every_break_has_a_name() -> None:
    assert tuple(BREAKS) == BREAK_NAMES
    assert HARDEST in BREAKS


@pytest.mark.parametrize("name", BREAK_NAMES)
def test_a_generator_decides_the_outcome(name: str, mesh: TriangleMesh) -> None:
    first, again, other = (positions(BREAKS[name](mesh, np.random.default_rng(seed))) for seed in (3, 3, 4))
    assert np.array_equal(first, again)
    assert first.shape != other.shape or not np.allclose(first, other, atol=1e-4 * diagonal(mesh.vertices))


@pytest.mark.parametrize("name", BREAK_NAMES)
def test_the_variation_itself_stays_as_it_was(name: str, mesh: TriangleMesh) -> None:
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    BREAKS[name](mesh, np.random.default_rng(0))
    assert np.array_equal(mesh.vertices, vertices)
    assert np.array_equal(mesh.faces, faces)


@pytest.mark.parametrize("name", BREAK_NAMES)
def test_an_outcome_grows_with_its_variation(name: str, mesh: TriangleMesh) -> None:
    """Strengths are shares of the object's size: a variation in millimeters breaks like one in meters."""
    large = TriangleMesh(1000.0 * mesh.vertices, mesh.faces)
    small, grown = (positions(BREAKS[name](one, np.random.default_rng(1))) for one in (mesh, large))
    assert abs(len(small) - len(grown)) <= 0.001 * len(small), "but for points at the very rim of something"
    if len(small) == len(grown):
        differing = np.abs(1000.0 * small - grown).max(axis=1) > 1e-6 * diagonal(grown)
        assert differing.mean() < 0.001


def test_noise_moves_points_as_far_as_its_strength_says(mesh: TriangleMesh) -> None:
    points, size = dense_points(mesh), diagonal(dense_points(mesh))
    deviations = []
    for _, moved in outcomes("noise", mesh):
        assert moved.shape == points.shape
        deviations.append(float(np.std(moved - points)) / size)
        assert np.abs(moved - points).max() < 8 * deviations[-1] * size
    assert min(deviations) > 0.9 * noise.DEVIATIONS[0]
    assert max(deviations) < 1.1 * noise.DEVIATIONS[1]
    assert max(deviations) > 1.5 * min(deviations), "strengths are drawn anew each time"


def test_neighbors_are_measured_wrongly_alike(mesh: TriangleMesh) -> None:
    """The field is smooth, at least over the narrowest width: other than noise that each point has on its own."""
    points = dense_points(mesh)
    (near, far) = (cKDTree(points).query(points, k=2)[1][:, 1], np.random.default_rng(0).permutation(len(points)))
    for _, moved in outcomes("noise", mesh):
        errors = moved - points
        alike, apart = (np.sum(errors * errors[others]) / np.sum(errors**2) for others in (near, far))
        assert alike > 0.3
        assert abs(apart) < 0.1 + 0.5 * alike


def test_holes_are_patches_of_the_surface_and_leave_enough(mesh: TriangleMesh) -> None:
    points = dense_points(mesh)
    tree, size = cKDTree(points), diagonal(points)
    for _, kept in outcomes("holes", mesh):
        distances, places = tree.query(kept)
        assert distances.max() < 1e-9 * size, "what is left has not moved"
        assert len(set(places.tolist())) == len(kept)
        assert 0.4 * len(points) <= len(kept) < (1.0 - 0.9 * holes.SHARES[0]) * len(points)
        gone = np.setdiff1d(np.arange(len(points)), places)
        lonely = cKDTree(points[gone]).query(points[gone], k=2)[0][:, 1]
        alone = cKDTree(points).query(points[gone], k=2)[0][:, 1]
        assert np.median(lonely) < 1.5 * np.median(alone), "whole patches are gone, not single points"


def test_one_side_is_a_turned_part_of_the_surface(mesh: TriangleMesh) -> None:
    for seed, kept in outcomes("one_sided", mesh):
        points = dense_points(mesh) @ first_turn(seed).T
        assert cKDTree(points).query(kept)[0].max() < 1e-9 * diagonal(points)
        assert 0.05 * len(points) < len(kept) < 0.95 * len(points)
        assert hidden(points, kept) < 0.75 * hidden(points, points), "most of what is hidden is gone"


def test_one_side_is_nearly_all_in_sight_where_pixels_are_wider_than_the_gaps_between_points(
    mesh: TriangleMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(one_sided, "PIXELS", (48, 48))
    for seed, kept in outcomes("one_sided", mesh):
        points = dense_points(mesh) @ first_turn(seed).T
        assert hidden(points, points) > 0.12
        assert hidden(points, kept) < 0.35 * hidden(points, points), "the rest is seen at a grazing angle"


def hidden(surface: np.ndarray, points: np.ndarray) -> float:
    """Share of the points that lie behind others of the surface, seen from +z."""
    wide = float(np.ptp(surface[:, :2], axis=0).max())
    around = cKDTree(surface[:, :2]).query_ball_point(points[:, :2], 0.012 * wide)
    front = np.array([surface[near, 2].max() for near in around])
    return float((front - points[:, 2] > 0.06 * wide).mean())


def test_rounded_vertices_lie_on_a_grid_near_to_where_they_were(mesh: TriangleMesh) -> None:
    for seed, vertices in outcomes("rounded", mesh):
        turn = first_turn(seed)
        turned, before = vertices @ turn.T, mesh.vertices @ turn.T
        longest = float(np.ptp(before, axis=0).max())
        assert np.abs(turned - before).max() < 0.51 * longest / rounded.CELLS[0]
        for along in turned.T:
            levels = np.unique(np.round(along / longest, 9))
            assert len(levels) <= rounded.CELLS[1] + 2
            steps = np.diff(levels)
            assert np.allclose(steps / steps.min(), np.round(steps / steps.min()), atol=1e-4), "one grid for all"


def test_a_mesh_that_rounding_would_destroy_stays_as_it_was() -> None:
    size = 1e-4
    speck = simple_shapes.joined([simple_shapes.box((size,) * 3, (x, x, x)) for x in (0.0, 1.0)])
    assert rounded.round_vertices(speck, np.random.default_rng(0)) is speck


def test_few_points_are_few_and_near_to_the_surface(mesh: TriangleMesh) -> None:
    distance, counts, clean = TriangleDistance(mesh), [], 0
    for _, points in outcomes("sparse", mesh):
        counts.append(len(points))
        apart = distance(points) / diagonal(mesh.vertices)
        assert apart.max() < 6.0 * 0.004
        clean += int(apart.max() < 1e-6)
    assert sparse.COUNTS[0] <= min(counts) < max(counts) <= sparse.COUNTS[1]
    assert 0 < clean < len(SEEDS), "some clouds are exact, some are not"


def test_blocks_stay_within_a_block_of_the_surface(mesh: TriangleMesh) -> None:
    distance, points = TriangleDistance(mesh), dense_points(mesh)
    built = 0
    for seed, moved in outcomes("blocks", mesh):
        turn = first_turn(seed)
        longest = float(np.ptp(points @ turn.T, axis=0).max())
        assert len(moved) == len(points)
        assert distance(moved).max() < np.sqrt(3) * longest / blocks.BLOCKS[0]
        assert np.median(distance(moved)) > 0.05 * longest / blocks.BLOCKS[1], "they did move"
        built += lies_on_a_grid(moved @ turn.T, longest)
    assert 0 < built < len(SEEDS), "half are built of blocks, half are swollen"


def lies_on_a_grid(turned: np.ndarray, longest: float) -> bool:
    """Whether every point has a coordinate that it shares with many others: it lies on a side of a block."""
    shared = np.zeros(len(turned), dtype=bool)
    for along in turned.T:
        _, level, counts = np.unique(np.round(along / longest, 9), return_inverse=True, return_counts=True)
        shared |= counts[level] > 3
    return bool(shared.mean() > 0.95)


@pytest.mark.parametrize("name", sorted(set(BREAK_NAMES) - {"rounded"}))
def test_a_variation_without_area_cannot_be_broken(name: str) -> None:
    flat = TriangleMesh(np.zeros((3, 3)) + np.arange(3)[:, None], np.array([[0, 1, 2]]))
    with pytest.raises(MeshError, match="no area"):
        broken(flat, (name,), np.random.default_rng(0))


def test_breaks_are_drawn_from_those_that_are_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[str] = []
    noted = {name: lambda mesh, rng, name=name: drawn.append(name) or mesh for name in BREAK_NAMES}
    monkeypatch.setattr("shapewright.training.broken.breaking.BREAKS", noted)
    mesh, rng = simple_shapes.box(), np.random.default_rng(0)
    assert broken(mesh, (), rng) is mesh
    for _ in range(50):
        broken(mesh, ("holes", "sparse"), rng)
    assert set(drawn) == {"holes", "sparse"}
    drawn.clear()
    for _ in range(7000):
        broken(mesh, BREAK_NAMES, rng)
    counts = {name: drawn.count(name) for name in BREAK_NAMES}
    for name, count in counts.items():
        assert abs(count - (2000 if name == HARDEST else 1000)) < 150, "the hardest twice as often as each other"


@given(share=st.floats(0.0, MOST_BROKEN))
def test_every_beginning_of_a_series_has_its_share_of_broken_ones(share: float) -> None:
    flags = [is_broken(number, share) for number in range(SERIES)]
    assert not flags[0]
    missing = share * np.arange(1, SERIES + 1) - np.cumsum(flags)
    assert np.abs(missing).max() < 2.1


@given(shares=st.tuples(st.floats(0.0, MOST_BROKEN), st.floats(0.0, MOST_BROKEN)), number=st.integers(0, 10_000))
def test_what_is_broken_stays_broken_with_a_larger_share(shares: tuple[float, float], number: int) -> None:
    assert is_broken(number, min(shares)) <= is_broken(number, max(shares))
