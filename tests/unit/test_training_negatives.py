"""Objects of no class: the same for the same generator, and sound meshes whatever the generator."""

import numpy as np
import pytest
import simple_shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from shapewright.mesh import TriangleMesh
from shapewright.mesh.joining import joined
from shapewright.training.negatives import distorted, mixed, random_assembly

SEEDS = st.integers(0, 2**32 - 1)
MAKERS = {
    "assembly": random_assembly,
    "distorted": lambda rng: distorted(simple_shapes.goblet(), rng),
    "mixed": lambda rng: mixed(simple_shapes.goblet(), simple_shapes.stool(), rng),
}


def total_area(mesh: TriangleMesh) -> float:
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


@pytest.mark.parametrize("kind", MAKERS)
def test_the_same_generator_gives_the_same_mesh(kind: str) -> None:
    first, again, other = (MAKERS[kind](np.random.default_rng(seed)) for seed in (5, 5, 6))
    assert np.array_equal(first.vertices, again.vertices)
    assert np.array_equal(first.faces, again.faces)
    assert first.vertices.shape != other.vertices.shape or not np.allclose(first.vertices, other.vertices)


@pytest.mark.parametrize("kind", MAKERS)
@given(seed=SEEDS)
@settings(deadline=None, max_examples=60)
def test_every_mesh_is_sound(kind: str, seed: int) -> None:
    mesh = MAKERS[kind](np.random.default_rng(seed))
    assert np.isfinite(mesh.vertices).all()
    assert mesh.faces.min() >= 0
    assert mesh.faces.max() < len(mesh.vertices)
    extents = np.sort(np.ptp(mesh.vertices, axis=0))
    assert extents[1] > 1e-3, "no line and no point"
    assert extents[2] < 1e3
    assert total_area(mesh) > 1e-4 * extents[2] ** 2
    assert set(np.unique(mesh.faces)) == set(range(len(mesh.vertices))), "a vertex without a face would shift pictures"


@given(seed=SEEDS)
@settings(deadline=None, max_examples=30)
def test_halves_meet_at_the_cut(seed: int) -> None:
    mesh = mixed(simple_shapes.goblet(), simple_shapes.stool(), np.random.default_rng(seed))
    height = mesh.vertices[:, 2]
    above = mesh.vertices[mesh.faces][:, :, 2].min(axis=1) >= -1e-9
    below = mesh.vertices[mesh.faces][:, :, 2].max(axis=1) <= 1e-9
    assert np.all(above | below)
    assert height.max() > 0 > height.min()


def test_distortion_keeps_the_faces_and_moves_the_points() -> None:
    goblet = simple_shapes.goblet()
    mesh = distorted(goblet, np.random.default_rng(0))
    assert np.array_equal(mesh.faces, goblet.faces)
    lengths = [np.linalg.norm(one.vertices[1:] - one.vertices[:-1], axis=1) for one in (mesh, goblet)]
    assert np.std(np.log((lengths[0] + 1e-9) / (lengths[1] + 1e-9))) > 0.1, "more than a motion and a scale"


def test_joined_meshes_keep_their_faces_apart() -> None:
    parts = [simple_shapes.box(), simple_shapes.goblet(), simple_shapes.box((2, 1, 1))]
    whole = joined(parts)
    assert total_area(whole) == pytest.approx(sum(total_area(part) for part in parts))
    assert len(whole.vertices) == sum(len(part.vertices) for part in parts)
