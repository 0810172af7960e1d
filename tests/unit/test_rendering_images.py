"""Laws of the batch renderer."""

import numpy as np
import pytest
import simple_shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shapewright.errors import RenderingError
from shapewright.mesh import TriangleMesh
from shapewright.rendering import images as images_module
from shapewright.rendering import random_views, render_images, renderer_name
from shapewright.rendering.images import normalized_positions
from shapewright.rendering.styles import STYLES

IDENTITY = np.eye(3)[None]
ONE = np.ones(1)


def draw(mesh: TriangleMesh, rotation=IDENTITY, scale=ONE, **options) -> np.ndarray:
    return render_images([mesh], None, rotation, scale, size=options.pop("size", 96), **options)[0]


def assert_alike(a: np.ndarray, b: np.ndarray, *, mean: float = 0.4, share: float = 0.004) -> None:
    """The same but for a few edge pixels: rounding of positions differs from tile to tile."""
    difference = np.abs(a.astype(np.int16) - b)
    assert difference.mean() <= mean
    assert (difference > 40).mean() <= share


def foreground(picture: np.ndarray) -> np.ndarray:
    return picture[..., 0] < 250


def test_a_box_covers_what_it_should():
    # Half a side of 1 in a window of 2: the middle half of the picture, fill inside, dark rim.
    picture = draw(simple_shapes.box(), size=128)
    rows, columns = np.nonzero(foreground(picture))
    assert abs(rows.min() - 32) <= 1
    assert abs(rows.max() - 95) <= 1
    assert abs(columns.min() - 32) <= 1
    assert abs(columns.max() - 95) <= 1
    assert np.all(picture[40:88, 40:88] == picture[64, 64])
    assert 150 < picture[64, 64, 0] < 220
    assert picture[64, 32:35].min() < 60


def test_up_is_up_and_right_is_right():
    corner = simple_shapes.joined([simple_shapes.box((0.2, 0.2, 0.2), (0.7, 0.7, 0)), simple_shapes.box((2, 2, 0.01))])
    lone = TriangleMesh(corner.vertices - corner.vertices.mean(axis=0), corner.faces[:12])
    covered = foreground(draw(lone))
    assert covered[:48, 48:].sum() == covered.sum() > 0


@given(quarters=st.integers(1, 3), seed=st.integers(0, 50))
@settings(max_examples=12, deadline=None)
def test_a_quarter_turn_turns_the_picture(quarters, seed):
    start, scale = random_views(np.random.default_rng(seed), 1)
    turn = Rotation.from_euler("z", 90 * quarters, degrees=True).as_matrix()
    mesh = simple_shapes.goblet()
    assert_alike(np.rot90(draw(mesh, start, scale), quarters), draw(mesh, turn[None] @ start, scale))


@pytest.mark.parametrize("style", sorted(STYLES))
@pytest.mark.parametrize("share", [0.5, 1.0])
def test_winding_does_not_matter(style, share):
    rotation, scale = random_views(np.random.default_rng(3), 1)
    for mesh in (simple_shapes.goblet(), simple_shapes.crossing_sheets(), simple_shapes.stool()):
        turned = simple_shapes.flipped(mesh, share)
        assert_alike(draw(mesh, rotation, scale, style=style), draw(turned, rotation, scale, style=style))


def test_a_sheet_has_two_sides():
    sheet = TriangleMesh(
        np.array([[-1, -0.5, 0], [1, -0.5, 0], [1, 0.5, 0], [-1, 0.5, 0]], dtype=float),
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    front = draw(sheet)
    back = draw(sheet, Rotation.from_euler("y", 180, degrees=True).as_matrix()[None])
    assert foreground(front).sum() > 1000
    assert_alike(front, back)


def test_creases_and_steps_are_lines_and_smooth_surfaces_have_none():
    ball = simple_shapes.lathe([(np.sin(a), np.cos(a)) for a in np.linspace(0.01, np.pi - 0.01, 48)], sides=96)
    picture = draw(ball, scale=np.array([1.6]), size=160)
    inside = np.hypot(*(np.indices((160, 160)) - 79.5)) < 55
    assert picture[inside].min() > 150
    corner_on = Rotation.from_euler("yx", [45, 35], degrees=True).as_matrix()[None]
    cube = draw(simple_shapes.box(), corner_on, size=160)
    assert (cube[70:90, 70:90, 0] < 90).sum() > 20, "three edges meet in the middle"
    step = simple_shapes.joined([simple_shapes.box((2, 2, 0.05)), simple_shapes.box((0.8, 0.8, 0.05), (0, 0, 0.4))])
    assert draw(step, size=160)[80, 40:120, 0].min() < 90, "a plate in front of another has an outline"


@pytest.mark.parametrize("style", sorted(STYLES))
def test_a_batch_equals_one_by_one(style):
    rng = np.random.default_rng(0)
    model = simple_shapes.toy_classes()["bench"][0]
    vertices = model.surface_points(model.random_values(rng, 50))
    triangles = model.surface_triangles()
    rotations, scales = random_views(rng, 50, scale_range=(0.8, 3.0))
    batch = render_images(vertices, triangles, rotations, scales, size=224, style=style)
    for i in range(0, 50, 7):
        one = [slice(i, i + 1)]
        alone = render_images(vertices[*one], triangles, rotations[*one], scales[*one], size=224, style=style)
        assert_alike(batch[i], alone[0])


def test_instances_and_meshes_give_the_same_pictures():
    rng = np.random.default_rng(1)
    model = simple_shapes.toy_classes()["cross"][0]
    vertices = model.surface_points(model.random_values(rng, 3))
    objects = np.array([0, 0, 2, 1, 1, 0])
    rotations, scales = random_views(rng, 6)
    shared = render_images(vertices, model.surface_triangles(), rotations, scales, objects=objects, size=96)
    meshes = [TriangleMesh(one, model.surface_triangles()) for one in vertices]
    own = render_images(meshes, None, rotations, scales, objects=objects, size=96)
    assert np.array_equal(shared, own)
    for i, number in enumerate(objects):
        assert_alike(shared[i], draw(meshes[number], rotations[i : i + 1], scales[i : i + 1]))


def test_meshes_of_different_size_stay_apart():
    rng = np.random.default_rng(2)
    meshes = [simple_shapes.goblet(), simple_shapes.box(), simple_shapes.stool(), simple_shapes.crossing_sheets()]
    rotations, scales = random_views(rng, 4)
    together = render_images(meshes, None, rotations, scales, size=96)
    for i, mesh in enumerate(meshes):
        assert_alike(together[i], draw(mesh, rotations[i : i + 1], scales[i : i + 1]))


def test_many_vertices_are_sent_in_pieces(monkeypatch):
    rng = np.random.default_rng(4)
    meshes = [simple_shapes.goblet(), simple_shapes.stool()] * 4
    rotations, scales = random_views(rng, 8)
    whole = render_images(meshes, None, rotations, scales, size=64)
    monkeypatch.setattr(images_module, "MAX_BATCH_VERTICES", 400)
    pieces = render_images(meshes, None, rotations, scales, size=64)
    for a, b in zip(whole, pieces, strict=True):
        assert_alike(a, b)


@given(
    shift=st.tuples(*[st.floats(-1e4, 1e4)] * 3),
    factor=st.floats(1e-3, 1e3),
)
@settings(max_examples=15, deadline=None)
def test_place_and_size_of_the_object_do_not_matter(shift, factor):
    mesh = simple_shapes.stool()
    moved = mesh.transformed(np.eye(3), np.array(shift), factor)
    rotation, scale = random_views(np.random.default_rng(5), 1)
    assert_alike(draw(mesh, rotation, scale), draw(moved, rotation, scale))


SPHERE = {"framing": "sphere", "window": 1.0}


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 30))
@settings(max_examples=30, deadline=None)
def test_in_the_sphere_the_farthest_point_is_at_distance_1(seed, count):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(3, count, 3)) * rng.uniform(0.01, 100.0, (3, 1, 1)) + rng.uniform(-100.0, 100.0, 3)
    framed, _, _ = normalized_positions(points, np.repeat(np.arange(count), 3).reshape(-1, 3), "sphere")
    assert np.allclose(np.linalg.norm(framed, axis=2).max(axis=1), 1.0, atol=1e-5)
    assert np.allclose(framed.min(axis=1) + framed.max(axis=1), 0.0, atol=1e-5)


@pytest.mark.parametrize("style", ["fused", "lambert"])
def test_in_the_sphere_nothing_is_cut_off(style):
    meshes = [simple_shapes.goblet(), simple_shapes.stool(), simple_shapes.crossing_sheets(), simple_shapes.box()]
    rotations, _ = random_views(np.random.default_rng(7), 80)
    objects = np.repeat(np.arange(4), 20)
    pictures = render_images(
        meshes, None, rotations, np.full(80, 0.95), objects=objects, size=96, style=style, **SPHERE
    )
    ground = pictures[0, 0, 0]
    rim = np.concatenate([pictures[:, 0], pictures[:, -1], pictures[:, :, 0], pictures[:, :, -1]], axis=1)
    assert np.all(rim == ground)
    covered = (pictures != ground).any(axis=3)
    reach = [np.hypot(*(np.argwhere(one) - 47.5).T).max() / 48 for one in covered]
    assert max(reach) > 0.9, "and the room is used"


def _with_one_dense_side() -> TriangleMesh:
    """A box whose right side is cut into 8 x 8 squares."""
    box = simple_shapes.box((1.0, 0.6, 0.4))
    right = box.vertices[:, 0].max()
    others = box.faces[~(box.vertices[box.faces][:, :, 0] == right).all(axis=1)]
    y, z = (np.linspace(box.vertices[:, axis].min(), box.vertices[:, axis].max(), 9) for axis in (1, 2))
    points = np.array([(right, a, b) for a in y for b in z])
    row, column = (part.ravel() for part in np.meshgrid(np.arange(8), np.arange(8), indexing="ij"))
    first = row * 9 + column + len(box.vertices)
    dense = np.concatenate([np.stack([first, first + 1, first + 10], 1), np.stack([first, first + 10, first + 9], 1)])
    return TriangleMesh(np.concatenate([box.vertices, points]), np.concatenate([others, dense]))


def test_in_the_sphere_the_density_of_vertices_does_not_matter():
    plain, dense = simple_shapes.box((1.0, 0.6, 0.4)), _with_one_dense_side()
    rotations, _ = random_views(np.random.default_rng(8), 6)
    for rotation in rotations[:, None]:
        one, other = (draw(mesh, rotation, style="lambert", **SPHERE) for mesh in (plain, dense))
        assert_alike(one, other)
    by_mean = [draw(mesh, rotations[:1], style="lambert", framing="paper", window=2.0) for mesh in (plain, dense)]
    assert np.abs(by_mean[0].astype(np.int16) - by_mean[1]).mean() > 2, "the vertex mean moves with it"


@given(seed=st.integers(0, 1000))
@settings(max_examples=15, deadline=None)
def test_the_sphere_shows_every_object_whole_however_its_vertices_are_spread(seed):
    rng = np.random.default_rng(seed)
    size, place = rng.uniform(0.2, 1.0, 3), rng.uniform(-5, 5, 3)
    dense = simple_shapes.lathe([(0.1, -0.1), (0.1, 0.0), (0.1, 0.1)])
    mesh = simple_shapes.joined(
        [simple_shapes.box(size, place), TriangleMesh(dense.vertices * size + place, dense.faces)]
    )
    to_the_right, _ = Rotation.align_vectors([[1.0, 0.0, 0.0]], [size])
    turned = Rotation.from_euler("x", rng.uniform(0, 360), degrees=True) * to_the_right
    # Scale 0.9, as a line at the very rim of a picture could not be told from one that is cut off.
    picture = draw(mesh, turned.as_matrix()[None], 0.9 * ONE, size=200, window=1.0, framing="sphere")
    rows, columns = np.nonzero(foreground(picture))
    assert abs(columns.max() - 189) <= 3, "a corner of the box is the farthest point"
    assert abs(columns.min() - 10) <= 3
    assert min(rows.min(), 199 - rows.max()) >= 9


def test_vertices_without_a_face_do_not_matter_to_the_sphere():
    rotation, scale = random_views(np.random.default_rng(9), 1, scale_range=(0.7, 1.0))
    mesh = simple_shapes.stool()
    strays = np.array([[50.0, 0.0, 3.0], [-2.0, 70.0, 0.0]])
    littered = TriangleMesh(np.concatenate([strays, mesh.vertices]), mesh.faces + len(strays))
    options = {"window": 1.0, "framing": "sphere"}
    clean = draw(mesh, rotation, scale, **options)
    assert foreground(clean).mean() > 0.1
    assert np.array_equal(clean, draw(littered, rotation, scale, **options))
    instances = render_images(littered.vertices[None], littered.faces, rotation, scale, size=96, **options)
    assert np.array_equal(clean, instances[0])


def test_drawing_again_gives_the_same_bytes():
    rotations, scales = random_views(np.random.default_rng(6), 3)
    meshes = [simple_shapes.goblet()] * 3
    first = render_images(meshes, None, rotations, scales, size=128)
    render_images(meshes, None, rotations, scales, size=64, style="shaded")
    assert np.array_equal(first, render_images(meshes, None, rotations, scales, size=128))


def test_no_pictures_and_empty_tiles():
    nothing = render_images([simple_shapes.box()], None, np.zeros((0, 3, 3)), np.zeros(0), size=32)
    assert nothing.shape == (0, 32, 32, 3)
    assert renderer_name()


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"size": 0}, "size"),
        ({"size": 100_000}, "size"),
        ({"objects": np.array([1])}, "objects"),
        ({"triangles": simple_shapes.BOX_FACES}, "triangles"),
        ({"vertices": simple_shapes.BOX_CORNERS[None], "triangles": None}, "triangles"),
        ({"vertices": simple_shapes.BOX_CORNERS[None], "triangles": np.array([[0, 1, 9]])}, "triangles"),
        ({"vertices": np.full((1, 8, 3), np.nan), "triangles": simple_shapes.BOX_FACES}, "vertices"),
    ],
)
def test_bad_input_is_refused_with_its_place(change, where):
    good = {
        "vertices": [simple_shapes.box()],
        "triangles": None,
        "rotations": IDENTITY,
        "scales": ONE,
        "objects": np.zeros(1, dtype=np.int64),
        "size": 32,
    }
    with pytest.raises(RenderingError) as caught:
        render_images(**{**good, **change})
    assert caught.value.where == where
