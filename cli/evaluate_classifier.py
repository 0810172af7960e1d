"""`shapewright evaluate classification` and `evaluate retrieval`: a classifier on labelled meshes."""

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.console import AsJson, print_json, shown_progress, stdout
from cli.evaluation_options import (
    CacheFolder,
    Classes,
    ClassifierFile,
    DatasetFolder,
    Jobs,
    Limit,
    ReportFile,
    Seed,
    Threshold,
    chosen_meshes,
    threads,
)
from cli.learning import kept_classifier
from cli.sources import (
    by_digest,
    chosen_classifier,
    classifier_line,
    classifier_name,
    load_class,
    load_classes,
    load_negatives,
    read_object,
)
from models_store.library.shipped import list_classes, list_further_classes
from shapewright.errors import EvaluationError
from shapewright.progress import PartialProgress, Progress
from shapewright.whole_file import write_whole

if TYPE_CHECKING:
    from shapewright.classification import Classifier
    from shapewright.evaluation.classification_figures import ClassificationFigures
    from shapewright.evaluation.classified import JudgedDataset
    from shapewright.evaluation.retrieval_metrics import RetrievalFigures
    from shapewright.modeling import CompiledModel
    from shapewright.training import TrainingSettings

Train = Annotated[
    bool,
    typer.Option(
        "--train",
        help="Train a classifier on the shipped classes of the dataset, and keep it in the cache, instead of taking "
        "the one that ships; --settings does so, too.",
    ),
]
SettingsFile = Annotated[
    Path | None, typer.Option("--settings", help="JSON file with settings of the trainings.", show_default=False)
]
Views = Annotated[int, typer.Option(min=1, max=1000, help="Pictures taken of each mesh.")]
Baselines = Annotated[
    bool,
    typer.Option(
        help="Train the baselines, too: without variations (the paper's), and on random weights of the network."
    ),
]

NO_VARIATION, RANDOM_WEIGHTS = "no_variation", "random_weights"
_TRAINING_SHARE = 0.6
_BASELINE_SHARE = 10
"""Baselines learn from a tenth of the pictures, for ten times as many epochs, so for as many steps."""


@dataclass(frozen=True)
class Evaluated:
    """A dataset that was judged, and what it took."""

    dataset: "JudgedDataset"
    classifier: "Classifier"
    training_s: float
    started_s: float

    @cached_property
    def classified(self) -> "dict[str, ClassificationFigures]":
        """Figures of classification by every kind of evidence."""
        from shapewright.evaluation.classification_figures import evidence_of, figures_by

        return {name: figures_by(self.dataset, evidence) for name, evidence in evidence_of(self.dataset).items()}

    @cached_property
    def ranked(self) -> "dict[str, tuple[RetrievalFigures, Mapping[str, RetrievalFigures]]]":
        """Figures of every ranking; none if there is nothing of the classes to be found."""
        from shapewright.classification.evidence import OTHER
        from shapewright.evaluation.classification_figures import rankings_of, retrieval_figures

        if all(one.label == OTHER for one in self.dataset.judged):
            return {}
        return {name: retrieval_figures(self.dataset, scores) for name, scores in rankings_of(self.dataset).items()}


def classification(
    dataset: DatasetFolder,
    classifier: ClassifierFile = None,
    report: ReportFile = None,
    limit: Limit = None,
    classes: Classes = None,
    views: Views = 10,
    baselines: Baselines = True,
    fit: Annotated[
        bool, typer.Option("--fit", help="Classify with a short fit of the likeliest classes, too.")
    ] = False,
    threshold: Threshold = 0.5,
    train: Train = False,
    settings_file: SettingsFile = None,
    seed: Seed = 0,
    jobs: Jobs = None,
    cache: CacheFolder = None,
    as_json: AsJson = False,
) -> None:
    """Tell how many meshes of a dataset get their class, and how well others are told from them.

    Meshes of classes that the classifier does not know count as `other`. The figures are given for all evidence and
    for the pictures alone. With --train a classifier is trained, with --seed, on the shipped models of the dataset's
    classes.

    Examples:

      [bold]shapewright evaluate classification --dataset DIR --report classified.html[/]
      [bold]shapewright evaluate classification --dataset DIR -c classifier.onnx --json[/]
      [bold]shapewright evaluate classification --dataset DIR --train --no-baselines --seed 1[/]
    """
    from shapewright.evaluation.classification_figures import unknown_figures

    options = Options(
        dataset,
        classifier,
        limit,
        classes,
        views,
        settings_file,
        seed,
        jobs,
        cache,
        baselines,
        train=train,
        fit=fit,
        threshold=threshold,
    )
    with _evaluated(options, report) as (done, progress):
        figures = done.classified
        unknown = unknown_figures(done.dataset)
        _write_report(report, done, progress)
    judged = done.dataset.judged
    document = {
        **_common(options, done, report),
        **figures["all"].to_dict(),
        "n_other": sum(one.label == "other" for one in judged),
        "threshold": threshold,
        "unknown": unknown,
        "evidence": {name: one.to_dict() for name, one in figures.items() if name != "all"},
        "meshes": [
            {
                "file": one.item.file,
                "class": one.item.class_name,
                "class_name": one.found.class_name,
                "answer": one.found.answer,
                "known": one.found.known,
                "probability": one.found.probability,
                "seconds": round(one.seconds, 4),
            }
            for one in judged
        ],
    }
    if as_json:
        print_json(document)
        return
    from rich.table import Table

    table = Table("class", "n", "right", "by pictures", box=None, pad_edge=False)
    for name, row in figures["all"].per_class.items():
        by_pictures = figures["pictures"].per_class[name]["accuracy"]
        table.add_row(name, f"{row['n']:.0f}", f"{row['accuracy']:.1%}", f"{by_pictures:.1%}")
    stdout().print(table)
    for name, one in figures.items():
        known = "" if one.auroc_known is None else f", known against other {one.auroc_known:.3f} (AUROC)"
        typer.echo(f"{_TITLES[name]}: {one.accuracy:.1%} of {one.n} right{known}")
    typer.echo(f"a mesh takes {document['seconds_per_mesh_median'] * 1e3:.0f} ms (median)")
    _say_rest(options, done, report)


def retrieval(
    dataset: DatasetFolder,
    classifier: ClassifierFile = None,
    report: ReportFile = None,
    limit: Limit = None,
    classes: Classes = None,
    views: Views = 10,
    baselines: Baselines = True,
    train: Train = False,
    settings_file: SettingsFile = None,
    seed: Seed = 0,
    jobs: Jobs = None,
    cache: CacheFolder = None,
    as_json: AsJson = False,
) -> None:
    """Tell how high the meshes of each class stand when all meshes of a dataset are ranked for it (paper section 4.2).

    They are ranked as `shapewright retrieve --class` ranks them. Average precision is compared with the paper's two
    baselines, the panorama distance to the default instance and a classifier that learned without variations, and with
    one on random weights of the network.

    Examples:

      [bold]shapewright evaluate retrieval --dataset DIR --report retrieved.html[/]
      [bold]shapewright evaluate retrieval --dataset DIR -c classifier.onnx --json[/]
    """
    options = Options(
        dataset, classifier, limit, classes, views, settings_file, seed, jobs, cache, baselines, train=train
    )
    with _evaluated(options, report) as (done, progress):
        measured = done.ranked
        if not measured:
            raise EvaluationError("the dataset has no mesh of a class that the classifier knows", where="--dataset")
        _write_report(report, done, progress)
    precision = {name: mean.average_precision for name, (mean, _) in measured.items()}
    per_class = measured["all"][1]
    document = {
        **_common(options, done, report),
        "n": len(done.dataset.judged),
        "mean_average_precision": precision["all"],
        "mean_average_precision_combined": precision.get("combined"),
        "mean_average_precision_pictures": precision["pictures"],
        "mean_average_precision_panorama": precision.get("panorama_to_default"),
        "mean_average_precision_no_variation": precision.get(NO_VARIATION),
        "mean_average_precision_random_weights": precision.get(RANDOM_WEIGHTS),
        "per_class": {name: one.to_dict() for name, one in per_class.items()},
        "evidence": {name: mean.to_dict() for name, (mean, _) in measured.items()},
    }
    if as_json:
        print_json(document)
        return
    from rich.table import Table

    table = Table("class", "n", "average precision", "first tier", box=None, pad_edge=False)
    for name, one in per_class.items():
        table.add_row(name, str(one.n), f"{one.average_precision:.3f}", f"{one.first_tier:.3f}")
    stdout().print(table)
    for name, (found, _) in measured.items():
        typer.echo(f"{_TITLES[name]}: mean average precision {found.average_precision:.3f}")
    _say_rest(options, done, report)


_TITLES = {
    "all": "all evidence",
    "combined": "pictures, and distances in units of their spread",
    "pictures": "pictures alone",
    "fitted": "all evidence, the likeliest classes fitted",
    "panorama_to_default": "panorama distance to the default instance",
    NO_VARIATION: "learned without variations",
    RANDOM_WEIGHTS: "learned on random weights of the network",
}


@dataclass(frozen=True)
class Options:
    """What both verbs are told."""

    dataset: Path
    classifier: Path | None
    limit: int | None
    classes: str | None
    views: int
    settings_file: Path | None
    seed: int
    jobs: int | None
    cache: Path | None
    baselines: bool
    train: bool = False
    fit: bool = False
    threshold: float = 0.5

    @property
    def trains(self) -> bool:
        """Whether the classifier is trained, instead of loaded."""
        return self.classifier is None and (self.train or self.settings_file is not None)


@contextmanager
def _evaluated(options: Options, report: Path | None) -> Iterator[tuple[Evaluated, Progress]]:
    """Judge the dataset with the classifier and the baselines; the progress is what is left for a report."""
    from shapewright.classification import load_classifier
    from shapewright.evaluation.classified import judge_dataset
    from shapewright.evaluation.datasets import read_dataset
    from shapewright.training import TrainingSettings

    started_s = time.monotonic()
    if report is not None and report.is_dir():
        raise EvaluationError("a file is needed, this is a folder", where=f"--report {report}")
    items = read_dataset(options.dataset)
    chosen = chosen_meshes(items, options.classes, options.limit)
    settings = _settings(options)
    with threads(options.jobs) as used, shown_progress("evaluating") as progress:
        training = PartialProgress(progress, 0.0, _TRAINING_SHARE)
        learned: Mapping[str, Sequence[CompiledModel]] | None
        if not options.trains:
            network = load_classifier(chosen_classifier(options.classifier))
            learned = _shipped(network.class_names)
            settings = settings or TrainingSettings.from_dict(network.metadata["settings"])
        else:
            learned = shipped_classes_of({item.class_name for item in items})
            settings = settings or TrainingSettings(seed=options.seed)
            network = kept_classifier(learned, load_negatives(learned), settings, training, options.cache)
        others = {}
        if options.baselines and learned is not None:
            others = {
                name: kept_classifier(learned, [], _baseline(name, settings), training, options.cache)
                for name in (NO_VARIATION, RANDOM_WEIGHTS)
            }
        training_s = time.monotonic() - started_s
        dataset = judge_dataset(
            chosen,
            network,
            None if learned is None else {name: models[:1] for name, models in learned.items()},
            baselines=others,
            fitted=by_digest((learned or {}).values()) if options.fit else None,
            views=options.views,
            seed=options.seed,
            threshold=options.threshold,
            jobs=used,
            progress=PartialProgress(progress, _TRAINING_SHARE, 0.95),
        )
        yield Evaluated(dataset, network, training_s, started_s), PartialProgress(progress, 0.95, 1.0)


def _shipped(class_names: Sequence[str]) -> "Mapping[str, Sequence[CompiledModel]] | None":
    """The shipped models of these classes; ``None``, which leaves the baselines out, if one does not ship."""
    missing = [name for name in class_names if name not in list_classes()]
    if missing:
        typer.echo(f"no models of the class {missing[0]!r} ship: there are no baselines to compare with", err=True)
        return None
    return {name: load_class(name) for name in class_names}


def _settings(options: Options) -> "TrainingSettings | None":
    """What the settings file says, with the seed that was asked for."""
    from shapewright.training import TrainingSettings

    if options.settings_file is None:
        return None
    return TrainingSettings.from_dict(read_object(options.settings_file) | {"seed": options.seed})


def _baseline(name: str, settings: "TrainingSettings") -> "TrainingSettings":
    fewer = max(settings.variations // _BASELINE_SHARE, 20)
    epochs = round(settings.epochs * max(settings.variations / fewer, 1.0))
    plain = replace(settings, variations=fewer, epochs=epochs, negatives=0, exemplars=False)
    if name == NO_VARIATION:
        return replace(plain, vary=False)
    return replace(plain, backbone="efficientnet_lite0_random")


def shipped_classes_of(labels: set[str]) -> "Mapping[str, Sequence[CompiledModel]]":
    """Load the shipped classes that the dataset has."""
    further = list_further_classes()
    names = [name for name in list_classes() if name in labels and name not in further]
    if len(names) < 2:
        raise EvaluationError("fewer than two classes of the dataset ship; name a classifier", where="--dataset")
    return load_classes(names)


def _common(options: Options, done: Evaluated, report: Path | None) -> dict[str, Any]:
    import statistics

    fitted = [one.fitted_seconds for one in done.dataset.judged if one.fitted_seconds is not None]
    return {
        "dataset": str(options.dataset),
        "classifier": "trained" if options.trains else classifier_name(options.classifier),
        "class_names": list(done.dataset.class_names),
        "views": options.views,
        "seed": options.seed,
        "seconds_per_mesh_median": statistics.median(one.seconds for one in done.dataset.judged),
        "seconds_per_mesh_fitted_median": statistics.median(fitted) if fitted else None,
        "seconds_training": round(done.training_s, 3),
        "seconds": round(time.monotonic() - done.started_s, 3),
        "skipped_count": len(done.dataset.skipped),
        "skipped": [asdict(skipped) for skipped in done.dataset.skipped],
        "report": None if report is None else str(report),
    }


def _write_report(report: Path | None, done: Evaluated, progress: Progress) -> None:
    if report is None:
        return
    from shapewright.evaluation.classifier_report import classifier_report

    page = classifier_report(
        done.dataset,
        _TITLES,
        figures={name: one.to_dict() for name, one in done.classified.items()},
        curves={name: mean.to_dict() for name, (mean, _) in done.ranked.items()},
        progress=progress,
    )
    report.parent.mkdir(parents=True, exist_ok=True)
    write_whole(report, page.encode())


def _say_rest(options: Options, done: Evaluated, report: Path | None) -> None:
    if not options.trains:
        typer.echo(classifier_line(options.classifier))
    for skipped in done.dataset.skipped:
        typer.echo(f"skipped {skipped.file}: {skipped.reason}", err=True)
    if report is not None:
        typer.echo(str(report))
