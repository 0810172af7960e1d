"""The README's Python runs as it stands, with less work to do."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

LESS = {
    "variations=100, images_per_variation=5, negatives=50": "variations=16, images_per_variation=3, negatives=8",
    "known=known,": "known=known, settings=shapewright.ExtensionSettings(variations=8, rehearsed=4, negatives=8),",
    "default_rng(0), 1000)": "default_rng(0), 10)",
}


def blocks(repository: Path) -> list[str]:
    text = (repository / "README.md").read_text(encoding="utf-8")
    found = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    for block, wanted in zip(
        found, ("shapewright.estimate(query", "default_rng(0), 1000)", "InferenceSession"), strict=True
    ):
        assert wanted in block, "the replacements below no longer fit the README"
    return found


def run(code: str, names: dict[str, Any]) -> dict[str, Any]:
    for plain, smaller in LESS.items():
        code = code.replace(plain, smaller)
    exec(compile(code, "README.md", "exec"), names)
    return names


def test_classify_and_rebuild(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    code = blocks(repository)[0].replace("examples/goblet.ply", str(repository / "examples" / "goblet.ply"))
    names = run(code, {})
    assert names["answer"].class_name == "glass_with_stem"
    Path("classifier.onnx").write_bytes(names["trained"].onnx)
    elsewhere = blocks(repository)[2].replace("examples/goblet.ply", str(repository / "examples" / "goblet.ply"))
    names |= run(elsewhere, {})
    assert names["probabilities"].shape == names["with_none"].shape == (10, 3)
    assert names["with_chair"].class_names == (*names["models"], "chair")
    assert names["about"]["class_names"] == list(names["models"])
    assert (tmp_path / "fitted.glb").read_bytes()[:4] == b"glTF"
    assert names["volume"] > 0
    printed = capsys.readouterr().out
    assert "layer" in printed
    assert all(parameter.label in printed for parameter in names["estimation"].parameters)


def test_model_a_stool(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run(blocks(repository)[1], {})
    from shapewright import ProceduralModel

    assert ProceduralModel.load("stool.json") == names["stool"]
    assert len(names["stools"]) == 10
    assert np.ptp(names["stools"][:, :, 2].min(axis=1)) > 0.1  # legs of different lengths
