"""Extending: new classes are recognized, what was known stays, and what was unknown stays unknown."""

from dataclasses import replace

import numpy as np
import pytest
from simple_shapes import BoxModel, joined, toy_classes

from shapewright.classification import Classifier
from shapewright.errors import Cancelled, ClassifierError
from shapewright.network import load_backbone
from shapewright.network.graphs import classifier_graph, classifier_parts
from shapewright.progress import CallbackProgress
from shapewright.training import (
    ExtensionSettings,
    MemoryStore,
    TrainedClassifier,
    TrainingSettings,
    extend_classifier,
    train_classifier,
)
from shapewright.training.exemplars import usual_distances_of
from shapewright.training.extending import learn_extension, plan_extension
from shapewright.training.learning import draw_and_describe

FEW = ExtensionSettings(variations=20, images_per_variation=3, rehearsed=10, negatives=24)
BASE = TrainingSettings(
    variations=20, images_per_variation=3, image_size=96, negatives=24, hidden=48, epochs=30, seed=3
)
STORE = MemoryStore()
"""Of all extensions here."""


def shelf() -> BoxModel:
    """Three boards above each other, like nothing that the base knows."""
    return BoxModel("shelf", [((0, height, 0), (1.4, 0.05, 1.4)) for height in (-0.7, 0, 0.7)])


def known() -> list[BoxModel]:
    return [model for models in toy_classes().values() for model in models]


@pytest.fixture(scope="module")
def base() -> TrainedClassifier:
    return train_classifier(toy_classes(), BASE)


@pytest.fixture(scope="module")
def extended(base: TrainedClassifier) -> TrainedClassifier:
    return extend_classifier(base, {"shelf": [shelf()]}, known=known(), settings=FEW, store=STORE)


def answers(trained: TrainedClassifier, models: list[BoxModel], count: int = 6) -> list[dict[str, float]]:
    """Probabilities of variations that nobody has learned from."""
    classifier = Classifier(trained.onnx, exemplars=trained.exemplars)
    rng = np.random.default_rng(99)
    meshes = [mesh for model in models for mesh in model.instances(model.random_values(rng, count))]
    return [classifier.classify(mesh, views=4).probabilities for mesh in meshes]


def test_rows_of_old_classes_backbone_and_hidden_layer_stay(base, extended):
    before, after = classifier_parts(base.onnx), classifier_parts(extended.onnx)
    assert after.features == before.features
    (hidden, last), (hidden_after, last_after) = before.layers, after.layers
    assert all(np.array_equal(*pair) for pair in zip(hidden, hidden_after, strict=True))
    for values, values_after in zip(last, last_after, strict=True):
        assert len(values_after) == len(values) + 1
        assert np.array_equal(values_after[:3], values[:3])
        assert not np.array_equal(values_after[4], values[3]), "what is unknown is learned anew"
    assert (after.class_count, after.temperature) == (4, before.temperature)
    names = ("known", "rendering", "backbone", "settings")
    assert {name: extended.metadata[name] for name in names} == {name: base.metadata[name] for name in names}


def test_the_new_class_is_recognized_and_the_old_ones_are_not_forgotten(base, extended):
    assert [next(iter(answer)) for answer in answers(extended, [shelf()])].count("shelf") >= 5
    before, after = answers(base, known()), answers(extended, known())
    assert [next(iter(one)) for one in before] == [next(iter(one)) for one in after]
    assert (
        np.mean([abs(one[name] - other[name]) for one, other in zip(before, after, strict=True) for name in one]) < 0.03
    )
    figures = extended.metrics
    assert figures["new_accuracy"] >= 0.7
    assert figures["known_accuracy"] >= figures["known_accuracy_before"] - 0.2
    assert figures["held_out_variations"] == 3 * 2 + 4


def test_what_is_of_no_class_stays_unknown(base, extended):
    figures = extended.metrics
    assert figures["other_refused"] >= figures["other_refused_before"] - 0.2
    pile = joined([shelf().instance(np.full(9, 1.0)), known()[0].instance(np.full(15, 1.3))])
    before, after = (Classifier(one.onnx, exemplars=one.exemplars).classify(pile).known for one in (base, extended))
    assert after <= before + 0.2


def test_the_files_say_what_was_added(base, extended):
    assert extended.class_names == ("bench", "cross", "block", "shelf")
    models = extended.metadata["models"]
    assert models[:3] == base.metadata["models"]
    assert models[3] == {"name": "shelf", "class": "shelf", "digest": shelf().model.digest}
    (step,) = extended.metadata["extensions"]
    assert (step["class_names"], step["settings"]) == (["shelf"], FEW.to_dict())
    usual = extended.metadata["usual_distances"]
    assert usual[:3] == base.metadata["usual_distances"]
    assert 0 < usual[3] < 1
    exemplars = extended.exemplars
    own = exemplars.classes == 3
    assert exemplars.digests[3] == shelf().model.digest
    assert 0 < own.sum() < FEW.variations, "the whole variations"
    assert np.array_equal(exemplars.descriptors[~own], base.exemplars.descriptors)
    assert np.array_equal(exemplars.classes[~own], base.exemplars.classes)
    row = int(np.flatnonzero(own)[0])
    assert exemplars.values(row, shelf()).shape == (9,)


def test_the_same_extension_gives_the_same_file_and_finds_what_was_drawn(base, extended, tmp_path):
    store, drawn = MemoryStore(), []
    again = extend_classifier(base, {"shelf": [shelf()]}, known=known()[::-1], settings=FEW, store=store)
    assert again.onnx == extended.onnx
    progress = CallbackProgress(lambda fraction, message: drawn.append(message))
    extend_classifier(base, {"shelf": [shelf()]}, known=known(), settings=FEW, store=store, progress=progress)
    assert not [message for message in drawn if message.startswith(("shelf", "bench"))]


def test_an_extended_classifier_is_extended_again_after_it_was_saved(extended, tmp_path):
    extended.exemplars.save(tmp_path / "mine.exemplars.npz")
    (tmp_path / "mine.onnx").write_bytes(extended.onnx)
    loaded = TrainedClassifier.load(tmp_path / "mine.onnx")
    assert (loaded.class_names, loaded.metadata) == (extended.class_names, extended.metadata)
    rod = BoxModel("rod", [((0, 0, 0), (0.1, 2, 0.1))])
    twice = extend_classifier(loaded, {"rod": [rod]}, known=[*known(), shelf()], settings=FEW, store=STORE)
    assert twice.class_names == ("bench", "cross", "block", "shelf", "rod")
    assert [step["class_names"] for step in twice.metadata["extensions"]] == [["shelf"], ["rod"]]
    assert next(iter(answers(twice, [shelf()], 1)[0])) == "shelf"


@pytest.mark.parametrize("hidden", [0, 16])
def test_a_base_of_pictures_alone_that_knows_nothing_of_unknown_can_be_extended(hidden: int):
    settings = replace(BASE, variations=4, image_size=64, negatives=0, exemplars=False, hidden=hidden)
    base = train_classifier(toy_classes(), settings)
    wall = BoxModel("wall", [((0, 0, 0), (2, 1, 0.1))])
    store = MemoryStore()
    few = replace(FEW, variations=4, rehearsed=4)
    extension = plan_extension(base, {"shelf": [shelf()], "wall": [wall]}, known=known(), settings=few)
    assert extension.backbone.graph == load_backbone().graph
    draw_and_describe(extension.plan, extension.drawing, store, backbone=extension.backbone)
    trained = learn_extension(extension, store)
    assert (trained.exemplars, trained.metadata["usual_distances"]) == (None, None)
    parts = classifier_parts(trained.onnx)
    assert len(parts.layers[-1][0]) == 5
    assert np.array_equal(parts.layers[-1][0][:3], classifier_parts(base.onnx).layers[-1][0])
    assert "other_refused" not in trained.metrics
    assert Classifier(trained.onnx).class_names == ("bench", "cross", "block", "shelf", "wall")


def test_a_graph_is_taken_apart_into_what_it_was_made_of():
    rng = np.random.default_rng(0)
    layers = [(rng.normal(size=shape).astype(np.float32), rng.normal(size=shape[0]).astype(np.float32))
              for shape in ((7, 1280), (5, 7), (4, 5))]  # fmt: skip
    graph = classifier_graph(load_backbone().graph, layers, 3, 1.5, image_size=96, metadata={"a": "b"})
    parts = classifier_parts(graph.SerializeToString())
    assert parts.features == load_backbone().graph
    assert (parts.class_count, parts.temperature) == (3, 1.5)
    for layer, read in zip(layers, parts.layers, strict=True):
        assert all(np.array_equal(*pair) for pair in zip(layer, read, strict=True))
    with pytest.raises(ClassifierError, match="taken apart"):
        classifier_parts(load_backbone().graph)


@pytest.mark.parametrize(
    ("classes", "given", "others", "told"),
    [
        ({}, known(), [], "no class to add"),
        ({"bench": [shelf()]}, known(), [], r"classes\.bench: the base knows this class already"),
        ({"unknown": [shelf()]}, known(), [], "this word"),
        ({"shelf": []}, known(), [], "no models"),
        ({"shelf": [shelf()]}, known()[1:], [], "missing, or given in another version: bench"),
        ({"shelf": [shelf()]}, [*known(), BoxModel("wall", [])], [], "has not learned from wall"),
        ({"shelf": [shelf(), shelf()]}, known(), [], "twice"),
        ({"shelf": [shelf()]}, known(), [shelf()], "twice"),
        ({"shelf": [known()[0]]}, known(), [], "twice"),
    ],
)
def test_refusals(base, classes, given, others, told):
    with pytest.raises(ClassifierError, match=told):
        extend_classifier(base, classes, known=given, negatives=others)


def test_a_base_of_an_unknown_backbone_or_setting_is_refused(base):
    for name, value in (("backbone", "resnet"), ("moods", 3)):
        settings = {**base.metadata["settings"], name: value}
        strange = replace(base, metadata={**base.metadata, "settings": settings})
        with pytest.raises(ClassifierError, match=f"settings of the base classifier: {name}"):
            extend_classifier(strange, {"shelf": [shelf()]}, known=known())


def test_settings_are_checked_and_those_of_the_base_cannot_be_chosen():
    assert ExtensionSettings.from_dict(FEW.to_dict()) == FEW
    for values, told in (
        ({"seed": 3}, "seed: cannot be chosen"),
        ({"colour": 1}, "colour: no such setting"),
        ({"variations": "many"}, "variations: is 'many'"),
        ({"variations": 1}, "variations: is 1"),
        ({"rehearsed": 1}, "rehearsed: is 1"),
        ({"held_out": 1.0}, "held_out"),
    ):
        with pytest.raises(ClassifierError, match=told):
            ExtensionSettings.from_dict(values)


def test_a_single_exemplar_has_the_distance_that_is_usual_for_others(extended):
    exemplars = extended.exemplars
    rows = np.concatenate([np.flatnonzero(exemplars.classes == 0)[:1], np.flatnonzero(exemplars.classes > 0)])
    distances = usual_distances_of(exemplars.taken(rows), otherwise=0.25)
    assert distances == [0.25, *usual_distances_of(exemplars, otherwise=0.25)[1:]]


def test_it_can_be_cancelled(base):
    def stop(fraction: float, message: str) -> None:
        if fraction > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        extend_classifier(base, {"shelf": [shelf()]}, known=known(), settings=FEW, progress=CallbackProgress(stop))
