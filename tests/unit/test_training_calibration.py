"""How sure a classifier may be: measured on models that it has not learned from."""

import numpy as np
import pytest
from simple_shapes import BoxModel, toy_classes

from shapewright.classification.evidence import KNOWN_THRESHOLD, REFUSED
from shapewright.classification.trade_off import trade_off_of
from shapewright.network import load_backbone
from shapewright.training import MemoryStore, TrainingSettings, train_classifier
from shapewright.training.calibration import MAX_TEMPERATURE, Calibration, calibrate, fit_temperature
from shapewright.training.chunks import features_key
from shapewright.training.dataset import load_features, plan_learning


def test_temperature_softens_and_never_sharpens() -> None:
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 3, 4000)
    honest = np.eye(3)[labels] * 1.5 + rng.gumbel(size=(4000, 3))
    fitted = fit_temperature(10 * honest, labels)
    assert fitted > 3
    assert fit_temperature(honest * 0.01, labels) == 1.0
    assert fit_temperature(np.eye(3)[labels] * 5, labels) == 1.0, "all right: no reason to be surer still"
    assert fit_temperature(np.eye(3)[(labels + 1) % 3] * 500, labels) <= MAX_TEMPERATURE + 1e-9


SETTINGS = TrainingSettings(
    variations=40, images_per_variation=2, negatives=20, exemplars=False, batch_size=16, learning_rate=0.02
)


def calibrated(centre_of, settings: TrainingSettings = SETTINGS, *, weakened: float = 1.0) -> Calibration:
    """Calibrate two classes of two models each, whose features lie about a centre for each source.

    Those of broken variations are multiplied by a number.
    """
    names = ("a1", "a2", "b1", "b2")
    one, two, three, four = (BoxModel(name, [((0, 0, 0), (1, 1, 1))]) for name in names)
    plan = plan_learning({"a": [one, two], "b": [three, four]}, (), settings)
    rng, store, backbone = np.random.default_rng(0), MemoryStore(), load_backbone()
    for chunk, _ in plan.chunks:
        noise = 0.3 * rng.normal(size=(chunk.count, settings.images_per_variation, 8))
        strength = np.where(chunk.broken(settings), weakened, 1.0)[:, None, None]
        features = noise + strength * centre_of(chunk.source.name)
        store.put(features_key(chunk, settings, backbone), features.astype(np.float16))
    return calibrate(plan, load_features(plan, settings, backbone, store), settings)


def direction(number: int) -> np.ndarray:
    return 3.0 * np.eye(8)[number]


def test_models_that_are_like_their_class_are_told_without_having_been_learned() -> None:
    places = {"a1": 0, "a2": 0, "b1": 1, "b2": 1}
    found = calibrated(lambda name: direction(places.get(name, 2)))
    assert found.metrics["left_out_accuracy_pictures"] == 1.0
    assert found.metrics["left_out_auroc_pictures"] > 0.99
    assert 40 <= found.metrics["left_out_meshes"] <= 80, "some of each model"
    assert found.pictures is not None
    assert found.pictures.whole.probability(0.0) > 0.5
    assert found.geometry is None


def test_a_left_out_model_has_really_not_been_learned() -> None:
    # Each model looks like one of the other class: where all are learned all are told apart, but not so left out.
    looks = {
        "a1": direction(0),
        "b1": direction(0) + direction(3),
        "a2": direction(4),
        "b2": direction(4) + direction(5),
    }
    found = calibrated(lambda name: looks.get(name, direction(6)))
    assert found.metrics["left_out_accuracy_pictures"] < 0.8
    assert found.temperature > 1.5, "it has learned to be less sure"


def test_variations_of_models_that_were_learned_take_part_in_the_curve() -> None:
    """Half of them are: where all that is left out looks like an object of no class, these are accepted still."""
    looks = {name: direction(number) + direction(6) for number, name in enumerate(("a1", "b1", "a2", "b2"))}
    found = calibrated(lambda name: looks.get(name, direction(6)))
    points = found.metrics["trade_off_pictures"]
    assert max(point["accepted_known"] for point in points if point["refused_other"] == 1.0) > 0.25
    assert found.metrics["left_out_auroc_pictures"] < 0.5, "the forecast is of left-out models alone"


def test_broken_objects_that_look_less_like_their_class_get_a_curve_that_asks_for_less() -> None:
    places = {"a1": 0, "a2": 0, "b1": 1, "b2": 1}
    found = calibrated(lambda name: direction(places.get(name, 2)), weakened=0.1)
    curves = found.pictures
    assert curves is not None
    threshold = -curves.whole.intercept / curves.whole.slope
    assert curves.rough.probability(threshold) > 0.6
    alike = calibrated(lambda name: direction(places.get(name, 2))).pictures
    assert alike is not None
    assert alike.rough.probability(-alike.whole.intercept / alike.whole.slope) == pytest.approx(0.5, abs=0.02)


def test_without_objects_of_no_class_there_is_no_curve() -> None:
    settings = TrainingSettings(variations=20, images_per_variation=1, negatives=0, exemplars=False)
    places = {"a1": 0, "a2": 0, "b1": 1, "b2": 1}
    found = calibrated(lambda name: direction(places[name]), settings)
    assert found.pictures is None
    assert found.geometry is None
    assert "left_out_auroc_pictures" not in found.metrics


@pytest.mark.parametrize("seed", range(12))
def test_few_variations_leave_every_fold_something_to_learn(seed: int) -> None:
    """Which are held out is drawn by class: with few of each model a fold may have all of them on one side."""
    settings = TrainingSettings(variations=4, images_per_variation=1, negatives=0, exemplars=False, seed=seed)
    places = {"a1": 0, "a2": 0, "b1": 1, "b2": 1}
    assert calibrated(lambda name: direction(places[name]), settings).temperature > 0


def test_there_is_no_forecast_where_no_model_can_be_left_out() -> None:
    settings = TrainingSettings(variations=20, images_per_variation=2, negatives=10, exemplars=False)
    plan = plan_learning({name: models[:1] for name, models in toy_classes().items()}, (), settings)
    rng, store, backbone = np.random.default_rng(0), MemoryStore(), load_backbone()
    for chunk, _ in plan.chunks:
        store.put(features_key(chunk, settings, backbone), rng.normal(size=(chunk.count, 2, 8)).astype(np.float16))
    found = calibrate(plan, load_features(plan, settings, backbone, store), settings)
    assert found.metrics == {"left_out_meshes": 0}
    assert found.pictures is not None


def test_a_training_reports_what_becomes_of_left_out_models() -> None:
    classes = {name: [*models, *also(models[0])] for name, models in toy_classes().items()}
    settings = TrainingSettings(variations=12, images_per_variation=2, image_size=64, negatives=8, held_out=0.25)
    metrics = train_classifier(classes, settings).metrics
    for name in ("left_out_accuracy", "left_out_accuracy_pictures", "left_out_auroc", "left_out_auroc_pictures"):
        assert 0.0 <= metrics[name] <= 1.0
    assert metrics["left_out_meshes"] == 3 * 12
    assert metrics["left_out_accuracy"] > 0.6
    for geometry in (True, False):
        points = trade_off_of(metrics, geometry=geometry)
        assert points is not None
        accepted, refused = [p.accepted_known for p in points], [p.refused_other for p in points]
        assert (accepted[0], refused[0]) == (1.0, 0.0)
        assert accepted == sorted(accepted, reverse=True)
        assert refused == sorted(refused)
        at_default = next(point for point in points if point.threshold == KNOWN_THRESHOLD)
        assert at_default.refused_other >= REFUSED - 0.13, "one of the eight objects at most is over it"


def also(model: BoxModel) -> list[BoxModel]:
    """Another model of the same class, a little different."""
    return [BoxModel(f"{model.model.name} again", model.parts * 1.1)]
