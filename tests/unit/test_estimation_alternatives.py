"""Other answers: which count, which are the same up to symmetry, and what they are called."""

from dataclasses import replace

import numpy as np
import pytest
from chair_model import armchair
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import Pose
from shapewright.estimation.alternatives import Contender, list_alternatives
from shapewright.estimation.result import Distances, ParameterEstimate
from shapewright.estimation.turns import find_turn
from shapewright.modeling.symmetry import NO_SYMMETRY, Symmetry


def choice(label, option, active=True):
    return ParameterEstimate(label.lower(), label, None, 1.0, None, 1.0, 3.0, active, option)


def turned(axis, angle_deg):
    return Pose(Rotation.from_rotvec(np.deg2rad(angle_deg) * np.eye(3)["xyz".index(axis)]).as_matrix())


def contender(zbuffer=0.1, *, pose=None, options=(), model="helicopter", symmetry=NO_SYMMETRY):
    return Contender(
        model=replace(armchair(), name=model),
        values=np.ones(len(options)),
        parameters=tuple(options),
        pose=pose or Pose(),
        distances=Distances(1.0, 0.01, zbuffer, 100.0),
        symmetry=symmetry,
    )


def labels(best, *others):
    return [(found.kind, found.label) for found in list_alternatives(best, [best, *others])]


def test_a_symmetry_group_holds_what_its_maps_make():
    sizes = {
        NO_SYMMETRY: 1,
        Symmetry(mirrors=("y",)): 1,
        Symmetry(mirrors=("x", "y")): 2,
        Symmetry(mirrors=("x", "y", "z")): 4,
        Symmetry(axis="z", order=5): 5,
        Symmetry(mirrors=("x", "y"), axis="z", order=12): 12,
        Symmetry(mirrors=("x", "z"), axis="z", order=3): 6,
    }
    for symmetry, size in sizes.items():
        group = symmetry.rotations()
        assert len(group) == size
        assert group[0] == pytest.approx(np.eye(3))
        products = group[:, None] @ group[None]
        nearest = np.abs(products[:, :, None] - group).max(axis=(3, 4)).min(axis=2)
        assert nearest.max() < 1e-9, "closed"


def test_a_pose_counts_unless_it_is_the_same_up_to_symmetry():
    best = contender()
    assert labels(best, contender(0.105, pose=turned("x", 178))) == [("pose", "turned half around x")]
    assert labels(best, contender(0.105, pose=turned("z", 5))) == []
    table = Symmetry(mirrors=("x", "y"))
    best = contender(symmetry=table)
    assert labels(best, contender(pose=turned("z", 180), symmetry=table)) == []
    assert labels(best, contender(pose=turned("z", 88), symmetry=table)) == [("pose", "turned a quarter around z")]


def test_a_turn_is_measured_in_the_models_own_axes():
    lying = turned("y", 90).rotation
    apart, turn = find_turn(lying, lying @ turned("z", 180).rotation, NO_SYMMETRY)
    assert apart == pytest.approx(180)
    assert str(turn) == "turned half around z"
    apart, turn = find_turn(lying, turned("z", 180).rotation @ lying, NO_SYMMETRY)
    assert (apart, str(turn)) == (pytest.approx(180), "turned half around x")
    oblique = Rotation.from_rotvec(np.deg2rad(40) * np.array([0.6, 0.8, 0.0])).as_matrix()
    assert str(find_turn(np.eye(3), oblique, NO_SYMMETRY)[1]) == "turned by 40° around (0.6, 0.8, 0)"


def test_only_what_fits_about_as_well_counts():
    best = contender(0.5)
    flip = turned("z", 180)
    assert labels(best, contender(0.549, pose=flip)) != []
    assert labels(best, contender(0.551, pose=flip)) == []
    best = contender(0.05)
    assert labels(best, contender(0.069, pose=flip)) != []
    assert labels(best, contender(0.071, pose=flip)) == []


def test_options_are_named_by_what_is_different():
    best = contender(options=[choice("Rotor", "four blades"), choice("Blades", "broad")])
    disc = contender(0.11, options=[choice("Rotor", "disc"), choice("Blades", "broad", active=False)])
    assert labels(best, disc) == [("option", "Rotor: disc instead of four blades")]
    both = replace(disc, pose=turned("z", 180))
    assert labels(best, both) == [("option", "Rotor: disc instead of four blades; turned half around z")]
    only_active = contender(options=[choice("Rotor", "four blades"), choice("Blades", "narrow", active=False)])
    assert labels(best, only_active) == [("option", "no Blades")]


def test_one_fit_of_another_model_is_enough_and_the_nearest_comes_first():
    best = contender(0.1)
    far, near = (contender(z, model="helicopter_tandem") for z in (0.115, 0.112))
    flip = contender(0.118, pose=turned("z", 180))
    found = list_alternatives(best, [flip, far, near])
    assert [(a.kind, a.label) for a in found] == [
        ("model", "model helicopter_tandem"),
        ("pose", "turned half around z"),
    ]
    assert found[0].distances.zbuffer == 0.112


def test_fits_that_differ_in_measures_alone_are_one():
    best = contender()
    flip = contender(0.11, pose=turned("z", 180))
    again = replace(flip, pose=turned("z", 176), distances=replace(flip.distances, zbuffer=0.115))
    assert labels(best, flip, again) == [("pose", "turned half around z")]
    assert labels(best, replace(best, values=np.zeros(0))) == []
