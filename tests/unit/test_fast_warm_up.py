"""Warming up compiles every kernel of the fast estimator."""

from importlib import import_module
from inspect import getmembers

import pytest
from numba.core.dispatcher import Dispatcher

from shapewright.estimation.fast.warm_up import warm_up

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


@pytest.mark.parametrize("module", MODULES)
def test_every_kernel_is_compiled(module: str) -> None:
    kernels = getmembers(import_module(module), lambda member: isinstance(member, Dispatcher))
    public = [(name, kernel) for name, kernel in kernels if not name.startswith("_")]  # the others may be inlined
    assert public
    assert [name for name, kernel in public if not kernel.signatures] == []
