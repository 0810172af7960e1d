"""Broken variations: each break does what it says, as far as its strength allows, and repeats with its generator."""

from collections.abc import Iterator
from functools import cache
from itertools import islice

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
from shapewright.training.broken import BREAK_NAMES, MOST_BROKEN, blocks, holes, noise, rounded, sparse, specks
from shapewright.training.broken.breaking import BREAKS, OFTEN, SECOND_BREAKS, TWICE, broken, is_broken
from shapewright.training.broken.dense_points import dense_points
from shapewright.training.broken.grid_turns import grid_turn

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
    assert set(OFTEN) <= set(BREAKS)


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


def test_one_side_is_what_no_face_hides(mesh: TriangleMesh) -> None:
    for seed, kept in islice(outcomes("one_sided", mesh), 3):
        turned = TriangleMesh(mesh.vertices @ first_turn(seed).T, mesh.faces)
        points = dense_points(mesh) @ first_turn(seed).T
        distances, places = cKDTree(points).query(kept)
        assert distances.max() < 1e-9 * diagonal(points), "what is left has only been turned"
        gone = np.setdiff1d(np.arange(len(points)), places)
        rng = np.random.default_rng(0)
        assert hidden(rng.permutation(kept)[:60], turned, 0.02).mean() <= 0.08
        assert hidden(rng.permutation(points[gone])[:60], turned, 0.001).mean() > 0.75


def hidden(points: np.ndarray, mesh: TriangleMesh, share: float) -> np.ndarray:
    """Whether a face lies before each point, seen from +z, and is at least a share of the object's size away."""
    corners = mesh.triangles
    far = share * float(np.ptp(mesh.vertices, axis=0).max())
    a, b, c = (corners[None, :, k] - points[:, None] for k in range(3))

    def crossed(p: np.ndarray, q: np.ndarray) -> np.ndarray:
        return p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]

    parts = np.stack([crossed(b, c), crossed(c, a), crossed(a, b)])
    over = ((parts >= 0).all(axis=0) | (parts <= 0).all(axis=0)) & (np.abs(parts.sum(axis=0)) > 1e-12)
    heights = np.einsum("knf,knf->nf", parts, np.stack([a[..., 2], b[..., 2], c[..., 2]]))
    with np.errstate(divide="ignore", invalid="ignore"):
        return (over & (heights / parts.sum(axis=0) > far)).any(axis=1)


def test_half_of_the_grids_lie_along_the_axes() -> None:
    turns = [grid_turn(np.random.default_rng(seed)) for seed in range(200)]
    assert np.allclose([turn @ turn.T for turn in turns], np.eye(3))
    assert abs(np.mean([np.array_equal(turn, np.eye(3)) for turn in turns]) - 0.5) < 0.1


def test_rounded_vertices_lie_on_a_grid_near_to_where_they_were(mesh: TriangleMesh) -> None:
    distance, size = TriangleDistance(mesh), diagonal(mesh.vertices)
    for seed, vertices in outcomes("rounded", mesh):
        turned = vertices @ grid_turn(np.random.default_rng(seed)).T
        longest = float(np.ptp(turned, axis=0).max())
        assert distance(vertices).max() < 0.5 * np.sqrt(3) * size / rounded.CELLS[0]
        for along in turned.T:
            levels = np.unique(np.round(along / longest, 9))
            assert len(levels) <= rounded.CELLS[1] + 2
            steps = np.diff(levels)
            assert np.allclose(steps / steps.min(), np.round(steps / steps.min()), atol=1e-4), "one grid for all"


def test_most_objects_are_cut_before_they_are_rounded() -> None:
    """A large flat face of two triangles would stay flat; those of scans and fine exports get steps."""
    plate = simple_shapes.box((1.0, 0.6, 0.1))
    counts = [len(rounded.round_vertices(plate, np.random.default_rng(seed)).faces) for seed in range(30)]
    whole = np.mean([count == len(plate.faces) for count in counts])
    assert 0.1 < whole < 0.6
    assert max(counts) > 100 * len(plate.faces)


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
        turn = grid_turn(np.random.default_rng(seed))
        longest = float(np.ptp(points @ turn.T, axis=0).max())
        assert len(moved) == len(points)
        assert distance(moved).max() < np.sqrt(3) * longest / blocks.BLOCKS[0]
        assert np.median(distance(moved)) > 0.05 * longest / blocks.BLOCKS[1], "they did move"
        built += lies_on_a_grid(moved @ turn.T, longest)
    assert 0 < built < len(SEEDS), "half are built of blocks, half are swollen"


def test_specks_float_near_to_the_surface_which_stays(mesh: TriangleMesh) -> None:
    distance, points = TriangleDistance(mesh), dense_points(mesh)
    counts = []
    for _, outcome in outcomes("specks", mesh):
        assert np.array_equal(outcome[: len(points)], points)
        added = outcome[len(points) :]
        counts.append(len(added))
        farthest = specks.FARTHEST + 0.5 * np.sqrt(3) * specks.SIZES[1]
        assert distance(added).max() <= farthest * diagonal(points)
        assert np.median(distance(added)) > 0.03 * specks.FARTHEST * diagonal(points), "they float"
    assert specks.COUNTS[0] <= min(counts) < max(counts)


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
    monkeypatch.setattr("shapewright.training.broken.breaking.SECOND_BREAKS", {})
    mesh, rng = simple_shapes.box(), np.random.default_rng(0)
    assert broken(mesh, (), rng) is mesh
    for _ in range(50):
        broken(mesh, ("holes", "sparse"), rng)
    assert set(drawn) == {"holes", "sparse"}
    drawn.clear()
    for _ in range(10_000):
        broken(mesh, BREAK_NAMES, rng)
    for name in BREAK_NAMES:
        assert abs(drawn.count(name) - 1000 * OFTEN.get(name, 1)) < 200


def test_a_third_is_broken_in_a_second_way_but_in_no_way_that_is_not_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[str] = []
    noted = {name: lambda mesh, rng, name=name: drawn.append(name) or mesh for name in BREAK_NAMES}
    monkeypatch.setattr("shapewright.training.broken.breaking.BREAKS", noted)
    monkeypatch.setattr(
        "shapewright.training.broken.breaking.SECOND_BREAKS", {name: noted[name] for name in SECOND_BREAKS}
    )
    mesh, rng = simple_shapes.box(), np.random.default_rng(0)
    lengths = []
    for _ in range(3000):
        drawn.clear()
        broken(mesh, BREAK_NAMES, rng)
        lengths.append(len(drawn))
        assert len(drawn) == 1 or (drawn[1] in SECOND_BREAKS and drawn[1] != drawn[0])
    assert abs(np.mean(np.array(lengths) == 2) - TWICE) < 0.04
    drawn.clear()
    for _ in range(100):
        broken(mesh, ("noise", "blocks"), rng)
    assert set(drawn) == {"noise", "blocks"}


@pytest.mark.parametrize("name", SECOND_BREAKS)
def test_what_is_broken_can_be_broken_again(name: str, mesh: TriangleMesh) -> None:
    scan = BREAKS["one_sided"](mesh, np.random.default_rng(1))
    assert isinstance(scan, PointCloud)
    twice = SECOND_BREAKS[name](scan, np.random.default_rng(2))
    assert 0.4 * len(scan.points) <= len(twice.points) <= len(scan.points) + 6 * specks.COUNTS[1]
    assert not np.array_equal(twice.points, scan.points)


@given(share=st.floats(0.0, MOST_BROKEN))
def test_every_beginning_of_a_series_has_its_share_of_broken_ones(share: float) -> None:
    flags = [is_broken(number, share) for number in range(SERIES)]
    assert not flags[0]
    missing = share * np.arange(1, SERIES + 1) - np.cumsum(flags)
    assert np.abs(missing).max() < 2.1


@given(shares=st.tuples(st.floats(0.0, MOST_BROKEN), st.floats(0.0, MOST_BROKEN)), number=st.integers(0, 10_000))
def test_what_is_broken_stays_broken_with_a_larger_share(shares: tuple[float, float], number: int) -> None:
    assert is_broken(number, min(shares)) <= is_broken(number, max(shares))
