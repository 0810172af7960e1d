"""Warming up compiles every kernel of the fast estimator and of classification, and other processes load them."""

import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from inspect import getmembers
from pathlib import Path
from typing import TypeVar

import pytest
from numba.core.dispatcher import Dispatcher

from shapewright.classification.warm_up import warm_up as warm_up_classification
from shapewright.estimation.fast.warm_up import load_kernels, warm_up

Result = TypeVar("Result")

MODULES = (
    "shapewright.distances.elimination_kernel",
    "shapewright.estimation.sampling_kernels",
    "shapewright.estimation.fast.matching_kernels",
    "shapewright.estimation.fast.outline_kernels",
    "shapewright.estimation.fast.pose_kernels",
    "shapewright.estimation.fast.system_kernels",
)


@pytest.fixture(scope="module", autouse=True)
def warm() -> None:
    warm_up()


def idle_kernels(module: str) -> list[str]:
    """Return the names of the kernels of a module that this process has not loaded."""
    kernels = getmembers(import_module(module), lambda member: isinstance(member, Dispatcher))
    public = [(name, kernel) for name, kernel in kernels if not name.startswith("_")]  # the others may be inlined
    assert public
    return [name for name, kernel in public if not kernel.signatures]


def loaded() -> tuple[bool, list[str]]:
    """Load the kernels; return whether that was possible, and which ones are not loaded."""
    return load_kernels(), [name for module in MODULES for name in idle_kernels(module)]


def in_a_fresh_process(work: Callable[[], Result]) -> Result:
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(work).result()


@pytest.mark.parametrize("module", MODULES)
def test_every_kernel_is_compiled(module: str) -> None:
    assert idle_kernels(module) == []


def test_a_fresh_process_loads_every_kernel() -> None:
    assert in_a_fresh_process(loaded) == (True, [])


def test_kernels_that_were_never_compiled_stay_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    possible, idle = in_a_fresh_process(loaded)
    assert not possible
    assert "sample_surface" not in idle
    assert "score_rotations" in idle


def test_every_kernel_that_a_classification_calls_is_compiled() -> None:
    warm_up_classification()
    assert idle_kernels("shapewright.rendering.splat_kernels") == []
    assert not {"describe", "distances"} & set(idle_kernels("shapewright.distances.panorama_kernel"))
