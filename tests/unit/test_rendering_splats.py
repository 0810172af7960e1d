"""Laws of pictures of points."""

import numpy as np
import pytest
import simple_shapes
from scipy.spatial.transform import Rotation

from shapewright.classification.readings import plain_reading
from shapewright.errors import MeshError, RenderingError
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.rendering import random_views, render_images
from shapewright.rendering.splats import RADIUS, SplatCloud, splat_cloud, splat_images

SHAPES = {"goblet": simple_shapes.goblet(), "stool": simple_shapes.stool(), "box": simple_shapes.box()}
SIZE = 96
VIEWS = 4
DENSE = 40_000
"""Points of a sphere that discs of the smallest radius cover without gaps."""
ROTATIONS = random_views(np.random.default_rng(3), VIEWS)[0]
SCALES = np.linspace(0.6, 0.95, VIEWS)


def draw(cloud: SplatCloud, rotations=ROTATIONS, scales=SCALES, size: int = SIZE) -> np.ndarray:
    return splat_images([cloud], rotations, scales, objects=np.zeros(len(scales), dtype=np.int64), size=size)


def pictures_of(mesh: TriangleMesh, **options) -> np.ndarray:
    return draw(plain_reading(mesh).cloud, **options)


def front(cloud: SplatCloud, scale: float = 1.0, size: int = SIZE) -> np.ndarray:
    return draw(cloud, np.eye(3)[None], np.array([scale]), size)[0]


def difference(pictures: np.ndarray, others: np.ndarray) -> np.ndarray:
    return np.abs(pictures.astype(np.int64) - others)


def covered(picture: np.ndarray) -> np.ndarray:
    return picture[..., 1] < 255


def sphere(count: int) -> np.ndarray:
    """Points spread evenly over the unit sphere."""
    heights = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    angles_rad = np.pi * (3.0 - 5.0**0.5) * np.arange(count)
    rims = np.sqrt(1.0 - heights**2)
    return np.stack([rims * np.cos(angles_rad), heights, rims * np.sin(angles_rad)], axis=1)


def subdivided(mesh: TriangleMesh, times: int) -> TriangleMesh:
    """The same surface, each triangle four times as many."""
    for _ in range(times):
        a, b, c = (mesh.triangles[:, k] for k in range(3))
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        corners = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
        mesh = TriangleMesh(corners, np.arange(len(corners)).reshape(-1, 3)).cleaned()
    return mesh


@pytest.mark.parametrize("scale", [0.5, 0.9])
def test_a_sphere_covers_its_disc(scale: float) -> None:
    picture = front(splat_cloud(sphere(DENSE), 0.0), scale, 224)
    disc = np.pi * (112 * scale * (1.0 + 0.75 * RADIUS)) ** 2  # three quarters of a splat's radius count as covered
    assert covered(picture).sum() == pytest.approx(disc, rel=0.02)


def test_nearer_is_darker_and_steeper_is_darker() -> None:
    picture = front(splat_cloud(sphere(DENSE), 0.0), 0.9, 224)
    row = np.arange(112, 112 + 90)
    depth, slope = picture[row, 112, 1].astype(int), picture[row, 112, 2].astype(int)
    assert (np.diff(depth) >= -1).all()
    assert depth[-1] - depth[0] > 40
    assert slope[0] >= picture[..., 2][covered(picture)].max() - 1
    assert slope[0] - slope[-1] > 60


@pytest.mark.parametrize("scale", [0.7, 1.0])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_mirrored_object_has_the_mirrored_picture(shape: str, scale: float) -> None:
    cloud = plain_reading(SHAPES[shape]).cloud
    tilted = (cloud.points @ ROTATIONS[0].T).astype(np.float32)
    picture = front(SplatCloud(tilted, cloud.radius), scale)
    for flipped, axis in ((np.array([-1, 1, 1]), 1), (np.array([1, -1, 1]), 0)):
        mirrored = front(SplatCloud((tilted * flipped).astype(np.float32), cloud.radius), scale)
        differing = difference(np.flip(picture, axis), mirrored).max(axis=-1) > 8
        assert differing.mean() < 0.002  # a point on the line between two pixels belongs to either


def test_a_background_pixel_is_white_and_the_silhouette_dark() -> None:
    picture = front(splat_cloud(sphere(DENSE), 0.0), 0.6, 224)
    assert (picture[:8] == 255).all()
    assert picture[112, 112, 0] == pytest.approx(0.74 * 255, abs=1)
    for across in (picture[112, :, 0], picture[:, 112, 0]):
        for half in (across[:112], across[112:]):
            assert half.min() < 0.5 * 255


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_how_a_surface_is_cut_into_triangles_hardly_matters(name: str) -> None:
    mesh = SHAPES[name]
    pictures = pictures_of(mesh)
    soup = TriangleMesh(mesh.triangles.reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    assert np.array_equal(pictures_of(soup), pictures)
    shuffled = TriangleMesh(mesh.vertices, mesh.faces[np.random.default_rng(0).permutation(len(mesh.faces))])
    others = [simple_shapes.flipped(mesh), simple_shapes.flipped(mesh, 0.5), shuffled, subdivided(mesh, 2)]
    for other in others:
        off = difference(pictures, pictures_of(other))
        assert off.mean() < 4.0, "another shape or view is off by 20 and more"
        assert (off.max(axis=-1) > 40).mean() < 0.06


def test_another_shape_makes_other_pictures() -> None:
    goblet, stool = pictures_of(SHAPES["goblet"]), pictures_of(SHAPES["stool"])
    assert difference(goblet, stool).mean() > 20.0


@pytest.mark.parametrize("name", sorted(SHAPES))
@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_a_quarter_turn_turns_the_picture(name: str, quarters: int) -> None:
    turn = Rotation.from_euler("z", 90 * quarters, degrees=True).as_matrix()
    off = difference(
        np.rot90(pictures_of(SHAPES[name]), quarters, axes=(1, 2)),
        pictures_of(SHAPES[name], rotations=turn @ ROTATIONS),
    )
    assert (off[..., 1:].max(axis=-1) > 8).mean() < 0.01
    assert (off[..., 0] > 40).mean() < 0.1, "lines are drawn half a pixel off"


def test_several_objects_at_once_are_drawn_as_one_by_one() -> None:
    clouds = [plain_reading(mesh).cloud for mesh in SHAPES.values()]
    objects = np.array([2, 0, 0, 1])
    together = splat_images(clouds, ROTATIONS, SCALES, objects=objects, size=SIZE)
    for number, shown in enumerate(objects):
        alone = draw(clouds[shown], ROTATIONS[number : number + 1], SCALES[number : number + 1])
        assert np.array_equal(together[number], alone[0])


def test_position_and_unit_of_a_cloud_do_not_matter() -> None:
    points = plain_reading(SHAPES["goblet"]).points
    moved = splat_cloud(1e3 * points + [5.0, -7.0, 2.0], 1e3 * 0.1)
    still = splat_cloud(points, 0.1)
    assert moved.radius == pytest.approx(still.radius)
    assert np.abs(moved.points - still.points).max() < 1e-5
    assert np.linalg.norm(still.points, axis=1).max() == pytest.approx(1.0)
    assert np.abs(still.points.min(axis=0) + still.points.max(axis=0)).max() < 1e-5


def test_a_thin_cloud_has_wide_discs_and_no_gaps() -> None:
    steps = np.linspace(-1.0, 1.0, 21)
    grid = np.stack(np.meshgrid(steps, steps, [0.0]), axis=-1).reshape(-1, 3)
    shaken = grid + np.random.default_rng(0).uniform(-0.03, 0.03, grid.shape) * [1.0, 1.0, 0.0]
    cloud = plain_reading(PointCloud(shaken)).cloud
    assert cloud.radius > 2 * RADIUS
    half = round(0.5 * SIZE * 0.65)  # well inside the square, whose corners touch the unit circle
    middle = slice(SIZE // 2 - half, SIZE // 2 + half)
    assert covered(front(cloud)[middle, middle]).all()
    random = np.random.default_rng(1).uniform(-1.0, 1.0, (400, 3)) * [1.0, 1.0, 0.0]
    holes = ~covered(front(plain_reading(PointCloud(random)).cloud)[middle, middle])
    assert holes.mean() < 0.03


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_noise_changes_pictures_of_points_less_than_pictures_of_triangles(name: str) -> None:
    dense = SHAPES[name]
    while len(dense.faces) < 10_000:
        dense = subdivided(dense, 1)
    diagonal = float(np.linalg.norm(dense.bounds[1] - dense.bounds[0]))
    rng = np.random.default_rng(0)
    noisy = TriangleMesh(dense.vertices + 0.005 * diagonal * rng.normal(size=dense.vertices.shape), dense.faces)

    def triangles(mesh: TriangleMesh) -> np.ndarray:
        return render_images(
            [mesh],
            None,
            ROTATIONS,
            SCALES,
            objects=np.zeros(VIEWS, dtype=np.int64),
            size=SIZE,
            style="fused",
            window=1.0,
            framing="sphere",
        )

    splats_change = difference(pictures_of(dense), pictures_of(noisy)).mean(axis=(0, 1, 2))
    fused_change = difference(triangles(dense), triangles(noisy)).mean(axis=(0, 1, 2))
    assert splats_change[0] < 0.4 * fused_change[0], "no lines where noise has made creases"
    assert splats_change[2] < 0.9 * fused_change[2]


def test_an_object_larger_than_the_picture_is_cut_off() -> None:
    cloud = splat_cloud(sphere(DENSE), 0.0)
    assert covered(front(cloud, 3.0)).all()
    assert front(cloud, 0.5, size=1).shape == (1, 1, 3)


def test_no_pictures_of_anything_and_of_nothing() -> None:
    nothing = np.zeros(0, dtype=np.int64)
    for clouds in ([], [splat_cloud(sphere(10), 0.0)]):
        images = splat_images(clouds, np.zeros((0, 3, 3)), np.zeros(0), objects=nothing, size=32)
        assert images.shape == (0, 32, 32, 3)


@pytest.mark.parametrize(("shown", "size", "where"), [(1, 32, "objects"), (-1, 32, "objects"), (0, 0, "size")])
def test_pictures_of_no_cloud_and_without_pixels_are_refused(shown: int, size: int, where: str) -> None:
    cloud = splat_cloud(sphere(10), 0.0)
    with pytest.raises(RenderingError) as caught:
        splat_images([cloud], np.eye(3)[None], np.ones(1), objects=np.array([shown]), size=size)
    assert caught.value.where == where


def test_points_at_one_place_are_refused() -> None:
    with pytest.raises(MeshError, match="one place") as caught:
        splat_cloud(np.ones((5, 3)), 0.0)
    assert caught.value.where == "points"
