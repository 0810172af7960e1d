import csv

import numpy as np
import pytest
import pywt
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shapewright.distances import panorama_kernel as kernel
from shapewright.distances.panorama import (
    DESCRIPTOR_SIZE,
    PanoramaDescriptor,
    panorama_descriptor,
    panorama_descriptors,
    panorama_distance,
    panorama_distances,
)
from shapewright.errors import MeshError
from shapewright.mesh.file import load_mesh

ROTATION_TOLERANCE = 1e-3
"""What a rotation may change, in a distance that lies in [0, 2] and is 0.3 and more between kinds of objects."""


def described(mesh):
    return panorama_descriptor(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64))


def chair():
    """An object with distinct principal axes and no symmetry but one mirror."""
    parts = [trimesh.creation.box((1.0, 1.2, 0.1)), trimesh.creation.box((0.1, 1.2, 1.5))]
    parts[1].apply_translation((-0.45, 0, 0.7))
    for x, y in ((0.4, 0.5), (0.4, -0.5), (-0.4, 0.5), (-0.4, -0.5)):
        leg = trimesh.creation.cylinder(0.05, 0.8, sections=12)
        leg.apply_translation((x, y, -0.4))
        parts.append(leg)
    return trimesh.util.concatenate(parts)


@pytest.fixture(scope="module")
def zoo():
    return {
        "box": described(trimesh.creation.box((1.0, 0.8, 0.6))),
        "ball": described(trimesh.creation.icosphere(3)),
        "rod": described(trimesh.creation.cylinder(0.05, 2.0)),
        "plate": described(trimesh.creation.box((1.0, 0.7, 0.02))),
        "chair": described(chair()),
    }


def test_size_is_the_stated_one(zoo):
    assert DESCRIPTOR_SIZE == 6 * kernel.AXIS_SIZE
    assert zoo["box"].to_array().shape == (DESCRIPTOR_SIZE,)
    assert zoo["box"].to_array().dtype == np.float32
    again = PanoramaDescriptor.from_array(zoo["box"].to_array())
    assert panorama_distance(zoo["box"], again) == 0


def test_distance_laws(zoo):
    names = sorted(zoo)
    for a in names:
        assert panorama_distance(zoo[a], zoo[a]) == 0
        for b in names:
            assert panorama_distance(zoo[a], zoo[b]) == panorama_distance(zoo[b], zoo[a])
            if a != b:
                assert 0.3 < panorama_distance(zoo[a], zoo[b]) < 2, (a, b)


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    scale=st.floats(1e-3, 1e3),
    shift=st.tuples(*[st.floats(-100, 100)] * 3),
)
def test_rotation_scale_and_shift_hardly_matter(seed, scale, shift):
    mesh = chair()
    turned = mesh.copy()
    turned.vertices = scale * (
        Rotation.random(rng=np.random.default_rng(seed)).apply(mesh.vertices)
    ) + scale * np.array(shift)
    assert panorama_distance(described(mesh), described(turned)) < ROTATION_TOLERANCE


def test_a_mirror_image_is_another_object_unless_the_object_is_symmetric():
    mesh = chair()
    mirrored = mesh.copy()
    mirrored.vertices = mesh.vertices * (1, -1, 1)  # its own symmetry
    assert panorama_distance(described(mesh), described(mirrored)) < ROTATION_TOLERANCE
    lump = trimesh.creation.box((0.3, 0.4, 0.5))
    lump.apply_translation((0.6, 0.8, 1.0))
    handed = trimesh.util.concatenate([mesh, lump])
    mirrored = handed.copy()
    mirrored.vertices = handed.vertices * (1, -1, 1)
    assert panorama_distance(described(handed), described(mirrored)) > 2 * ROTATION_TOLERANCE


def test_batch_equals_one_by_one():
    mesh = chair()
    stretched = np.array(mesh.vertices) * np.random.default_rng(0).uniform(0.5, 2, (7, 1, 3))
    triangles = np.array(mesh.faces, dtype=np.int64)
    batch = panorama_descriptors(stretched, triangles)
    singles = [panorama_descriptor(vertices, triangles) for vertices in stretched]
    assert len(batch) == 7
    np.testing.assert_array_equal(batch.to_array(), [single.to_array() for single in singles])
    np.testing.assert_array_equal(
        panorama_distances(singles[0], batch), [panorama_distance(singles[0], single) for single in singles]
    )


def test_winding_does_not_matter():
    mesh = chair()
    soup = np.array(mesh.faces, dtype=np.int64)
    soup[::3] = soup[::3, ::-1]
    again = panorama_descriptor(np.array(mesh.vertices), soup)
    np.testing.assert_allclose(again.to_array(), described(mesh).to_array(), atol=1e-5)


def test_cutting_triangles_finer_does_not_matter():
    mesh = chair()
    fine = mesh.subdivide().subdivide()
    assert panorama_distance(described(mesh), described(fine)) < ROTATION_TOLERANCE


def test_maps_of_a_ball_and_of_a_box_are_the_analytic_ones():
    heights = (np.arange(kernel.ROWS) + 0.5) * 2 / kernel.ROWS - 1
    angles = (np.arange(kernel.COLUMNS) + 0.5) * 2 * np.pi / kernel.COLUMNS
    ball = trimesh.creation.icosphere(5, radius=0.5)
    depth, normal = drawn(np.array(ball.vertices), ball.faces)
    inside = abs(heights) < 0.45
    expected = np.sqrt(0.25 - heights[inside] ** 2)
    np.testing.assert_allclose(depth[inside], np.tile(expected[:, None], kernel.COLUMNS), atol=2e-3)
    np.testing.assert_allclose(normal[inside], np.tile((2 * expected[:, None]) ** 4, kernel.COLUMNS), atol=0.05)
    assert (depth[abs(heights) > 0.5] == 0).all()

    box = trimesh.creation.box((1.0, 0.6, 3.0))  # higher than the cylinder: its ends just cut it
    depth, normal = drawn(np.array(box.vertices), box.faces)
    expected = np.minimum(0.5 / abs(np.cos(angles)), 0.3 / abs(np.sin(angles)))
    np.testing.assert_allclose(depth, np.tile(expected, (kernel.ROWS, 1)), rtol=1e-6)
    cosine = np.where(0.5 / abs(np.cos(angles)) < 0.3 / abs(np.sin(angles)), np.cos(angles), np.sin(angles))
    np.testing.assert_allclose(normal, np.tile(cosine**4, (kernel.ROWS, 1)), atol=1e-6)


def test_the_farthest_hit_within_the_cylinder_counts():
    boxes = [trimesh.creation.box((width, width, 0.5)) for width in (0.5, 1.0, 5.0)]
    mesh = trimesh.util.concatenate(boxes)
    depth, _ = drawn(np.array(mesh.vertices), mesh.faces)
    one, _ = drawn(np.array(boxes[1].vertices), boxes[1].faces)
    np.testing.assert_array_equal(depth, one)


def test_a_triangle_across_the_seam_and_out_of_the_cylinder_is_drawn_without_gaps():
    vertices = np.array([(0.5, -0.4, -2.0), (0.5, 0.4, -2.0), (0.5, 0.0, 3.0)])
    depth, _ = drawn(vertices, [(0, 1, 2)])
    row = depth[0]
    hit = np.flatnonzero(row)
    half_angle = np.arctan2(0.4 * (1 - 1 / 5), 0.5)
    assert len(hit) == pytest.approx(kernel.COLUMNS * half_angle / np.pi, abs=2)
    assert set(hit) == {*range(len(hit) // 2), *range(kernel.COLUMNS - len(hit) // 2, kernel.COLUMNS)}
    assert (depth > 0).any(axis=1).sum() == kernel.ROWS


def drawn(vertices, faces):
    depth = np.zeros((kernel.ROWS, kernel.COLUMNS), dtype=np.float32)
    normal = np.zeros_like(depth)
    kernel.draw_cylinder(vertices.astype(float), np.array(faces, dtype=np.int64), 4.0, depth, normal)
    return depth, normal


@pytest.mark.parametrize("name", ["haar", "coif1"])
def test_wavelet_levels_agree_with_pywavelets(name):
    image = np.random.default_rng(1).random((kernel.ROWS, kernel.COLUMNS)).astype(np.float32)
    wavelet = pywt.Wavelet(name)
    low, high = (np.array(taps, dtype=np.float32) for taps in (wavelet.dec_lo, wavelet.dec_hi))
    work, spare = image.copy(), np.empty_like(image)
    coarse = image
    for level in range(kernel.LEVELS):
        rows, columns = kernel.ROWS >> level, kernel.COLUMNS >> level
        coarse, details = pywt.dwt2(coarse, wavelet, mode="periodization")
        kernel.analyse(work, spare, rows, columns, low, high)
        rows, columns = rows // 2, columns // 2
        bands = (
            work[rows : 2 * rows, :columns],
            work[:rows, columns : 2 * columns],
            work[rows : 2 * rows, columns : 2 * columns],
        )
        for band, detail in zip(bands, details, strict=True):
            np.testing.assert_allclose(band, detail, atol=1e-4)
        np.testing.assert_allclose(work[:rows, :columns], coarse, rtol=1e-4)


@pytest.mark.parametrize("turn", [(1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
def test_the_sign_of_the_axes_does_not_matter(turn):
    """Half turns of the frame, by which eigenvectors may come, leave all features as they are."""
    mesh = chair()
    lump = trimesh.creation.box((0.3, 0.4, 0.5))
    lump.apply_translation((0.6, 0.8, 1.0))
    handed = trimesh.util.concatenate([mesh, lump])
    turned = panorama_descriptor(np.array(handed.vertices) * turn, np.array(handed.faces, dtype=np.int64))
    np.testing.assert_allclose(turned.to_array(), described(handed).to_array(), atol=2e-3)


def test_refusals():
    mesh = trimesh.creation.box()
    vertices, triangles = np.array(mesh.vertices)[None], np.array(mesh.faces, dtype=np.int64)
    with pytest.raises(MeshError, match="index"):
        panorama_descriptors(vertices, triangles + 1)
    with pytest.raises(MeshError, match="no triangles"):
        panorama_descriptors(vertices, triangles[:0])
    with pytest.raises(MeshError, match=r"vertices\[1\].*NaN"):
        panorama_descriptors(np.concatenate([vertices, vertices * np.nan]), triangles)
    with pytest.raises(MeshError, match=r"vertices\[1\].*area"):
        panorama_descriptors(np.concatenate([vertices, vertices * 0]), triangles)
    with pytest.raises(MeshError, match="bank"):
        panorama_distances(panorama_descriptor(vertices[0], triangles), np.zeros((2, 7), dtype=np.float32))


@pytest.mark.real_data
def test_real_objects_are_nearest_to_their_own_class(real_data):
    with (real_data / "labels.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if int(row["faces"]) < 20_000]
    banks = {}
    for name in ("sword", "table", "glass_with_stem", "bicycle"):
        files = [real_data / row["file"] for row in rows if row["class"] == name][:8]
        meshes = [load_mesh(file) for file in files]
        banks[name] = np.array([panorama_descriptor(m.vertices, m.faces).to_array() for m in meshes])
    for own, bank in banks.items():
        medians = {
            other: np.median([panorama_distances(PanoramaDescriptor(row), banks[other]) for row in bank])
            for other in banks
        }
        assert min(medians, key=medians.get) == own, (own, medians)
