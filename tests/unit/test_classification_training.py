"""Training: toy classes are learned, repeatably, from variations that are kept apart; progress and metadata tell."""

import json

import numpy as np
import pytest
from simple_shapes import BoxModel, toy_classes

from shapewright.classification import FeatureExtractor, TrainingSettings, load_backbone, train_classifier
from shapewright.classification.dataset import BLOCK, _blocks, class_features, join_classes, variation_images
from shapewright.classification.head import fit_temperature, train_head
from shapewright.classification.training import calibration_error, held_out_metrics
from shapewright.errors import Cancelled, ClassifierError
from shapewright.progress import CallbackProgress

SMALL = TrainingSettings(variations=12, images_per_variation=3, image_size=128, held_out=0.25, epochs=25, seed=3)


@pytest.fixture(scope="module")
def trained():
    reports: list[tuple[float, str]] = []
    progress = CallbackProgress(lambda fraction, message: reports.append((fraction, message)))
    return train_classifier(toy_classes(), SMALL, progress), reports


def test_toy_classes_are_learned(trained):
    result, _ = trained
    assert result.class_names == ("bench", "cross", "block")
    assert result.metrics["held_out_accuracy"] == 1.0
    assert result.metrics["held_out_image_accuracy"] >= 0.9
    assert result.metrics["images"] == 3 * 12 * 3
    assert result.metrics["held_out_variations"] == 3 * 3
    assert np.trace(result.metrics["confusion"]) == 9
    curves = result.metrics["curves"]
    assert curves["train_loss"][-1] < 0.5 * curves["train_loss"][0]
    assert len(curves["held_out_loss"]) == result.metrics["epochs"]


def test_random_weights_do_badly_on_the_same_pictures():
    # The control: if this passed with random weights, the test above would say nothing about the backbone.
    settings = TrainingSettings(variations=12, images_per_variation=3, image_size=128, held_out=0.5, epochs=40)
    accuracy = {}
    for name in ("efficientnet_lite0", "efficientnet_lite0_random"):
        extractor = FeatureExtractor(load_backbone(name))
        features = [class_features(models, settings, extractor) for models in toy_classes().values()]
        data = join_classes(features, settings)
        head = train_head(data, 3, settings)
        accuracy[name] = held_out_metrics(data, head, ("bench", "cross", "block"))["held_out_image_accuracy"]
    assert accuracy["efficientnet_lite0"] >= 0.9
    assert accuracy["efficientnet_lite0_random"] <= accuracy["efficientnet_lite0"] - 0.2


def test_the_same_seed_gives_the_same_file(trained):
    result, _ = trained
    again = train_classifier(toy_classes(), SMALL)
    assert again.onnx == result.onnx


def test_pictures_of_a_class_do_not_depend_on_other_classes_or_counts():
    model = toy_classes()["cross"][0]
    whole = variation_images(model, 0, 4, SMALL)
    assert np.array_equal(variation_images(model, 0, 2, SMALL), whole[: 2 * SMALL.images_per_variation])
    assert not np.array_equal(variation_images(model, 1, 4, SMALL), whole), "another block, other variations"
    other = TrainingSettings.from_dict({**SMALL.to_dict(), "seed": 4})
    assert not np.array_equal(variation_images(model, 0, 4, other), whole)


def test_several_models_share_a_class():
    bench, cross = (toy_classes()[name][0] for name in ("bench", "cross"))
    settings = TrainingSettings(variations=5, images_per_variation=1, image_size=64)
    extractor = FeatureExtractor(load_backbone())
    features = class_features([bench, cross], settings, extractor)
    alone = extractor(variation_images(cross, 0, 2, settings))
    assert features.shape == (5, 1280)
    assert np.allclose(features[3:], alone, atol=1e-4)


@pytest.mark.parametrize(("models", "variations"), [(1, 7), (3, 1000), (4, 1000), (9, 20)])
def test_variations_are_shared_evenly(models: int, variations: int):
    generators = [BoxModel(f"box {number}", [((0, 0, 0), (1, 1, 1))]) for number in range(models)]
    shares = {generator.model.name: 0 for generator in generators}
    for generator, _, count in _blocks(generators, variations):
        assert count <= BLOCK
        shares[generator.model.name] += count
    assert sum(shares.values()) == variations
    assert max(shares.values()) - min(shares.values()) <= 1


def test_held_out_variations_are_kept_apart_whole():
    settings = TrainingSettings(variations=20, images_per_variation=4, held_out=0.2)
    data = join_classes([np.zeros((80, 2), dtype=np.float32)] * 3, settings)
    for variation in np.unique(data.variations):
        assert len(set(data.held_out[data.variations == variation])) == 1
    for label in range(3):
        apart = np.unique(data.variations[data.held_out & (data.labels == label)])
        assert len(apart) == 4
    assert len(np.unique(data.variations)) == 60


def test_progress_goes_up_and_tells_of_pictures_and_epochs(trained):
    _, reports = trained
    fractions = [fraction for fraction, _ in reports]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert fractions[-1] == 1.0
    messages = " ".join(message for _, message in reports)
    assert "bench" in messages
    assert "epoch" in messages
    assert "held out" in messages


def test_training_can_be_cancelled_while_drawing_and_while_learning():
    for word in ("cross", "epoch 2"):

        def stop(fraction: float, message: str, word: str = word) -> None:
            if word in message:
                raise Cancelled

        with pytest.raises(Cancelled):
            train_classifier(
                toy_classes(),
                TrainingSettings(variations=2, images_per_variation=1, image_size=64, held_out=0.5),
                CallbackProgress(stop),
            )


def test_metadata_tells_where_a_classifier_comes_from(trained):
    result, _ = trained
    json.dumps(result.metadata)
    assert result.metadata["models"][0] == {
        "name": "bench",
        "class": "bench",
        "digest": toy_classes()["bench"][0].model.digest,
    }
    assert result.metadata["backbone"]["weights_sha256"] == load_backbone().weights_sha256
    assert result.metadata["settings"]["seed"] == 3
    assert result.metadata["rendering"]["style"] == "edges"
    assert TrainingSettings.from_dict(json.loads(json.dumps(result.metadata))["settings"]) == SMALL


@pytest.mark.parametrize("drop", [("cross", "block"), ("bench", "cross", "block")])
def test_one_class_is_no_choice(drop):
    classes = {name: models for name, models in toy_classes().items() if name not in drop}
    with pytest.raises(ClassifierError, match="at least two"):
        train_classifier(classes, SMALL)


def test_a_class_needs_models_and_not_too_many():
    with pytest.raises(ClassifierError) as caught:
        train_classifier({**toy_classes(), "empty": []}, SMALL)
    assert caught.value.where == "classes.empty"
    with pytest.raises(ClassifierError, match="more models than variations"):
        train_classifier({**toy_classes(), "many": toy_classes()["block"] * 13}, SMALL)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("variations", 1),
        ("images_per_variation", 0),
        ("image_size", 100),
        ("scale_range", (2.0, 0.8)),
        ("held_out", 1.0),
        ("epochs", 0),
        ("seed", -1),
        ("backbone", "none"),
        ("subdivision_steps", 9),
    ],
)
def test_settings_that_make_no_sense_are_refused(name, value):
    with pytest.raises(ClassifierError) as caught:
        TrainingSettings(**{name: value})
    assert caught.value.where == name


@pytest.mark.parametrize(
    ("name", "value"),
    [("variation", 5), ("variations", "many"), ("variations", 2.5), ("seed", True), ("scale_range", [1, "x"])],
)
def test_settings_from_json_are_checked(name, value):
    with pytest.raises(ClassifierError) as caught:
        TrainingSettings.from_dict({name: value})
    assert caught.value.where == name


def test_settings_from_json_keep_defaults():
    assert TrainingSettings.from_dict({}) == TrainingSettings()
    assert TrainingSettings.from_dict({"scale_range": [1, 2], "seed": 3}).scale_range == (1.0, 2.0)


def test_temperature_softens_and_never_sharpens():
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 3, 4000)
    honest = np.eye(3)[labels] * 1.5 + rng.gumbel(size=(4000, 3))
    fitted = fit_temperature(10 * honest, labels)
    assert fitted > 3
    assert fit_temperature(honest * 0.01, labels) == 1.0
    assert fit_temperature(np.eye(3)[labels] * 5, labels) == 1.0, "all right: no reason to be surer still"


def test_calibration_error_is_the_gap_between_sureness_and_truth():
    right = np.arange(1000) % 10 < 7
    assert calibration_error(np.full(1000, 0.7), right) < 1e-9
    assert abs(calibration_error(np.full(1000, 0.9), right) - 0.2) < 1e-9


def test_blocks_bound_what_is_in_memory():
    assert BLOCK * TrainingSettings().images_per_variation * 224 * 224 * 3 < 50e6
