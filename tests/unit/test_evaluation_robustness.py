"""Figures of a classifier under corruptions: what they count, and that they depend on nothing but seeds and names."""

from collections.abc import Callable

import numpy as np
import pytest
from fake_classifier import CubeRefuser, MeshesOnly
from simple_shapes import box
from small_dataset import rod, slab, write_dataset

from shapewright.errors import Cancelled, EvaluationError
from shapewright.evaluation.conditions import Condition, conditions_of
from shapewright.evaluation.corruptions import CORRUPTIONS
from shapewright.evaluation.datasets import LabelledFile, read_dataset
from shapewright.evaluation.robustness import Robustness, SkippedRun, measure_robustness
from shapewright.evaluation.robustness_figures import ConditionFigures, RobustnessFigures, mean_share
from shapewright.evaluation.verdict import Verdict
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.modeling import compile_model
from shapewright.progress import CallbackProgress

SOME = conditions_of(["noise", "points"], middle_only=True)


@pytest.fixture(scope="module")
def items(tmp_path_factory: pytest.TempPathFactory) -> tuple[LabelledFile, ...]:
    """Three slabs, two rods, a cube that is neither, and two files that cannot be read."""
    folder = tmp_path_factory.mktemp("data")
    write_dataset(folder, [(compile_model(slab()), 3), (compile_model(rod()), 2)])
    return read_dataset(folder)


def verdict(label: str, answer: str, known: float | None = 0.9, by_pictures: str | None = None) -> Verdict:
    is_known = known is None or known >= 0.5
    return Verdict(label, answer, answer if by_pictures is None else by_pictures, 0.8, known, is_known)


def vertices(query: TriangleMesh | PointCloud) -> np.ndarray:
    return query.points if isinstance(query, PointCloud) else query.vertices


def test_conditions_are_all_strengths_or_the_middle_one() -> None:
    assert [one.strength for one in conditions_of(["noise"])] == [0.002, 0.005, 0.01]
    assert conditions_of(["voxels", "noise"], middle_only=True) == (
        Condition("voxels", 40.0),
        Condition("noise", 0.005),
    )
    assert len(conditions_of(CORRUPTIONS)) == 3 * len(CORRUPTIONS)
    for corruption in CORRUPTIONS.values():
        assert corruption.strengths[1] == corruption.default


@pytest.mark.parametrize("name", CORRUPTIONS)
def test_a_condition_does_the_same_to_a_file_every_time(name: str) -> None:
    condition = Condition(name, CORRUPTIONS[name].default)
    mesh = box((1.0, 0.6, 0.3))
    once, again = (vertices(condition.corrupted(mesh, seed=3, file="a/b.off")) for _ in range(2))
    assert np.array_equal(once, again)


def test_choices_differ_between_seeds_corruptions_strengths_and_files() -> None:
    noise = Condition("noise", 0.005)
    generators = [
        noise.generator(0, "a.off"),
        noise.generator(1, "a.off"),
        noise.generator(0, "b.off"),
        Condition("noise", 0.01).generator(0, "a.off"),
        Condition("holes", 0.005).generator(0, "a.off"),
    ]
    assert len({generator.random() for generator in generators}) == len(generators)


def test_figures_of_a_condition() -> None:
    figures = ConditionFigures.of(
        [
            verdict("rod", "rod", 0.9),
            verdict("rod", "rod", 0.2, by_pictures="slab"),  # right, though refused
            verdict("rod", "slab", 0.8, by_pictures="slab"),
            verdict("slab", "slab", 0.6),
            verdict("other", "slab", 0.7),
            verdict("other", "rod", 0.1),
        ],
        skipped=2,
    )
    assert (figures.n, figures.n_other, figures.skipped) == (4, 2, 2)
    assert figures.accuracy == 0.75
    assert figures.accuracy_pictures == 0.5
    assert figures.auroc_known == pytest.approx((2 + 1 + 2 + 1) / 8)
    assert figures.accepted_known == 0.75
    assert figures.refused_other == 0.5
    assert set(figures.to_dict()) >= {"accuracy", "auroc_known", "accepted_known", "refused_other", "n", "n_other"}


def test_figures_that_no_mesh_counts_for_are_missing() -> None:
    alone = ConditionFigures.of([verdict("rod", "rod")])
    assert (alone.accuracy, alone.accepted_known) == (1.0, 1.0)
    assert alone.auroc_known is None
    assert alone.refused_other is None
    others = ConditionFigures.of([verdict("other", "rod", 0.9)])
    assert (others.accuracy, others.accepted_known, others.refused_other) == (None, None, 0.0)
    without_known = ConditionFigures.of([verdict("rod", "rod", None), verdict("other", "rod", None)])
    assert without_known.accuracy == 1.0
    assert (without_known.auroc_known, without_known.accepted_known, without_known.refused_other) == (None, None, None)


def test_means_give_every_condition_the_same_weight() -> None:
    noise, strong, points = Condition("noise", 0.002), Condition("noise", 0.01), Condition("points", 1024.0)
    right, wrong = ConditionFigures.of([verdict("rod", "rod")] * 9), ConditionFigures.of([verdict("rod", "slab")])
    nothing = ConditionFigures.of([], skipped=10)
    figures = RobustnessFigures(right, {noise: right, strong: wrong, points: nothing})
    assert figures.mean["accuracy"] == 0.5
    assert figures.mean_error == 0.5
    document = figures.to_dict()
    assert document["mean_accuracy"] == 0.5
    assert document["clean"]["accuracy"] == 1.0
    assert {name: list(row) for name, row in document["per_corruption"].items()} == {
        "noise": ["0.002", "0.01"],
        "points": ["1024"],
    }
    assert document["per_corruption"]["points"]["1024"]["skipped"] == 10
    assert RobustnessFigures(right, {points: nothing}).mean_error is None
    assert mean_share([None, None]) is None


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_mesh_is_classified_clean_and_under_every_condition(items: tuple[LabelledFile, ...], jobs: int) -> None:
    measured = measure_robustness(items, CubeRefuser, SOME, jobs=jobs)
    assert measured.class_names == ("rod", "slab")
    assert [mesh.item for mesh in measured.meshes] == list(items[:6])
    assert all(tuple(mesh.corrupted) == SOME for mesh in measured.meshes)
    assert [(run.file, run.condition) for run in measured.skipped] == [("broken.off", None), ("missing.off", None)]
    assert measured.meshes[5].clean.is_other
    figures = RobustnessFigures.of(measured)
    for row in (figures.clean, *figures.corrupted.values()):
        assert (row.n, row.n_other) == (5, 1)
        assert row.auroc_known is not None
        assert row.refused_other == 1.0
    assert figures.clean.skipped == 2


def answers(measured: Robustness) -> dict[tuple[str, Condition | None], tuple[float, float | None]]:
    found = {}
    for mesh in measured.meshes:
        for condition, one in [(None, mesh.clean), *mesh.corrupted.items()]:
            found[mesh.item.file, condition] = (one.probability, one.known)
    return found


def test_an_answer_depends_on_no_other_mesh_no_order_and_no_jobs(items: tuple[LabelledFile, ...]) -> None:
    every = answers(measure_robustness(items[:6], CubeRefuser, conditions_of(["noise", "points"]), seed=4))
    backwards = answers(measure_robustness(items[4:1:-1], CubeRefuser, SOME[::-1], seed=4))
    assert backwards.items() <= every.items()
    beside = answers(measure_robustness(items[1:4], CubeRefuser, SOME, seed=4, jobs=2))
    assert beside.items() <= every.items()
    other_seed = answers(measure_robustness(items[2:5], CubeRefuser, SOME, seed=5))
    key = items[2].file, SOME[0]
    assert other_seed[key] != every[key]


def test_a_mesh_that_is_refused_is_skipped_under_that_condition_alone(items: tuple[LabelledFile, ...]) -> None:
    measured = measure_robustness(items[:2], MeshesOnly, SOME)
    noise, points = SOME
    assert measured.skipped == tuple(SkippedRun(item.file, points, "there are no faces") for item in items[:2])
    assert len(measured.verdicts(noise)) == 2
    assert measured.verdicts(points) == []
    figures = RobustnessFigures.of(measured)
    assert figures.corrupted[points].skipped == 2
    assert figures.corrupted[points].accuracy is None
    assert figures.mean["accuracy"] == figures.corrupted[noise].accuracy


def test_a_dataset_that_cannot_be_read_is_refused(items: tuple[LabelledFile, ...]) -> None:
    with pytest.raises(EvaluationError, match=r"no mesh could be classified \(broken.off"):
        measure_robustness(items[6:], CubeRefuser, SOME)


def cancel_after(count: int) -> Callable[[float, str], None]:
    reports: list[float] = []

    def report(fraction: float, message: str) -> None:
        reports.append(fraction)
        if len(reports) > count:
            raise Cancelled

    return report


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_progress_can_cancel(items: tuple[LabelledFile, ...], jobs: int) -> None:
    with pytest.raises(Cancelled):
        measure_robustness(items, CubeRefuser, SOME, jobs=jobs, progress=CallbackProgress(cancel_after(2)))
