"""Small models and prepared queries for tests of the fast estimator."""

import numpy as np
from scipy.spatial.transform import Rotation

from shapewright.distances.alignment import Pose
from shapewright.distances.zbuffer import ZBufferTarget
from shapewright.estimation.fast.candidate import Candidate
from shapewright.estimation.fast.fitted_model import FittedModel
from shapewright.estimation.fast.target import Target
from shapewright.mesh import TriangleMesh
from shapewright.modeling import CompiledModel, Recorder, compile_model, group, when


def lever() -> CompiledModel:
    """An uneven L of two boxes without any symmetry: the lengths of a foot and a tower, of which one limits the other.

    The flag on the tower may be absent.
    """
    recorder = Recorder("lever", "lever", unit_m=0.01)
    recorder.parameter("foot", "Foot length", 0.5, 2.0, unit="mm", base_value=30.0)
    recorder.parameter("tower", "Tower height", 0.5, 2.0, unit="mm", base_value=16.0)
    recorder.parameter("width", "Foot width", 0.5, 2.0, unit="mm", base_value=12.0)
    recorder.limit("width", maximum=("foot", 0.5, 1.0))
    recorder.switch("flag", "Flag")
    foot = recorder.box(3.0, 1.2, 0.5, offset=(1.0, 0.2, 0.0))
    tower = recorder.box(0.7, 0.5, 1.6, offset=(0.0, 0.3, 0.4))
    flag = recorder.box(0.3, 0.9, 0.4, offset=(0.0, -0.4, 0.6))
    recorder.scale(group(foot.whole, frame="world"), 1.0, "u", size="foot")
    recorder.scale(group(foot.whole, frame="world"), 1.0, "v", size="width")
    recorder.scale(group(tower.whole, frame="world"), 1.0, "z", size="tower")
    recorder.part("flag", [flag], [when("flag", 1)])
    return compile_model(recorder.build())


def rigid() -> CompiledModel:
    """A model without parameters."""
    recorder = Recorder("rigid", "lever")
    recorder.box(3.0, 1.2, 0.5)
    recorder.box(0.7, 0.5, 1.6, offset=(0.6, 0.3, 0.4))
    return compile_model(recorder.build())


def signs() -> CompiledModel:
    """A model with options only: a post that bears one of three boards, and perhaps a foot."""
    recorder = Recorder("sign", "sign")
    recorder.choice("board", "Board", ("wide", "tall", "none"))
    recorder.switch("foot", "Foot")
    recorder.box(0.2, 0.3, 2.0)
    wide = recorder.box(0.1, 1.6, 0.5, offset=(0.1, 0.2, 1.4))
    tall = recorder.box(0.1, 0.6, 1.2, offset=(0.1, 0.2, 0.8))
    foot = recorder.box(1.0, 0.6, 0.1, offset=(0.2, 0.0, 0.0))
    recorder.part("wide", [wide], [when("board", 1)])
    recorder.part("tall", [tall], [when("board", 2)])
    recorder.part("foot", [foot], [when("foot", 1)])
    return compile_model(recorder.build())


def target_of(mesh: TriangleMesh, size: int = 128) -> Target:
    """Prepare a query that is used as it is, without being normalized."""
    return Target(mesh, ZBufferTarget(mesh.vertices, mesh.faces, size), np.random.default_rng(0))


def placed(model: CompiledModel, values, pose: Pose) -> TriangleMesh:
    """Return an instance at a pose."""
    return model.instance(np.asarray(values, dtype=np.float64)).transformed(pose.rotation, pose.translation, pose.scale)


def candidate_at(model: FittedModel, values, pose: Pose) -> Candidate:
    """Return a candidate of settled values at a pose."""
    settled = model.settle(np.asarray(values, dtype=np.float64))
    return Candidate(model, settled, pose.rotation, pose.translation, pose.scale)


def random_pose(seed: int, scale: float = 1.0, shift: float = 0.0) -> Pose:
    """Return a pose with a random rotation, and a shift in a random direction."""
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=3)
    return Pose(Rotation.random(random_state=rng).as_matrix(), shift * direction / np.linalg.norm(direction), scale)


def angle_deg(first, second) -> float:
    """Return the angle between two rotations."""
    return float(np.degrees(Rotation.from_matrix(first.T @ second).magnitude()))
