"""The demo as a newcomer types it, smaller."""

import json
import os
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from waiting import PATIENCE_S

from shapewright.mesh.file import load_mesh

FEW = ("--variations", "16", "--images", "4")


def _environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if not name.startswith("SHAPEWRIGHT_")}


def test_the_demo_once_on_its_sample(repository: Path, tmp_path: Path) -> None:
    coarse = tmp_path / "coarse.json"
    coarse.write_text('{"image_size": 64}')
    classes = ("--class", "glass_with_stem", "--class", "sword", "--class", "table")
    options = (*classes, *FEW, "--settings", coarse, "--output", tmp_path / "out")
    done = subprocess.run(
        [sys.executable, "-m", "cli", "demo", "--once", "--json", *options],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=_environment(),
    )
    log = tmp_path / "out" / "service.log"
    assert done.returncode == 0, done.stderr + (log.read_text()[-3000:] if log.exists() else "")
    report = json.loads(done.stdout)
    assert report["class_name"] == "glass_with_stem"
    assert report["answer"] in ("glass_with_stem", "unknown")
    assert 0 <= report["known"] <= 1
    assert report["model"].startswith("glass_with_stem")
    assert report["layer"] in (1, 2, 3)
    assert all(p["minimum"] <= p["value"] <= p["maximum"] for p in report["parameters"] if p["active"])
    assert report["distances"]["surface"] < 0.1
    assert report["verdict"]["residuals"]["followed_share"] > 0.8
    assert {"determined", "determined_up_to_scale"} & {p["status"] for p in report["parameters"]}
    with Image.open(report["picture_file"]) as picture:
        pixels = np.asarray(picture)
    assert pixels.shape[1] == 3 * pixels.shape[0]
    assert (pixels != pixels[0, 0]).any()
    fitted, query = load_mesh(report["mesh_file"]), load_mesh(repository / "examples" / "goblet.ply")
    assert np.abs(fitted.bounds - query.bounds).max() < 0.35 * np.ptp(query.bounds, axis=0).max()
    leftover = [path for path in tmp_path.iterdir() if path.name not in ("out", "coarse.json")]
    assert leftover == [], "the service's folder was temporary"


def test_it_keeps_serving_and_uses_a_kept_folder_again(tmp_path: Path) -> None:
    coarse = tmp_path / "coarse.json"
    coarse.write_text('{"image_size": 32}')
    classes = ("--class", "chair", "--class", "stool")  # a model each
    folders = ("--data-dir", tmp_path / "data", "--output", tmp_path / "out")
    arguments = [*classes, *FEW, *folders, "--settings", coarse]
    mesh = tmp_path / "stool.off"
    command = [sys.executable, "-m", "cli"]
    subprocess.run([*command, "instance", "stool", "-o", mesh], check=True, capture_output=True)
    subprocess.run([*command, "demo", mesh, "--once", *arguments], check=True, capture_output=True, env=_environment())

    process = subprocess.Popen(
        [*command, "demo", mesh, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env={**_environment(), "PYTHONUNBUFFERED": "1"}, start_new_session=True,
    )  # fmt: skip
    said = ""
    assert process.stdout is not None
    for line in process.stdout:
        said += line
        if "Ctrl-C ends" in line:
            break
    assert "used again" in said, said
    address = next(line.split()[-1] for line in said.splitlines() if line.startswith("Dashboard:"))
    with urllib.request.urlopen(address) as answer:
        assert b"<html" in answer.read().lower()
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(address)


def test_a_mesh_that_cannot_be_read_ends_it_with_a_reason(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cli", "demo", "missing.off", "--once", "--output", tmp_path / "out"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=_environment(),
    )
    assert done.returncode == 1
    assert "missing.off" in done.stderr
    assert done.stdout == "", "it is noticed before anything is started"


def test_a_class_that_does_not_ship_is_refused(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cli", "demo", "--once", "--class", "teapot"],
        capture_output=True, text=True, cwd=tmp_path, env=_environment(), check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "teapot" in done.stderr
    assert "glass_with_stem" in done.stderr
    assert list(tmp_path.iterdir()) == []
