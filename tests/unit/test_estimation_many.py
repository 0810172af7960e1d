"""Many meshes in one process and in several: what is wrong with one of them is its row."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from small_dataset import rod, slab

from shapewright.distances.alignment import AlignmentSettings
from shapewright.errors import Cancelled
from shapewright.estimation import EstimationSettings
from shapewright.estimation.many import Work, estimate_files
from shapewright.modeling import compile_model
from shapewright.progress import CallbackProgress, Progress

COARSE = EstimationSettings(
    samples=20,
    surface_points=50,
    image_size=16,
    subdivision_steps=0,
    step_sizes=(0.5,),
    alignment=AlignmentSettings(0.1, 0.2, 0.1),
    estimator="reference",
)


@pytest.fixture
def files(tmp_path: Path) -> dict[str, Path]:
    found = {}
    for model in (rod(), slab()):
        found[model.name] = tmp_path / f"{model.name}.off"
        compile_model(model).instance(np.array([1.5])).save(found[model.name])
    found["broken"] = tmp_path / "broken.off"
    found["broken"].write_text("OFF\n3 1 0\n0 0 0\n")
    found["missing"] = tmp_path / "missing.off"
    return found


@dataclass(frozen=True)
class Dying:
    """Makes a progress that ends its process: each time, or only until a file says that one has died."""

    once: Path | None = None

    def __call__(self) -> Progress:
        if self.once is None or not self.once.exists():
            if self.once is not None:
                self.once.touch()
            os._exit(1)
        return CallbackProgress(lambda fraction, message: None)


def test_each_mesh_has_a_row_and_the_broken_ones_their_reason(files: dict[str, Path]) -> None:
    outcomes = {one.row.file: one for one in estimate_files(files, Work([rod(), slab()], COARSE), jobs=1)}
    assert list(outcomes) == list(files)
    for name in ("rod", "slab"):
        assert outcomes[name].row.answer["model"]["name"] == name
        assert outcomes[name].row.seconds > 0
    assert "truncated" in outcomes["broken"].row.error
    assert "No such file" in outcomes["missing"].row.error
    assert all(one.lasting for one in outcomes.values())


def test_a_time_limit_is_said_and_another_try_may_end_differently(files: dict[str, Path]) -> None:
    def at_once() -> Progress:
        def refuse(fraction: float, message: str) -> None:
            raise Cancelled

        return CallbackProgress(refuse)

    (outcome,) = estimate_files({"rod": files["rod"]}, Work([rod()], COARSE, progress=at_once), jobs=1)
    assert "the time was up" in outcome.row.error
    assert not outcome.lasting


def test_a_process_that_dies_costs_its_own_mesh_at_most(files: dict[str, Path], tmp_path: Path) -> None:
    once = Work([rod(), slab()], COARSE, progress=Dying(tmp_path / "died"))
    outcomes = {one.row.file: one for one in estimate_files(files, once, jobs=2)}
    assert set(outcomes) == set(files)
    assert outcomes["rod"].row.answer["model"]["name"] == "rod"
    assert outcomes["slab"].row.answer["model"]["name"] == "slab"

    always = Work([rod()], COARSE, progress=Dying())
    (outcome,) = estimate_files({"rod": files["rod"]}, always, jobs=2)
    assert outcome.row.error == "the process that estimated it died"
    assert not outcome.lasting
