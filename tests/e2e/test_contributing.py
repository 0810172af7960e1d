"""The step-by-step model of CONTRIBUTING works as it stands: its script, its commands, its mending, its change."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from shapewright.modeling import ProceduralModel, compile_model


@pytest.fixture
def script(repository: Path, tmp_path: Path) -> Path:
    text = (repository / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = text[text.index("## Modelling a class, step by step") : text.index("## Packages and locks")]
    blocks = re.findall(r"```python\n(.*?)```", section, flags=re.DOTALL)
    assert len(blocks) == 3
    folder = tmp_path / "mug"
    folder.mkdir()
    (folder / "build.py").write_text("\n\n".join(blocks), encoding="utf-8")
    return folder / "build.py"


def run(repository: Path, *arguments: str | Path) -> str:
    done = subprocess.run(
        [sys.executable, *map(str, arguments)], cwd=repository, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(repository: Path, script: Path) -> ProceduralModel:
    run(repository, script)
    return ProceduralModel.load(script.parent / "model.json")


def replace(script: Path, old: str, new: str) -> None:
    text = script.read_text(encoding="utf-8")
    assert text.count(old) == 1
    script.write_text(text.replace(old, new), encoding="utf-8")


def test_the_mug_is_modelled_looked_at_validated_and_changed(repository: Path, script: Path, tmp_path: Path) -> None:
    first = build(repository, script)
    assert (script.parent / "thumbnail.png").is_file()
    document = str(script.parent / "model.json")
    run(repository, "-m", "cli", "render", document, "--contact-sheet", "-o", str(tmp_path / "mug.png"))
    assert (tmp_path / "mug.png").stat().st_size > 10_000
    run(repository, "-m", "cli", "models", "validate", document)

    compiled = compile_model(first)
    bare = compiled.instance(compiled.values_from_mapping({"handle": 0}))
    assert bare.vertices[:, 0].max() < compiled.instance(compiled.base_values()).vertices[:, 0].max() - 0.01
    low = compiled.values_from_mapping({"height": 0.6})
    assert low[4] == pytest.approx(0.3), "the handle follows the height"

    replace(script, '"Foot width (relative to the rim)", 0.6, 1.1', '"Foot width (relative to the rim)", 0.85, 1.1')
    replace(script, "column.rise(-0.5 * HEIGHT)", "column.rise(-0.45 * HEIGHT)")
    changed = build(repository, script)
    assert changed.digest != first.digest
    run(repository, "-m", "cli", "models", "validate", document)
    meshes = [compile_model(model).instance(np.ones(5)) for model in (first, changed)]
    volumes = [
        float(np.einsum("ij,ij->i", t[:, 0], np.cross(t[:, 1], t[:, 2])).sum() / 6)
        for m in meshes
        for t in [m.triangles]
    ]
    assert volumes[1] > volumes[0], "a thicker base is more clay"
