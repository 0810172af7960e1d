"""The side that a scan was seen from is found, and objects that are whole have none."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simple_shapes import box, goblet

from shapewright.classification.look import Look
from shapewright.classification.open_side import open_side
from shapewright.classification.readings import plain_reading
from shapewright.classification.sights import sights_of
from shapewright.evaluation.corruptions.half import see_one_side
from shapewright.mesh import PointCloud, TriangleMesh

LOOK = Look("splats", 64, "sphere", 1.0, (0.7, 1.0))
SHAPES = [box((1.0, 0.8, 0.5)), goblet()]


def points_of(query: TriangleMesh | PointCloud) -> np.ndarray:
    return plain_reading(query).cloud.points


@pytest.mark.parametrize("mesh", SHAPES)
@pytest.mark.parametrize("seed", range(4))
def test_a_scan_of_one_side_is_told_with_its_direction(mesh: TriangleMesh, seed: int) -> None:
    scan = see_one_side(mesh, 128, np.random.default_rng(seed))
    seen_from = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()[2]
    for query in (scan, PointCloud(scan.vertices)):
        side = open_side(points_of(query))
        assert side is not None
        assert np.isclose(np.linalg.norm(side), 1.0)
        assert abs(side @ seen_from) > 0.7


@pytest.mark.parametrize("mesh", SHAPES)
def test_a_whole_object_has_no_open_side(mesh: TriangleMesh) -> None:
    assert open_side(points_of(mesh)) is None


def test_a_bent_sheet_is_open_to_the_side_that_sees_all_of_it() -> None:
    """A half pipe is seen whole along its axis of symmetry, from within and from without, and from nowhere else."""
    angles = np.linspace(-0.45 * np.pi, 0.45 * np.pi, 60)
    along = np.linspace(-0.5, 0.5, 40)
    sheet = np.array([[np.sin(a), y, np.cos(a)] for a in angles for y in along])
    side = open_side(points_of(PointCloud(sheet)))
    assert side is not None
    assert abs(side[2]) > 0.8


def test_a_scan_of_one_side_is_looked_at_from_there_and_from_behind() -> None:
    scan = see_one_side(goblet(), 128, np.random.default_rng(0))
    (sight,) = sights_of(scan, LOOK)
    rotations, scales = sight.more_views(np.random.default_rng(0), 4)
    assert rotations.shape == (8, 3, 3)
    assert scales.shape == (8,)
    side = open_side(points_of(scan))
    cosines = rotations[:, 2] @ side
    assert (cosines[:4] > 0.86).all()
    assert (cosines[4:] < -0.86).all()
    again = sight.more_views(np.random.default_rng(0), 4)
    assert np.array_equal(rotations, again[0])


def test_a_whole_object_gets_no_more_views() -> None:
    (sight,) = sights_of(goblet(), LOOK)
    rotations, scales = sight.more_views(np.random.default_rng(0), 4)
    assert rotations.shape == (0, 3, 3)
    assert scales.shape == (0,)
