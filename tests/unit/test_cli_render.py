"""`shapewright render` writes pictures on which something is to be seen."""

from pathlib import Path

import numpy as np
import pytest
from command_line import shapewright, write_lamp_model
from PIL import Image


@pytest.fixture
def lamp(tmp_path: Path) -> Path:
    return write_lamp_model(tmp_path)


@pytest.mark.parametrize("style", ["shaded", "edges"])
def test_a_model_and_its_mesh_give_the_same_picture(lamp: Path, tmp_path: Path, style: str) -> None:
    mesh, of_mesh, of_model = tmp_path / "lamp.ply", tmp_path / "mesh.png", tmp_path / "model.png"
    shapewright("instance", lamp, "-o", mesh)
    shapewright("render", mesh, "-o", of_mesh, "--size", 96, "--style", style)
    document = shapewright("render", lamp, "-o", of_model, "--size", 96, "--style", style, "--json").document
    assert document == {"file": str(of_model), "width": 96, "height": 96, "style": style}
    with Image.open(of_mesh) as first, Image.open(of_model) as second:
        pixels, others = np.asarray(first).astype(int), np.asarray(second).astype(int)
    assert pixels.shape == (96, 96, 3)
    background = (pixels == pixels[0, 0]).all(axis=2).mean()
    assert 0.2 < background < 0.97
    assert np.abs(pixels - others).mean() < 1.0


def test_turning_changes_the_picture(lamp: Path, tmp_path: Path) -> None:
    shapewright("render", lamp, "-o", tmp_path / "a.png", "--size", 64)
    shapewright("render", lamp, "-o", tmp_path / "b.png", "--size", 64, "--turn", 80, "--tilt", 60)
    assert (tmp_path / "a.png").read_bytes() != (tmp_path / "b.png").read_bytes()


def test_refusals(lamp: Path, tmp_path: Path) -> None:
    assert "written as .png" in shapewright("render", lamp, "-o", tmp_path / "a.jpg").refused()
    assert "missing.off" in shapewright("render", tmp_path / "missing.off", "-o", tmp_path / "a.png").refused()
    empty = tmp_path / "empty.off"
    empty.write_bytes(b"")
    assert "empty" in shapewright("render", empty, "-o", tmp_path / "a.png").refused()
    assert "finite" in shapewright("render", lamp, "-o", tmp_path / "a.png", "--turn", "nan").refused()
    refused = shapewright("render", empty, "-o", tmp_path / "a.png", "--set", "post_length=2").refused()
    assert "only a model has parameters" in refused
    assert not (tmp_path / "a.png").exists()


def test_a_contact_sheet_has_a_picture_of_everything(lamp: Path, tmp_path: Path) -> None:
    few, more = tmp_path / "few.png", tmp_path / "more.png"
    document = shapewright(
        "render", lamp, "-o", few, "--contact-sheet", "--size", 64, "--variations", 3, "--json"
    ).document
    shapewright("render", lamp, "-o", more, "--contact-sheet", "--size", 64, "--variations", 9)
    with Image.open(few) as sheet, Image.open(more) as longer:
        assert sheet.size == (document["width"], document["height"])
        assert sheet.width == longer.width == 8 * 70 + 6
        assert longer.height - sheet.height == 64 + 6 + 36
    assert "only a model" in shapewright("render", "mesh.off", "-o", tmp_path / "a.png", "--contact-sheet").refused()
