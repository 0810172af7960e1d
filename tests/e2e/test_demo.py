"""The demo as a newcomer types it."""

import json
import os
import shlex
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from waiting import PATIENCE_S

from models_store.library.shipped import list_classes
from shapewright.mesh.file import load_mesh

CLI = (sys.executable, "-m", "cli")


def _environment(**more: str) -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if not name.startswith("SHAPEWRIGHT_")} | more


def _run(*arguments: object, folder: Path, **more: str) -> "subprocess.CompletedProcess[str]":
    command = [*CLI, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=_environment(**more), check=False)


def _coarse(folder: Path) -> Path:
    settings = folder / "coarse.json"
    settings.write_text('{"image_size": 32}')
    return settings


def _get(url: str) -> Any:
    with urllib.request.urlopen(url) as answer:
        return json.load(answer)


def test_the_demo_once_on_its_sample(repository: Path, tmp_path: Path) -> None:
    done = _run("demo", "--once", "--json", "--output", tmp_path / "out", folder=tmp_path)
    log = tmp_path / "out" / "service.log"
    assert done.returncode == 0, done.stderr + (log.read_text()[-3000:] if log.exists() else "")
    report = json.loads(done.stdout)
    assert report["class_name"] == report["answer"] == "glass_with_stem"
    assert 0.5 < report["known"] <= 1
    assert report["model"].startswith("glass_with_stem")
    options = {p["name"]: p["option"] for p in report["parameters"] if p["active"]}
    assert options.get("bead") == "with" or options.get("beads") == "one", f"the goblet has one knop: {options}"
    assert report["layer"] == 3
    assert all(p["minimum"] <= p["value"] <= p["maximum"] for p in report["parameters"] if p["active"])
    assert report["distances"]["surface"] < 0.1
    assert report["verdict"]["residuals"]["followed_share"] > 0.8
    assert {"determined", "determined_up_to_scale"} & {p["status"] for p in report["parameters"]}
    learned = report["learning"]
    assert learned["before"]["answer"] != learned["class_name"], "the ready classifier has not learned it"
    assert learned["after"]["answer"] == learned["after"]["class_name"] == learned["class_name"] == "chair"
    assert learned["new_accuracy"] >= 0.7
    assert learned["known_accuracy"] >= learned["known_accuracy_before"] - 0.05
    parts_s = report["seconds"]
    parts = ("start", "classification", "estimation", "learning")
    assert 0 < sum(parts_s[part] for part in parts) < parts_s["total"]
    with Image.open(report["picture_file"]) as picture:
        pixels = np.asarray(picture)
    assert pixels.shape[1] == 3 * pixels.shape[0]
    assert (pixels != pixels[0, 0]).any()
    fitted, query = load_mesh(report["mesh_file"]), load_mesh(repository / "examples" / "goblet.ply")
    assert np.abs(fitted.bounds - query.bounds).max() < 0.35 * np.ptp(query.bounds, axis=0).max()
    leftover = [path for path in tmp_path.iterdir() if path.name != "out"]
    assert leftover == [], "the service's folder was temporary"


def test_it_keeps_serving_and_uses_a_kept_folder_again(tmp_path: Path) -> None:
    folders = ("--data-dir", tmp_path / "data", "--output", tmp_path / "out")
    arguments = ["demo", "table.off", *folders, "--settings", _coarse(tmp_path)]
    assert _run("instance", "table", "-o", "table.off", folder=tmp_path).returncode == 0
    once = _run(*arguments, "--once", folder=tmp_path)
    assert once.returncode == 0, once.stderr
    assert "it is a table" in once.stdout
    assert "Dashboard:" not in once.stdout, "nobody serves it any more"
    assert "add the class" not in once.stdout, "that is shown with the sample alone"
    assert once.stderr.count("\n") < 40

    process = subprocess.Popen(
        [*CLI, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=tmp_path,
        env=_environment(PYTHONUNBUFFERED="1"), start_new_session=True,
    )  # fmt: skip
    try:
        said = ""
        assert process.stdout is not None
        for line in process.stdout:
            said += line
            if "Ctrl-C ends" in line:
                break
        address = next(line.split()[-1] for line in said.splitlines() if line.startswith("Dashboard:"))
        url, page = address.split("/#/estimations/")
        estimation = _get(f"{url}/v1/estimations/{page}")
        assert estimation["result"]["model"]["name"] in list_classes()["table"], "the page shows what was found"
        assert [classifier["name"] for classifier in _get(f"{url}/v1/classifiers")["items"]] == ["ready"]
        assert len(_get(f"{url}/v1/classifications")["items"]) == 2, "the first one's, too"
        with urllib.request.urlopen(address) as answer:
            assert b"<html" in answer.read().lower()
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(address)


def test_a_point_cloud_is_classified_and_what_to_type_next_can_be_typed(tmp_path: Path) -> None:
    assert _run("instance", "sword", "-o", "sword.ply", folder=tmp_path).returncode == 0
    points = load_mesh(tmp_path / "sword.ply").to_trimesh().sample(3000, seed=0)
    np.savetxt(tmp_path / "a cloud.xyz", points)
    done = _run("demo", "a cloud.xyz", "--once", "--output", "out", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "3000 points" in done.stdout
    assert "it is a sword" in done.stdout
    assert "Rebuilding needs faces" in done.stdout
    _, _, following = done.stdout.partition("What to type next:\n")
    commands = [shlex.split(line) for line in following.splitlines()]
    assert [command[:2] for command in commands] == [["shapewright", "classify"], ["shapewright", "demo"]]
    typed = _run(*commands[0][1:], folder=tmp_path)
    assert typed.returncode == 0, typed.stderr
    assert "sword" in typed.stdout


def test_a_mesh_that_cannot_be_read_ends_it_with_a_reason(tmp_path: Path) -> None:
    done = _run("demo", "missing.off", "--once", "--output", "out", folder=tmp_path)
    assert done.returncode == 1
    assert "missing.off" in done.stderr
    assert done.stdout == "", "it is noticed before anything is started"
    (tmp_path / "nonsense.off").write_text("OFF\nnone\n")
    done = _run("demo", "nonsense.off", "--once", "--output", "out", folder=tmp_path)
    assert done.returncode == 1
    assert "the demo stopped" in done.stderr


def test_without_a_classifier_it_says_so(tmp_path: Path) -> None:
    nothing = {"SHAPEWRIGHT_ADD_SHIPPED_ON_START": "false"}
    done = _run("demo", "--once", "--output", "out", folder=tmp_path, **nothing)
    assert done.returncode == 1
    assert "classifier" in done.stderr
