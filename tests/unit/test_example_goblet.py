"""The sample mesh is what its script makes, and is as awkward as it is meant to be."""

import subprocess
import sys
from pathlib import Path

import numpy as np

from shapewright.mesh.file import load_mesh


def test_the_script_reproduces_the_committed_mesh(repository: Path, tmp_path: Path) -> None:
    made = tmp_path / "goblet.ply"
    subprocess.run([sys.executable, repository / "examples" / "make_goblet.py", made], check=True, capture_output=True)
    committed = repository / "examples" / "goblet.ply"
    assert committed.stat().st_size < 300_000
    ours, theirs = load_mesh(made), load_mesh(committed)
    np.testing.assert_array_equal(ours.faces, theirs.faces)
    # the last digit may differ where a processor rounds a sine differently
    np.testing.assert_allclose(ours.vertices, theirs.vertices, atol=0.0011)


def test_the_sample_has_holes_doubled_faces_and_an_odd_pose(repository: Path) -> None:
    mesh = load_mesh(repository / "examples" / "goblet.ply")
    text = (repository / "examples" / "goblet.ply").read_text()
    corners = [tuple(sorted(line.split()[1:])) for line in text.splitlines() if line.startswith("3 ")]
    assert not mesh.is_watertight
    assert len(set(corners)) < len(corners)
    extent = np.ptp(mesh.bounds, axis=0)
    assert extent.min() > 60.0, "no axis of the file runs along or across the goblet"
    assert np.linalg.norm(mesh.vertex_mean) > 100.0
