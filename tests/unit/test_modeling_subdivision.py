"""Catmull-Clark surfaces whose shape is known."""

import numpy as np
import pytest

from shapewright.errors import ModelError
from shapewright.modeling import Component, Recorder, compile_model
from shapewright.modeling.elements import Element, edge, face, vertex
from shapewright.modeling.subdivision import Polygons, subdivide


def cube(*, sharp: bool = False) -> Recorder:
    recorder = Recorder("cube", "cube")
    box = recorder.box(2, 2, 2, offset=(0, 0, -1))
    if sharp:
        recorder.mark_sharp(*box.faces)
    return recorder


def test_a_smooth_cube_shrinks_towards_the_known_points() -> None:
    points = compile_model(cube().build()).surface_points(np.ones((1, 0)), steps=1)[0]
    np.testing.assert_allclose(np.abs(points[:8]), 5 / 9)  # a corner of valence 3: (Q + 2R) / 3
    np.testing.assert_allclose(np.abs(points[8:20]).max(axis=1), 0.75)  # edges: mean of 2 ends and 2 faces
    np.testing.assert_allclose(np.sort(np.abs(points[20:]), axis=1), np.tile([0, 0, 1], (6, 1)), atol=1e-12)


def test_a_cube_with_sharp_edges_stays_a_cube() -> None:
    points = compile_model(cube(sharp=True).build()).surface_points(np.ones((1, 0)), steps=3)[0]
    np.testing.assert_allclose(np.abs(points).max(axis=1), 1.0)
    corners = np.abs(points).sum(axis=1) > 3 - 1e-9
    assert corners.sum() == 8


def test_a_crease_stays_a_curve_of_its_own_vertices() -> None:
    recorder = cube()
    loop = recorder.mesh.face(1)
    ring = [edge(recorder.mesh.edge_between(a, b)) for a, b in zip(loop, loop[1:] + loop[:1], strict=True)]
    recorder.mark_sharp(*ring)
    compiled = compile_model(recorder.build())
    points = compiled.surface_points(np.ones((1, 0)), steps=2)[0]
    rim = points[np.isclose(points[:, 2], 1.0)]
    assert len(rim) == 25  # the top face is flat to its border: the crease keeps it there
    polygons = compiled.surface_polygons(2)
    on_crease = sorted({v for pair in polygons.sharp_edges for v in pair})
    assert len(on_crease) == 16
    np.testing.assert_allclose(points[on_crease][:, 2], 1.0)


def test_a_dart_is_smooth_and_a_sharp_vertex_is_a_corner() -> None:
    dart, corner = cube(), cube()
    dart.mark_sharp(edge(dart.mesh.edge_between(4, 5)))
    corner.mark_sharp(vertex(6))
    smooth = compile_model(cube().build()).surface_points(np.ones((1, 0)), 1)[0]
    darted = compile_model(dart.build()).surface_points(np.ones((1, 0)), 1)[0]
    np.testing.assert_allclose(darted[:8], smooth[:8])
    cornered = compile_model(corner.build()).surface_points(np.ones((1, 0)), 3)[0]
    np.testing.assert_allclose(cornered[6], [1, 1, 1])


def test_a_crease_can_be_smoothed_again_and_goes_on_over_a_split() -> None:
    recorder = cube(sharp=True)
    split = edge(recorder.mesh.edge_between(4, 5))
    recorder.insert_vertex(split)
    assert len(recorder.mesh.sharp_edges) == 13
    recorder.mark_sharp(split, sharp=False)
    assert len(recorder.mesh.sharp_edges) == 12


def test_a_border_shrinks_only_along_itself() -> None:
    sheet = Polygons(4, ((0, 1, 2, 3),))
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    points = subdivide(sheet).matrix @ square
    np.testing.assert_allclose(points[4], [0.5, 0, 0])
    np.testing.assert_allclose(points[0], [0.125, 0.125, 0])


@pytest.mark.parametrize("steps", [1, 2, 3])
def test_chunks_make_up_the_batch(steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    recorder = cube()
    recorder.parameter("height", "height", 0.5, 2.0)
    recorder.extrude(recorder.faces_towards(_component(recorder), (0, 0, 1))[0], 1.0, length="height")
    compiled = compile_model(recorder.build())
    values = compiled.random_values(np.random.default_rng(0), 11)
    whole = compiled.surface_points(values, steps)
    controls = compiled.control_points(values)
    monkeypatch.setattr("shapewright.modeling.compiled._CHUNK_BYTES", 3 * whole[0].nbytes)
    chunks = list(compiled.surface_chunks(values, steps))
    assert 3 <= len(chunks) <= 6
    assert [start for start, _ in chunks] == np.cumsum([0, *(len(points) for _, points in chunks)])[:-1].tolist()
    np.testing.assert_allclose(compiled.control_points(values), controls, atol=1e-12)
    np.testing.assert_allclose(np.concatenate([points for _, points in chunks]), whole, atol=1e-12)


def test_a_surface_of_too_many_weights_or_vertices_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shapewright.modeling.surface_levels.MAX_SURFACE_WEIGHTS", 10_000)
    monkeypatch.setattr("shapewright.modeling.surface_levels.MAX_SURFACE_VERTICES", 1000)
    many_corners = Recorder("corners", "corners")
    many_corners.base("prism", (1, 1, 1), sides=100)
    with pytest.raises(ModelError, match="corners"):
        compile_model(many_corners.build()).surface_polygons(1)
    compiled = compile_model(cube().build())
    assert compiled.surface_polygons(3).n_vertices == 386
    with pytest.raises(ModelError, match="more than 1000 vertices after 4"):
        compiled.surface_polygons(4)


def _component(recorder: Recorder) -> Component:

    return Component(Element("component", 0), tuple(face(f) for f in recorder.mesh.faces))
