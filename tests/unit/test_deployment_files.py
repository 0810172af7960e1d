"""Dockerfile and docker-compose.yml speak of commands, settings and files that exist."""

import importlib
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from cli.worker_process import worker_command


@pytest.fixture(scope="module")
def compose(repository: Path) -> dict[str, Any]:
    loaded = yaml.safe_load((repository / "docker-compose.yml").read_text())
    assert isinstance(loaded, dict)
    return loaded


@pytest.fixture(scope="module")
def known_settings() -> set[str]:
    from models_store.settings import StoreSettings
    from service.settings import ServiceSettings
    from workers.settings import WorkerSettings

    return {
        f"SHAPEWRIGHT_{name}".upper()
        for settings in (StoreSettings, ServiceSettings, WorkerSettings)
        for name in settings.model_fields
    }


def test_every_variable_of_compose_is_a_setting(compose: dict[str, Any], known_settings: set[str]) -> None:
    for name in ("api", "worker"):
        for variable in compose["services"][name]["environment"]:
            assert variable in known_settings


def test_every_variable_of_the_image_is_a_setting(repository: Path, known_settings: set[str]) -> None:
    variables = set(re.findall(r"\b(SHAPEWRIGHT_[A-Z_]+)", (repository / "Dockerfile").read_text()))
    assert variables
    assert variables <= known_settings


def test_the_settings_of_compose_are_understood(compose: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    from models_store.settings import StoreSettings

    for variable, value in compose["services"]["api"]["environment"].items():
        monkeypatch.setenv(variable, re.sub(r"\$\{\w+:-(.*?)\}", r"\1", value))
    settings = StoreSettings()
    assert settings.database_url == "postgresql+psycopg://shapewright:shapewright@postgres:5432/shapewright"
    assert settings.artifacts_url == "file:///data/artifacts"
    assert settings.embedded_broker_folder is None


def test_the_api_command_names_a_factory(compose: dict[str, Any]) -> None:
    command = compose["services"]["api"]["command"]
    assert command[:2] == ["uvicorn", "--factory"]
    module, _, factory = command[2].partition(":")
    assert callable(getattr(importlib.import_module(module), factory))


def test_the_worker_command_names_an_application(compose: dict[str, Any]) -> None:
    program, option, application, verb = compose["services"]["worker"]["command"]
    assert (program, option, verb) == ("celery", "-A", "worker")
    assert application in worker_command(), "`shapewright serve` starts the same one"
    assert hasattr(importlib.import_module(application), "app")


def test_services_wait_for_healthy_ones_only(compose: dict[str, Any]) -> None:
    for service in compose["services"].values():
        for name in service.get("depends_on", {}):
            other = compose["services"][name]
            assert "healthcheck" in other or "build" in other, "the image of our own has a check in the Dockerfile"
    for name in [mount.split(":")[0] for service in compose["services"].values() for mount in service["volumes"]]:
        assert name in compose["volumes"]


def test_the_image_copies_what_is_there(repository: Path) -> None:
    for line in (repository / "Dockerfile").read_text().splitlines():
        if line.startswith("COPY") and "--from" not in line:
            for source in line.split()[1:-1]:
                assert (repository / source).exists(), source
