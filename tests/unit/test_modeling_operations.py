"""What each operation does, on objects whose answer is known."""

import numpy as np
import pytest

from shapewright.errors import ModelError
from shapewright.modeling import CompiledModel, Recorder, Target, compile_model, imaged, mirrored, turned
from shapewright.modeling.elements import Element, Mirror, Turn, edge, face, image_matrix, vertex
from shapewright.modeling.operations.operation import Mode
from shapewright.modeling.program import Program, SlottedQuantities
from shapewright.modeling.program_kernels import WIDTH, fill_slots


def cube() -> Recorder:
    recorder = Recorder("cube", "cube")
    recorder.box(2.0, 2.0, 2.0, offset=(0.0, 0.0, -1.0))
    return recorder


TOP, BOTTOM, FRONT, RIGHT = face(1), face(0), face(2), face(3)


def compiled(recorder: Recorder) -> CompiledModel:
    return compile_model(recorder.build())


def edge_between(recorder: Recorder, first: int, second: int) -> Element:
    return edge(recorder.mesh.edge_between(first, second))


def test_ids_follow_creation() -> None:
    recorder = cube()
    np.testing.assert_array_equal(recorder.positions(vertex(0))[0], [-1, -1, -1])
    np.testing.assert_array_equal(recorder.positions(vertex(6))[0], [1, 1, 1])
    np.testing.assert_allclose(recorder.normal(TOP), [0, 0, 1])
    np.testing.assert_allclose(recorder.normal(FRONT), [0, -1, 0])
    recorder.extrude(TOP, 1.0)
    assert recorder.mesh.face(1) == (8, 9, 10, 11)
    assert recorder.mesh.face(6) == (4, 5, 9, 8)


def test_extrude_goes_along_the_cylindrical_coordinates_of_the_face() -> None:
    recorder = cube()
    recorder.extrude(RIGHT, z=0.5, rho=2.0, phi_deg=90.0)
    frame = recorder.frame(RIGHT)
    np.testing.assert_allclose(recorder.centre(RIGHT), [1.5, 0, 0] + 2.0 * frame[:, 1], atol=1e-12)
    assert compiled(recorder).is_closed


def test_rotation_extrude_turns_the_normal_moves_along_the_mean_and_scales_across() -> None:
    recorder = cube()
    along = edge_between(recorder, 4, 5)
    before = recorder.normal(TOP)
    recorder.rotation_extrude(TOP, along, 90.0, 3.0, 0.5)
    after = recorder.normal(TOP)
    assert before @ after == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(recorder.centre(TOP) - [0, 0, 1], 3.0 * (before + after) / np.sqrt(2), atol=1e-12)
    lengths = np.ptp(recorder.positions(TOP), axis=0)
    assert sorted(lengths) == pytest.approx([0.0, 1.0, 2.0])
    assert lengths[0] == pytest.approx(2.0)  # along the edge the width stays


def test_the_turn_does_not_depend_on_how_the_edge_was_made() -> None:
    forward, backward = cube(), cube()
    forward.rotation_extrude(FRONT, edge_between(forward, 0, 1), 30.0, 1.0)
    backward.rotation_extrude(face(4), edge_between(backward, 2, 3), 30.0, 1.0)
    turn = Turn("z", 180.0).matrix()
    np.testing.assert_allclose(backward.centre(face(4)), turn @ forward.centre(FRONT), atol=1e-12)


def test_a_curve_goes_on_where_it_ended() -> None:
    recorder = cube()
    recorder.extrude_curve(TOP, edge_between(recorder, 4, 5), [(30.0, 1.0)] * 3)
    assert recorder.normal(TOP) @ [0, 0, 1] == pytest.approx(0.0, abs=1e-12)
    assert compiled(recorder).is_closed


def test_a_path_is_a_row_of_extrusions() -> None:
    recorder = cube()
    recorder.extrude_path(TOP, [(0.0, 0.0, 1.0), (0.3, 0.4, 1.0)])
    frame = recorder.frame(TOP)
    np.testing.assert_allclose(recorder.centre(TOP), [0, 0, 3] + 0.3 * frame[:, 0] + 0.4 * frame[:, 1], atol=1e-12)


def test_insert_vertex_divides_its_edge_in_either_direction() -> None:
    recorder = cube()
    forward, backward = edge_between(recorder, 4, 5), edge_between(recorder, 6, 7)
    first, second = recorder.insert_vertex(forward, (backward, True), lambda1=0.25)
    np.testing.assert_allclose(recorder.positions(first)[0], [0.25 * -1 + 0.75 * 1, -1, 1])
    np.testing.assert_allclose(recorder.positions(second)[0], [0.5, 1, 1])
    assert recorder.mesh.edge(forward.id) == (4, first.id)
    recorder.connect(first, second)
    assert len(recorder.mesh.faces) == 7
    assert compiled(recorder).is_closed


def test_scale_and_rotate_keep_their_pivot() -> None:
    recorder = cube()
    recorder.scale(TOP, 0.5, "uv")
    assert sorted(np.ptp(recorder.positions(TOP), axis=0)) == pytest.approx([0, 1, 1])
    recorder.scale(Element("component", 0), 2.0, "z", pivot=BOTTOM)
    assert recorder.centre(BOTTOM)[2] == pytest.approx(-1.0)
    assert recorder.centre(TOP)[2] == pytest.approx(3.0)
    recorder.rotate(TOP, 90.0)
    np.testing.assert_allclose(recorder.centre(TOP), [0, 0, 3], atol=1e-12)
    recorder.rotate(Element("component", 0), 90.0, "u", pivot=BOTTOM)
    np.testing.assert_allclose(recorder.centre(TOP), [0, -4, -1], atol=1e-12)


def test_bridging_two_boxes_makes_one_closed_surface() -> None:
    recorder = Recorder("dumbbell", "dumbbell")
    left = recorder.box(1, 1, 1)
    right = recorder.box(1, 1, 1, offset=(3, 0, 0))
    recorder.connect(left.sides[1], right.sides[3])
    tube = [loop for loop in recorder.mesh.faces.values() if {v < 8 for v in loop} == {True, False}]
    assert len(tube) == 4
    for loop in tube:  # not twisted: no quad of the tube has a diagonal for an edge
        points = np.concatenate([recorder.positions(vertex(v)) for v in loop])
        assert np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).max() == pytest.approx(2.0)
    assert compiled(recorder).is_closed


def test_a_bridge_through_one_body_makes_a_ring() -> None:
    recorder = cube()
    recorder.extrude([TOP, BOTTOM])
    recorder.scale([TOP, BOTTOM], 0.5)
    recorder.connect(TOP, BOTTOM)
    mesh = recorder.mesh
    assert len(mesh.live_vertices()) - len(mesh.edges) + len(mesh.faces) == 0


def test_removing_undoes_inserting_and_cutting() -> None:
    recorder = cube()
    faces = dict(recorder.mesh.faces)
    first, second = recorder.insert_vertex(edge_between(recorder, 4, 5), edge_between(recorder, 6, 7))
    recorder.connect(first, second)
    cut = edge_between(recorder, first.id, second.id)
    recorder.remove(cut)
    recorder.remove(first, second)
    assert {frozenset(loop) for loop in recorder.mesh.faces.values()} == {frozenset(v) for v in faces.values()}


def test_removing_a_corner_joins_its_faces() -> None:
    recorder = cube()
    recorder.remove(vertex(6))
    assert len(recorder.mesh.faces) == 4
    assert recorder.mesh.is_closed()


def test_removing_a_face_opens_the_model() -> None:
    recorder = cube()
    recorder.remove(TOP)
    with pytest.raises(ModelError, match="open edges"):
        recorder.build()


def test_border_edges_can_be_closed_again() -> None:
    recorder = Recorder("sheets", "sheets", closed=False)
    recorder.base("sheet", (1, 1, 0))
    recorder.base("sheet", (1, 1, 0), offset=(2, 0, 0))
    recorder.connect(edge_between(recorder, 1, 2), edge_between(recorder, 4, 7))
    assert len(recorder.mesh.faces) == 3
    normals = [recorder.normal(face(f)) for f in recorder.mesh.faces]
    np.testing.assert_allclose(normals, [[0, 0, 1]] * 3)


def test_a_sheet_keeps_its_creases_when_it_is_extruded() -> None:
    recorder = Recorder("tray", "tray", closed=False)
    sheet = recorder.base("sheet", (1, 1, 0))[0].faces[0]
    recorder.mark_sharp(sheet)
    sharp = set(recorder.mesh.sharp_edges)
    recorder.extrude(sheet, 0.2)
    assert recorder.mesh.sharp_edges == sharp


@pytest.mark.parametrize("shape", ["box", "prism", "ring"])
def test_bases_are_closed_and_have_the_size_they_were_given(shape: str) -> None:
    recorder = Recorder("base", "base")
    recorder.base(shape, (3.0, 2.0, 0.5), sides=8)  # type: ignore[arg-type]
    model = compiled(recorder)
    points = model.control_points(np.ones((1, 0)))[0]
    np.testing.assert_allclose(np.ptp(points, axis=0), [3.0, 2.0, 0.5], atol=1e-12)
    assert model.instance(np.ones(0)).is_watertight


def test_an_anchored_component_follows_its_anchor() -> None:
    recorder = cube()
    recorder.parameter("height", "height", 0.5, 2.0)
    recorder.extrude(TOP, 1.0, length="height")
    lid = recorder.prism(6, 0.5, 0.1, anchor=TOP)
    model = compiled(recorder)
    points = model.control_points(np.array([[1.0], [2.0]]))
    rows = np.isin(model.control_vertex_ids, [v.id for v in recorder.vertices_of(lid.whole)])
    np.testing.assert_allclose(points[1, rows] - points[0, rows], np.tile([0, 0, 1.0], (12, 1)), atol=1e-12)


def test_mirrored_and_turned_targets_stay_symmetric_whatever_the_parameters() -> None:
    recorder = cube()
    recorder.parameter("arms", "arm length", 0.2, 3.0)
    recorder.parameter("sweep", "arm sweep", 0.2, 3.0)
    right, left = RIGHT, face(5)
    recorder.extrude([right, mirrored("x", left)], 0.7, 0.3, 20.0, length="arms")
    recorder.rotate([right, mirrored("x", left)], 25.0, "u", angle="sweep")
    recorder.scale([right, mirrored("x", left)], 0.5, "u", size="arms")
    model = compiled(recorder)
    values = model.random_values(np.random.default_rng(1), 4)
    for points in model.surface_points(values):
        flipped = points * [-1, 1, 1]
        nearest = np.linalg.norm(points[:, None] - flipped, axis=2).min(axis=1)
        assert nearest.max() < 1e-9


def test_copies_around_an_axis_are_turned_copies() -> None:
    recorder = Recorder("rotor", "rotor")
    hub = recorder.prism(8, 0.4, 0.2)
    anchors = [Target((hub.top,), "world"), *(turned("z", 120.0 * k, hub.top) for k in (1, 2))]
    blades = recorder.base("box", (1.0, 0.1, 0.02), offset=(0.6, 0.0, 0.0), anchors=anchors)
    recorder.rotate([blades[0].whole, *(turned("z", 120.0 * k, blades[k].whole) for k in (1, 2))], 15.0, "u")
    first, second = (recorder.positions(blade.whole) for blade in blades[:2])
    np.testing.assert_allclose(second, first @ Turn("z", 120.0).matrix().T, atol=1e-12)
    assert compiled(recorder).is_closed


def test_a_mirrored_component_faces_outwards() -> None:
    recorder = cube()
    image = (Mirror("x"), Turn("z", 30.0))
    made = recorder.base("box", (1, 1, 1), offset=(3, 0, 0), anchors=[Target((), "world"), imaged(image)])
    for component in made:
        middle = recorder.centre(component.whole)
        for each in recorder.faces_of(component):
            assert recorder.normal(each) @ (recorder.centre(each) - middle) > 0
    assert np.linalg.det(image_matrix(image)) == pytest.approx(-1.0)


def changed(amounts: dict[str, float], mode: Mode, x: float) -> dict[str, float]:
    """Return what a parameter x makes of the quantities of an operation."""
    program = Program()
    SlottedQuantities(program, amounts, [(change, 0) for change in mode])
    slots = np.array(program.slots)
    lanes = np.repeat(slots, WIDTH)
    fill_slots(lanes, slots, np.array(program.changes), np.zeros((0, 2), dtype=np.int64), np.array([[x]]), 0)
    return dict(zip(amounts, lanes[::WIDTH].tolist(), strict=True))


@pytest.mark.parametrize(
    ("kind", "mode", "x", "expected"),
    [
        ("extrude", "length", 2.0, {"rho": 0.6, "phi_deg": 30.0, "z": 1.0}),
        ("extrude", "angle", 1.5, {"rho": 0.3, "phi_deg": 120.0, "z": 0.5}),
        ("drag", "length", -8.0, {"rho": -2.4, "phi_deg": 30.0, "z": -4.0}),
        ("rotation_extrude", "length", 2.0, {"width": 0.8, "length": 1.0}),
        ("rotation_extrude", "width", 0.5, {"width": 0.4, "length": 0.5}),
        ("insert_vertex", "position", 0.1, {"lambda1": 0.04}),
        ("scale", "size", 3.0, {"sigma": 1.8}),
        ("rotate", "angle", -1.0, {"alpha_deg": -40.0}),
    ],
)
def test_modes_are_those_of_table_1(kind: str, mode: str, x: float, expected: dict[str, float]) -> None:
    from shapewright.modeling.operations import OPERATIONS

    start = {"rho": 0.3, "phi_deg": 30.0, "z": 0.5, "width": 0.8, "length": 0.5}
    start |= {"lambda1": 0.4, "sigma": 0.6, "alpha_deg": 40.0}
    amounts = {name: start[name] for name in OPERATIONS[kind].quantities}
    assert changed(amounts, OPERATIONS[kind].modes[mode], x) == pytest.approx(expected)
    assert changed(amounts, OPERATIONS[kind].modes[mode], 1.0) == pytest.approx(amounts)


def test_a_vertex_beyond_the_middle_slides_as_the_mirror_image() -> None:
    from shapewright.modeling.operations import InsertVertex

    slide = InsertVertex.modes["position"]
    below = changed({"lambda1": 0.3}, slide, 0.4)["lambda1"]
    above = changed({"lambda1": 0.7}, slide, 1.6)["lambda1"]
    assert above == pytest.approx(1.0 - below)


def test_a_refused_operation_leaves_the_recorder_as_it_was() -> None:
    recorder = cube()
    with pytest.raises(ModelError, match=r"operations\[1\] \(connect\)"):
        recorder.connect(TOP, FRONT)
    with pytest.raises(ModelError, match="f99 does not exist"):
        recorder.extrude([TOP, face(99)], 1.0)
    assert recorder.mesh.faces == cube().mesh.faces
    assert len(recorder.build().operations) == 1


def test_every_target_turns_about_its_own_hinge() -> None:
    recorder = cube()
    right, left = recorder.mesh.face(RIGHT.id), recorder.mesh.face(5)
    arms = [Target((RIGHT,)), mirrored("x", face(5))]
    recorder.extrude(arms, 3.0)
    hinges = [tuple(vertex(v) for v in loop) for loop in (right, left)]
    ends = [Target((RIGHT,), "world", pivot=hinges[0]), Target((face(5),), "world", (Mirror("x"),), hinges[1])]
    recorder.rotate(ends, 90.0, "v")
    np.testing.assert_allclose(recorder.centre(RIGHT), [1, 0, -3], atol=1e-12)
    np.testing.assert_allclose(recorder.centre(face(5)), [-1, 0, -3], atol=1e-12)
    model = recorder.build()
    assert type(model).from_json(model.to_json()) == model


def test_a_hinge_means_nothing_to_a_move() -> None:
    hinged = Target((TOP,), pivot=(BOTTOM,))
    recorder = cube()
    for refused in (lambda: recorder.drag([hinged], 1.0), lambda: recorder.box(1.0, 1.0, 1.0, anchor=hinged)):
        with pytest.raises(ModelError, match="turns about no pivot"):
            refused()
