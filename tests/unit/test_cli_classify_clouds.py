"""`shapewright classify` on point clouds, with a classifier that needs no training."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import shapewright
from fake_classifier import ExtentClassifier

from shapewright.classification import Classification
from shapewright.mesh import PointCloud, TriangleMesh


class Asked(ExtentClassifier):
    """What is asked is kept."""

    exemplars = None

    def __init__(self) -> None:
        super().__init__()
        self.queries: list[TriangleMesh | PointCloud] = []

    def classify(self, query: TriangleMesh | PointCloud, /, *, models: Any = None, **options: Any) -> Classification:
        self.queries.append(query)
        return super().classify(query, **options)


def test_scans_are_classified_beside_meshes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked()
    monkeypatch.setattr("shapewright.classification.load_classifier", lambda path: asked)
    monkeypatch.chdir(tmp_path)
    points = np.random.default_rng(0).uniform(-1, 1, (50, 3))
    Path("scans").mkdir()
    np.savetxt("scans/rod.xyz", points * [1, 1, 9])
    np.savetxt("scans/list.txt", points)  # below a folder, only endings that say what they are
    np.savetxt("slab.txt", points * [9, 9, 1], header="x y z", comments="")
    Path("bad.pcd").write_text("VERSION .7\n")
    Path("rod.off").write_text("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
    outcome = shapewright("classify", "scans", "slab.txt", "rod.off", "bad.pcd", "-c", "any.onnx", "--json")
    assert outcome.status == 0, outcome.stderr
    answers = [(Path(one["file"]).name, one["answer"]) for one in outcome.document["results"]]
    assert answers == [("rod.xyz", "rod"), ("slab.txt", "slab"), ("rod.off", "rod")]
    assert [type(query) for query in asked.queries] == [PointCloud, PointCloud, TriangleMesh]
    assert [Path(one["file"]).name for one in outcome.document["skipped"]] == ["bad.pcd"]
