"""Training: toy classes are learned, repeatably, from variations that are kept apart; progress and metadata tell."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from simple_shapes import BoxModel, toy_classes

from shapewright.errors import Cancelled, ClassifierError
from shapewright.network import FeatureExtractor, load_backbone
from shapewright.progress import CallbackProgress
from shapewright.training import MemoryStore, TrainingSettings, train_classifier
from shapewright.training.calibration import calibration_error
from shapewright.training.chunks import BLOCK, chunk_images, features_key
from shapewright.training.dataset import load_features, plan_learning
from shapewright.training.head_training import train_head
from shapewright.training.learning import draw_and_describe, held_out_metrics
from shapewright.training.sources import ModelSource

SMALL = TrainingSettings(
    variations=12, images_per_variation=3, image_size=128, negatives=6, held_out=0.25, epochs=25, seed=3
)


@pytest.fixture(scope="module")
def trained():
    reports: list[tuple[float, str]] = []
    progress = CallbackProgress(lambda fraction, message: reports.append((fraction, message)))
    return train_classifier(toy_classes(), SMALL, progress), reports


def test_toy_classes_are_learned(trained):
    result, _ = trained
    assert result.class_names == ("bench", "cross", "block")
    assert result.metrics["held_out_accuracy"] == 1.0
    assert result.metrics["held_out_image_accuracy"] >= 0.8, "some pictures show what is left of a broken variation"
    assert result.metrics["images"] == (3 * 12 + 6 + 3 + 2) * 3, "classes, assemblies, distorted and mixed"
    assert result.metrics["held_out_variations"] == 3 * 3
    assert np.trace(result.metrics["confusion"]) == 9
    curves = result.metrics["curves"]
    assert curves["train_loss"][-1] < 0.5 * curves["train_loss"][0]
    assert len(curves["held_out_loss"]) == result.metrics["epochs"]


def test_random_weights_do_badly_on_the_same_pictures():
    # The control: if this passed with random weights, the test above would say nothing about the backbone.
    settings = TrainingSettings(
        variations=12, images_per_variation=3, image_size=128, held_out=0.5, epochs=40, negatives=0, exemplars=False,
        broken=0.0,
    )  # fmt: skip
    store, accuracy = MemoryStore(), {}
    for name in ("efficientnet_lite0_int8", "efficientnet_lite0_random"):
        chosen = replace(settings, backbone=name)
        plan = plan_learning(toy_classes(), (), chosen)
        draw_and_describe(plan, chosen, store)
        data = load_features(plan, chosen, load_backbone(name), store)
        head = train_head(data, chosen)
        accuracy[name] = held_out_metrics(data, head, plan.class_names)["held_out_image_accuracy"]
    assert accuracy["efficientnet_lite0_int8"] >= 0.9
    assert accuracy["efficientnet_lite0_random"] <= accuracy["efficientnet_lite0_int8"] - 0.2


def test_the_same_seed_gives_the_same_file(trained):
    result, _ = trained
    again = train_classifier(toy_classes(), SMALL)
    assert again.onnx == result.onnx
    assert np.array_equal(again.exemplars.descriptors, result.exemplars.descriptors)


def test_several_models_share_a_class():
    bench, cross, block = (toy_classes()[name][0] for name in ("bench", "cross", "block"))
    settings = TrainingSettings(variations=5, images_per_variation=2, image_size=64, negatives=0, exemplars=False)
    plan = plan_learning({"both": [bench, cross], "block": [block]}, (), settings)
    assert [(share.source.name, share.label, share.count) for share in plan.shares] == [
        ("bench", 0, 3),
        ("cross", 0, 2),
        ("block", 1, 5),
    ]
    store, backbone = MemoryStore(), load_backbone()
    draw_and_describe(plan, settings, store)
    data = load_features(plan, settings, backbone, store)
    assert data.features.shape == (20, 1280)
    assert data.labels.tolist() == [0] * 5 + [1] * 5
    (chunk,) = plan.shares[1].chunks
    alone = FeatureExtractor(backbone)(chunk_images(chunk, settings))
    assert np.allclose(data.features[6:10], alone, atol=0.01)


@pytest.mark.parametrize(("models", "variations"), [(1, 7), (3, 1000), (4, 1000), (9, 20)])
def test_variations_are_shared_evenly(models: int, variations: int):
    generators = [BoxModel(f"box {number}", [((0, 0, 0), (1, 1, 1))]) for number in range(models)]
    settings = TrainingSettings(variations=variations, negatives=0)
    plan = plan_learning({"many": generators, **toy_classes()}, (), settings)
    counts = [share.count for share in plan.shares if share.label == 0]
    assert len(counts) == models
    assert sum(counts) == variations
    assert max(counts) - min(counts) <= 1
    for share in plan.shares:
        assert sum(chunk.count for chunk in share.chunks) == share.count


def test_objects_of_no_class_are_other_models_assemblies_and_what_is_only_tried():
    classes = toy_classes()
    others = [classes.pop("block")[0], BoxModel("further", [((0, 0, 0), (1, 1, 1))])]
    plan = plan_learning(classes, others, TrainingSettings(variations=8, negatives=5))
    rest = [share for share in plan.shares if share.label == len(plan.class_names)]
    assert [(share.source.name, share.count, share.learned) for share in rest] == [
        ("block", 1, True),
        ("further", 1, True),
        ("assemblies", 5, True),
        ("distorted", 1, False),
        ("distorted", 1, False),
        ("mixed", 1, False),
    ]
    assert len({share.source.digest for share in plan.shares}) == len(plan.shares)
    without = plan_learning(classes, others, TrainingSettings(variations=8, negatives=0))
    assert all(share.label < 2 for share in without.shares)


def test_a_class_that_comes_changes_what_no_other_needs():
    """Only what is mixed with its neighbours is new; a further object that becomes a class leaves the others alone."""
    classes = toy_classes()
    name = max(classes)
    models = classes.pop(name)
    settings = TrainingSettings(variations=8, negatives=800)
    others = [BoxModel(f"other{n}", [((0, 0, 0), (1, 1, 1 + n))]) for n in range(3)]

    def chunks(plan):
        return {(chunk.source.digest, chunk.number, chunk.count): chunk.source.name for chunk, _ in plan.chunks}

    before = chunks(plan_learning(classes, [*models, *others], settings))
    after = chunks(plan_learning(classes | {name: models}, others, settings))
    new = [after[key] for key in after.keys() - before.keys()]
    assert sorted(new) == sorted(["distorted", "mixed", models[0].model.name])


@pytest.mark.parametrize("name", ["unknown", "other"])
def test_words_for_what_is_of_no_class_name_no_class(name: str):
    with pytest.raises(ClassifierError, match="of no class"):
        plan_learning(toy_classes() | {name: [BoxModel("x", [((0, 0, 0), (1, 1, 1))])]}, (), TrainingSettings())


def test_a_model_comes_once():
    classes = toy_classes()
    first = next(iter(classes.values()))
    with pytest.raises(ClassifierError, match="comes twice"):
        plan_learning(classes | {"again": first}, (), TrainingSettings())


def test_held_out_variations_are_kept_apart_whole_and_by_class():
    settings = TrainingSettings(variations=20, images_per_variation=4, negatives=10, held_out=0.2, exemplars=False)
    backbone, store = load_backbone(), MemoryStore()

    def features_of(classes):
        plan = plan_learning(classes, (), settings)
        for chunk, _ in plan.chunks:
            store.put(features_key(chunk, settings, backbone), np.zeros((chunk.count, 4, 2), dtype=np.float16))
        return load_features(plan, settings, backbone, store)

    data = features_of(toy_classes())
    assert len(data.labels) == len(data.held_out) == 3 * 20 + 10 + 3 + 2
    assert np.bincount(data.labels[data.held_out]).tolist() == [4, 4, 4, 2]
    assert not data.held_out[~data.learned].any(), "what is only tried is never learned from anyway"
    rows = data.rows(data.held_out)
    assert len(rows) == 14 * 4
    assert np.array_equal(np.unique(rows // 4), np.flatnonzero(data.held_out)), "all pictures of a mesh or none"
    fewer = {name: models for name, models in toy_classes().items() if name != "cross"}
    assert np.array_equal(features_of(fewer).held_out[:20], data.held_out[:20]), "whatever other classes there are"


def test_a_training_without_variation_shows_base_models_only():
    model = toy_classes()["cross"][0]
    values = ModelSource(model, varied=False).values(np.random.default_rng(0), 3)
    assert np.all(values == 1.0)
    assert ModelSource(model, varied=False).digest != ModelSource(model).digest
    settings = replace(SMALL, vary=False, variations=4, images_per_variation=2, image_size=64, negatives=2)
    result = train_classifier(toy_classes(), settings)
    assert result.exemplars is None


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
                TrainingSettings(
                    variations=2, images_per_variation=1, image_size=64, held_out=0.5, negatives=0, exemplars=False
                ),
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
    rendering = result.metadata["rendering"]
    assert (rendering["style"], rendering["framing"], rendering["window"]) == ("splats", "sphere", 1.0)
    assert rendering["scale_range"] == [0.7, 1.0]
    assert [model["digest"] for model in result.metadata["models"]] == list(result.exemplars.digests)
    assert set(result.metadata["known"]) == {"pictures", "geometry"}
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
        ("negatives", -1),
        ("window", 0.0),
        ("held_out", 1.0),
        ("epochs", 0),
        ("seed", -1),
        ("backbone", "none"),
        ("subdivision_steps", 9),
        ("broken", -0.1),
        ("broken", 0.71),
        ("breaks", ("noise", "rust")),
        ("breaks", ("noise", "holes", "noise")),
    ],
)
def test_settings_that_make_no_sense_are_refused(name, value):
    with pytest.raises(ClassifierError) as caught:
        TrainingSettings(**{name: value})
    assert caught.value.where == name


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("variation", 5),
        ("variations", "many"),
        ("variations", 2.5),
        ("seed", True),
        ("scale_range", [1, "x"]),
        ("exemplars", 1),
        ("style", 2),
        ("broken", "much"),
        ("breaks", "noise"),
        ("breaks", [1]),
    ],
)
def test_settings_from_json_are_checked(name, value):
    with pytest.raises(ClassifierError) as caught:
        TrainingSettings.from_dict({name: value})
    assert caught.value.where == name


@pytest.mark.parametrize("style", ["fused", "lambert"])
def test_pictures_of_triangles_are_learned_from_whole_variations_alone(style: str):
    with pytest.raises(ClassifierError, match="0 for pictures of triangles") as caught:
        TrainingSettings(style=style)
    assert caught.value.where == "broken"
    assert TrainingSettings(style=style, broken=0.0).style == style


def test_settings_need_no_heavy_package():
    script = """
import sys
from shapewright.training import TrainingSettings
TrainingSettings()
assert not {"torch", "onnx", "onnxruntime", "moderngl"} & set(sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_settings_from_json_keep_defaults():
    assert TrainingSettings.from_dict({}) == TrainingSettings()
    assert TrainingSettings.from_dict({"scale_range": [1, 2], "seed": 3}).scale_range == (1.0, 2.0)
    assert TrainingSettings.from_dict({"breaks": ["sparse", "noise"]}).breaks == ("sparse", "noise")
    chosen = TrainingSettings(broken=0.25, breaks=("holes",))
    assert TrainingSettings.from_dict(json.loads(json.dumps(chosen.to_dict()))) == chosen


def test_the_papers_settings_are_the_papers():
    paper = TrainingSettings.paper(seed=5)
    assert (paper.variations, paper.images_per_variation, paper.seed) == (1000, 10, 5)
    assert (paper.framing, paper.window, paper.scale_range) == ("paper", 2.0, (0.8, 2.0))
    assert paper.negatives == 0
    assert not paper.exemplars
    assert (paper.style, paper.broken) == ("lambert", 0.0)


def test_calibration_error_is_the_gap_between_sureness_and_truth():
    right = np.arange(1000) % 10 < 7
    assert calibration_error(np.full(1000, 0.7), right) < 1e-9
    assert abs(calibration_error(np.full(1000, 0.9), right) - 0.2) < 1e-9


def test_blocks_bound_what_is_in_memory():
    assert BLOCK * TrainingSettings().images_per_variation * 224 * 224 * 3 < 50e6
