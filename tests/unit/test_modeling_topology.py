"""What stays the same when the topology changes, and documents that ask for too much of it."""

import copy

import numpy as np
import pytest

from shapewright.errors import ModelError
from shapewright.modeling import ProceduralModel, Recorder, compile_model
from shapewright.modeling.control_mesh import ControlMesh
from shapewright.modeling.elements import edge, face, vertex
from shapewright.modeling.upgrade import FORMAT, VERSION


def box() -> Recorder:
    recorder = Recorder("box", "box", closed=False)
    recorder.box(1, 1, 1)
    return recorder


def model(*operations: dict[str, object], **parameters: list[dict[str, object]]) -> ProceduralModel:
    """Return an open model of some operations in the words of a document."""
    document = {"format": FORMAT, "version": VERSION, "name": "a", "class": "a", "closed": False}
    return ProceduralModel.from_document({**document, "operations": list(operations), **parameters})


BOX: dict[str, object] = {"op": "base", "shape": "box", "size": [1, 1, 1]}
LARGE_RING: dict[str, object] = {
    "op": "base",
    "shape": "ring",
    "size": [4, 4, 1],
    "sides": 128,
    "tube_sides": 128,
}


@pytest.mark.parametrize("edge_id", range(12))
def test_splitting_an_edge_leaves_the_frames_of_its_faces(edge_id: int) -> None:
    recorder = box()
    faces = [face(f) for f in recorder.mesh.faces]
    before = [recorder.frame(f) for f in faces]
    recorder.insert_vertex(edge(edge_id))
    np.testing.assert_allclose([recorder.frame(f) for f in faces], before, atol=1e-12)


def test_removing_an_inserted_vertex_gives_the_crease_back() -> None:
    recorder = box()
    recorder.mark_sharp(face(1))
    inserted = recorder.insert_vertex(edge(4), edge(0))
    recorder.remove(*inserted)
    assert len(recorder.mesh.sharp_edges) == 4


def test_half_a_crease_does_not_make_one() -> None:
    recorder = box()
    (middle,) = recorder.insert_vertex(edge(4))
    recorder.mark_sharp(edge(4))
    recorder.remove(middle)
    assert recorder.mesh.sharp_edges == set()


def test_a_component_that_is_not_there_cannot_be_removed() -> None:
    remove = {"op": "remove", "elements": ["c0"]}
    for number, component in enumerate(["c7", "c0"]):
        operations = [BOX, BOX, *[remove] * number, {"op": "remove", "elements": [component]}]
        with pytest.raises(ModelError, match=component) as caught:
            compile_model(model(*operations))
        assert caught.value.where == f"operations[{2 + number}]"


def test_a_face_is_extruded_once_at_a_time() -> None:
    with pytest.raises(ModelError, match="f1 is selected twice"):
        box().extrude([face(1), face(1)], 1.0)


def test_no_face_is_wound_against_its_neighbour() -> None:
    mesh = ControlMesh()
    component = mesh.add_component()
    for _ in range(5):
        mesh.add_vertex(component)
    mesh.add_face((0, 1, 2))
    with pytest.raises(ModelError, match="wound against"):
        mesh.add_face((0, 1, 3))
    middle, _ = mesh.split_edge(mesh.edge_between(0, 1))
    with pytest.raises(ModelError, match="wound against"):
        mesh.add_face((middle, 1, 3))
    mesh.add_face((1, middle, 3))
    with pytest.raises(ModelError, match="third face"):
        mesh.add_face((1, middle, 4))


def test_a_refused_operation_in_the_middle_of_its_work_leaves_no_trace() -> None:
    recorder = box()
    recorder.insert_vertex(edge(0))
    before = copy.deepcopy(vars(recorder.mesh))
    for wrong in (vertex(0), face(77)):
        with pytest.raises(ModelError):
            recorder.remove(face(1), edge(2), wrong, wrong)
    assert vars(recorder.mesh) == before


@pytest.mark.parametrize(
    ("operations", "message"),
    [
        ([LARGE_RING, {"op": "drag", "targets": [{"elements": ["c0"]}] * 20_000}], "too much work"),
        ([LARGE_RING] + [{"op": "scale", "sigma": 2, "targets": [{"elements": ["c0"]}]}] * 1000, "too much work"),
        ([BOX, {"op": "drag", "targets": [{"elements": ["v0"]}] * 20_000}], "too much work"),
        ([BOX, {"op": "insert_vertex", "edges": ["e0"] * 50_000}], "corners"),
        (
            [
                {**BOX, "shape": "prism", "sides": 256},
                *({"op": "connect", "first": "v0", "second": f"v{i}"} for i in range(2, 255)),
                {"op": "rotate", "alpha_deg": 9, "targets": [{"elements": ["v0"]}] * 6000},
            ],
            "too much work",
        ),
    ],
    ids=["one component many times", "many operations", "many targets", "corners", "valence"],
)
def test_a_small_document_cannot_ask_for_endless_work(operations: list[dict[str, object]], message: str) -> None:
    with pytest.raises(ModelError, match=message) as caught:
        compile_model(model(*operations))
    assert caught.value.where is not None
    assert caught.value.where.startswith("operations[")


def test_an_element_named_many_times_counts_once() -> None:
    drag = {"op": "drag", "z": 1, "targets": [{"elements": ["c0"] * 50_000, "frame": "world"}]}
    points = compile_model(model(LARGE_RING, drag)).control_points(np.ones((1, 0)))[0]
    assert points[:, 2].mean() == pytest.approx(1.0)


def test_a_parameter_with_very_many_targets_is_refused() -> None:
    drag = {"op": "drag", "z": 1, "targets": [{"elements": ["v0"]}]}
    parameter = {"name": "a", "label": "a", "range": [0, 2], "targets": [{"operation": 1, "mode": "length"}] * 30_000}
    with pytest.raises(ModelError, match="at most") as caught:
        model(BOX, drag, parameters=[parameter])
    assert caught.value.where == "parameters[0].targets"


@pytest.mark.parametrize("size", [1e-3, 1e-5, 1e-7, 1e-9])
def test_a_very_small_face_still_has_its_normal(size: float) -> None:
    recorder = box()
    side = face(3)
    recorder.scale(side, size)
    recorder.extrude(side, 1.0)
    np.testing.assert_allclose(recorder.centre(side), [1.5, 0.0, 0.5], atol=1e-9)


def test_a_collapsed_face_does_not_bend_the_normal_of_its_neighbours() -> None:
    recorder = box()
    recorder.extrude(face(3), 0.0)  # its sides have no area
    between = edge(recorder.mesh.edge_between(1, 2))  # of the bottom and of such a side
    np.testing.assert_allclose(recorder.frame(between)[:, 2], [0.0, 0.0, -1.0], atol=1e-9)


def test_targets_that_share_vertices_move_one_after_the_other() -> None:
    recorder = box()
    recorder.drag([face(1), face(3)], 1.0)
    np.testing.assert_allclose(recorder.positions(vertex(6))[0], [1.5, 0.5, 2.0])
    np.testing.assert_allclose(recorder.positions(vertex(7))[0], [-0.5, 0.5, 2.0])


def test_an_edge_split_twice_at_once_is_split_one_after_the_other() -> None:
    recorder = box()
    ends = recorder.positions(edge(0))
    first, second = recorder.insert_vertex(edge(0), edge(0))
    np.testing.assert_allclose(recorder.positions(first)[0], ends.mean(axis=0))
    np.testing.assert_allclose(recorder.positions(second)[0], 0.75 * ends[0] + 0.25 * ends[1])
