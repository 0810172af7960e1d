"""Laws of cutting edges: the surface stays as it is."""

import numpy as np
import pytest
from simple_shapes import box, crossing_sheets, goblet

from shapewright.mesh import TriangleMesh
from shapewright.mesh.edge_cutting import cut_edges, cut_some_edges


@pytest.mark.parametrize("mesh", [box(), goblet(), crossing_sheets()])
def test_cut_edges_are_short_and_the_surface_is_the_same(mesh: TriangleMesh) -> None:
    for rng in (None, np.random.default_rng(1)):
        fine = cut_edges(mesh, 0.2, rng)
        sides = fine.triangles - np.roll(fine.triangles, 1, axis=1)
        assert np.linalg.norm(sides, axis=2).max() <= 0.2
        assert fine.area == pytest.approx(mesh.area)
        assert fine.is_watertight == mesh.is_watertight
        np.testing.assert_array_equal(fine.vertices[: len(mesh.vertices)], mesh.vertices)
    assert cut_edges(mesh, 100.0) is mesh


def test_some_edges_are_cut_whatever_their_length() -> None:
    mesh = cut_edges(box(), 0.1)
    some = cut_some_edges(mesh, 0.5, np.random.default_rng(0))
    edges = len(mesh.faces) * 3 // 2
    assert len(some.vertices) - len(mesh.vertices) == pytest.approx(0.5 * edges, rel=0.1)
    assert some.is_watertight
    assert some.area == pytest.approx(mesh.area)
