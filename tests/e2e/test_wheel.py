"""The wheel: whoever installs it has models, pictures of them, classifier and dashboard, without the repository."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from typing import Any

import pytest

PACKAGES = ("shapewright", "models_store", "service", "workers", "cli")
NOT_BUILT_FROM = shutil.ignore_patterns("__pycache__", "node_modules", "build", "*.egg-info", "weights")
SERVED = """
import asyncio, json, sys
from pathlib import Path
import httpx
import service
from models_store.library.shipped import list_shipped, thumbnail_png
from service.app import create_app
from service.settings import ServiceSettings

async def main():
    app = create_app(ServiceSettings(data_dir=Path("data"), log_level="error"))
    async with app.router.lifespan_context(app):
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
            return [(await client.get(path)).status_code for path in ("/", "/readyz", "/v1/models")]

print(json.dumps({
    "statuses": asyncio.run(main()),
    "from": service.__file__,
    "models": len(list_shipped()),
    "thumbnails": sum(thumbnail_png(name).startswith(b"\\x89PNG") for name in list_shipped()),
}))
"""


@pytest.fixture(scope="module")
def wheel(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built from a copy: building leaves files behind, and finds those that an earlier one left."""
    if not (repository / "service" / "dashboard" / "dist" / "index.html").is_file():
        pytest.skip("the dashboard is not built: bash scripts/setup run")
    source = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(repository / name, source)
    for name in PACKAGES:
        shutil.copytree(repository / name, source / name, ignore=NOT_BUILT_FROM)
    folder = tmp_path_factory.mktemp("wheel")
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
    subprocess.run(
        [*pip, "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, source],
        check=True,
    )
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def environment(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The programs of a fresh environment with the wheel, and with the packages that the tests run with but ours."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    programs = folder / "bin"
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", programs / "python")
    subprocess.run([*pip, "install", "--quiet", "--no-deps", "--no-index", wheel], check=True)
    (packages,) = folder.glob("lib/python*/site-packages")
    (packages / "locked.pth").write_text(sysconfig.get_path("purelib") + "\n")  # the .pth files there do not count
    return programs


def printed(command: list[str | Path], folder: Path) -> Any:
    """The JSON document that a command prints, run in this folder with nothing of ours in its environment."""
    ours = ("SHAPEWRIGHT_", "PYTHONPATH", "VIRTUAL_ENV")
    variables = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    done = subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_every_file_that_is_no_source_is_in_it(wheel: Path, repository: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        inside = set(archive.namelist())
    kinds = {".py", ".json", ".png", ".glsl", ".html", ".mako", ".ini", ".onnx", ".npz"}
    wanted = {
        file.relative_to(repository).as_posix()
        for name in PACKAGES
        for file in (repository / name).rglob("*")
        if file.suffix in kinds and not {"dashboard", "weights"} & set(file.parts)
    }
    dist = repository / "service" / "dashboard" / "dist"
    wanted |= {file.relative_to(repository).as_posix() for file in dist.rglob("*") if file.is_file()}
    assert wanted - inside == set()
    assert {"classifier.onnx", "classifier.exemplars.npz"} <= {Path(name).name for name in inside}


def test_it_classifies_without_the_repository(environment: Path, repository: Path, tmp_path: Path) -> None:
    goblet = repository / "examples" / "goblet.ply"
    document = printed([environment / "shapewright", "classify", goblet, "--json"], tmp_path)
    assert document["classifier"] == "ready"
    assert document["results"][0]["class_name"] == "glass_with_stem"


def test_it_serves_the_dashboard_without_the_repository(environment: Path, repository: Path, tmp_path: Path) -> None:
    told = printed([environment / "python", "-c", SERVED], tmp_path)
    assert told["statuses"] == [200, 200, 200]
    assert Path(told["from"]).is_relative_to(environment.parent)
    assert told["models"] == told["thumbnails"] > 60
