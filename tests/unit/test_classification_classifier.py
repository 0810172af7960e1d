"""Using a classifier: the file carries everything, damage is refused, torch is not needed."""

import json
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise

import numpy as np
import onnx
import onnxruntime
import pytest
import simple_shapes
from simple_shapes import toy_classes

from shapewright.classification import UNKNOWN, Classifier, TradeOffPoint, exemplars_file, load_classifier
from shapewright.classification.file_format import FORMAT_VERSION, read_metadata
from shapewright.classification.readings import readings
from shapewright.distances.panorama import panorama_descriptor
from shapewright.errors import ClassifierError
from shapewright.network import load_backbone
from shapewright.training import TrainingSettings, train_classifier
from shapewright.training.calibration import Calibration
from shapewright.training.export import export_classifier
from shapewright.training.head import Head, Layer
from shapewright.training.negatives import random_assembly

SETTINGS = TrainingSettings(
    variations=24, images_per_variation=4, image_size=128, negatives=40, held_out=0.25, epochs=25
)


@pytest.fixture(scope="module")
def trained():
    return train_classifier(toy_classes(), SETTINGS)


@pytest.fixture(scope="module")
def pictures_alone(trained) -> Classifier:
    return Classifier(trained.onnx)


@pytest.fixture(scope="module")
def with_geometry(trained) -> Classifier:
    return Classifier(trained.onnx, exemplars=trained.exemplars)


@pytest.fixture(params=["pictures_alone", "with_geometry"])
def classifier(request) -> Classifier:
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("name", ["bench", "cross", "block"])
def test_new_instances_get_their_class(classifier, name):
    model = toy_classes()[name][0]
    for values in model.random_values(np.random.default_rng(99), 3):
        answer = classifier.classify(model.instance(values), rng=np.random.default_rng(5))
        assert answer.class_name == name


def test_own_instances_are_known_and_assemblies_are_not(classifier):
    def knowns(meshes):
        return [classifier.classify(mesh, views=6).known for mesh in meshes]

    own = [
        model.instance(values)
        for (model,) in toy_classes().values()
        for values in model.random_values(np.random.default_rng(98), 3)
    ]
    absurd = [random_assembly(np.random.default_rng([5, number])) for number in range(12)]
    own_known, absurd_known = knowns(own), knowns(absurd)
    assert all(0.0 <= known <= 1.0 for known in own_known + absurd_known)
    assert np.mean(own_known) > np.mean(absurd_known) + 0.3
    assert np.median(own_known) > 0.5 > np.median(absurd_known)
    assert classifier.classify(absurd[int(np.argmin(absurd_known))], views=6).answer == UNKNOWN
    best = classifier.classify(own[int(np.argmax(own_known))], views=6)
    assert best.is_known
    assert best.answer == best.class_name
    assert best.known is not None
    assert best.answer_at(best.known) == best.class_name
    assert best.answer_at(np.nextafter(best.known, 1.0)) == UNKNOWN


def test_what_the_file_says_of_itself_can_be_read_without_the_network(trained, pictures_alone):
    assert read_metadata(trained.onnx) == pictures_alone.metadata


def test_without_objects_of_no_class_everything_is_known():
    settings = TrainingSettings(variations=6, images_per_variation=2, image_size=64, negatives=0, exemplars=False)
    answer = Classifier(train_classifier(toy_classes(), settings).onnx).classify(simple_shapes.goblet(), views=2)
    assert answer.known is None
    assert answer.is_known
    assert answer.answer == answer.answer_at(1.0) == answer.class_name


def test_the_trade_off_is_of_the_evidence_that_counts(trained, with_geometry, pictures_alone):
    assert with_geometry.trade_off is None, "no model could be left out, or the file is older"
    text = next(
        prop.value for prop in onnx.load_model_from_string(trained.onnx).metadata_props if prop.key == "shapewright"
    )
    document = json.loads(text)
    point = TradeOffPoint(0.5, 0.9, 0.8)
    document["metrics"] |= {"trade_off": [point.to_dict()], "trade_off_pictures": []}
    content = _with_metadata(trained.onnx, shapewright=json.dumps(document))
    assert Classifier(content, exemplars=trained.exemplars).trade_off == (point,)
    assert Classifier(content).trade_off == ()


def test_with_exemplars_the_answer_holds_distances(trained, with_geometry, pictures_alone):
    mesh = simple_shapes.goblet()
    assert len(readings(mesh)) == 1, "with or without ground is no question"
    answer = with_geometry.classify(mesh, views=3)
    descriptor = panorama_descriptor(mesh.vertices, mesh.faces)
    assert np.array_equal(answer.descriptor.to_array(), descriptor.to_array())
    apart = trained.exemplars.distances(descriptor)
    for number, name in enumerate(with_geometry.class_names):
        assert answer.distances[name] == pytest.approx(apart[trained.exemplars.classes == number].min())
    assert list(answer.distances.values()) == sorted(answer.distances.values())
    alone = pictures_alone.classify(mesh, views=3)
    assert alone.distances is None
    assert alone.descriptor is None
    assert alone.probabilities == pytest.approx(alone.picture_probabilities)
    assert alone.picture_probabilities == answer.picture_probabilities
    assert alone.scores == alone.picture_scores == answer.picture_scores
    for name in with_geometry.class_names:
        assert answer.scores[name] < answer.picture_scores[name], "distances only take away"


def test_exemplars_are_found_beside_the_file(trained, with_geometry, tmp_path):
    path = tmp_path / "things.onnx"
    path.write_bytes(trained.onnx)
    assert load_classifier(path).exemplars is None
    trained.exemplars.save(exemplars_file(path))
    assert exemplars_file(path).parent == tmp_path
    loaded = load_classifier(str(path))
    assert len(loaded.exemplars) == len(trained.exemplars)
    mesh = simple_shapes.stool()
    expected = with_geometry.classify(mesh, views=2).distances
    assert loaded.classify(mesh, views=2).distances == pytest.approx(expected, abs=0.01)
    exemplars_file(path).write_bytes(b"nothing of use")
    with pytest.raises(ClassifierError):
        load_classifier(path)


def test_exemplars_of_another_classifier_are_refused(trained):
    exemplars = trained.exemplars
    for change in (
        {"digests": (*exemplars.digests[:-1], "0" * 64)},
        {"class_names": ("bench", "cross", "cube")},
    ):
        with pytest.raises(ClassifierError, match="another classifier"):
            Classifier(trained.onnx, exemplars=replace(exemplars, **change))


def test_the_answer_holds_views_and_pictures(classifier):
    mesh = simple_shapes.flipped(simple_shapes.stool(), 0.5)
    answer = classifier.classify(mesh, views=7, rng=np.random.default_rng(1))
    assert answer.images.shape == (7, 128, 128, 3)
    assert answer.per_view.shape == (7, 3)
    assert np.allclose(answer.per_view.sum(axis=1), 1.0, atol=1e-5)
    for ranked in (answer.probabilities, answer.picture_probabilities, answer.scores, answer.picture_scores):
        assert set(ranked) == set(classifier.class_names)
        assert list(ranked.values()) == sorted(ranked.values(), reverse=True)
    assert sum(answer.probabilities.values()) == pytest.approx(1.0)
    assert next(iter(answer.probabilities)) == answer.class_name
    for number, name in enumerate(classifier.class_names):
        assert abs(answer.picture_probabilities[name] - answer.per_view[:, number].mean()) < 1e-6
    assert np.allclose(classifier.predict(answer.images), answer.per_view, atol=1e-5)


def test_answers_repeat(classifier):
    mesh = simple_shapes.goblet()
    first, again = classifier.classify(mesh), classifier.classify(mesh)
    assert first.probabilities == again.probabilities
    assert first.known == again.known
    other = classifier.classify(mesh, rng=np.random.default_rng(8))
    assert other.picture_probabilities != first.picture_probabilities


def test_the_file_says_what_training_said(trained, classifier, tmp_path):
    assert classifier.metadata == trained.metadata
    assert classifier.metrics == trained.metrics
    path = tmp_path / "classifier.onnx"
    path.write_bytes(trained.onnx)
    assert Classifier(path).class_names == Classifier(str(path)).class_names == ("bench", "cross", "block")


def test_plain_onnxruntime_reads_the_file(trained, pictures_alone):
    session = onnxruntime.InferenceSession(trained.onnx, providers=["CPUExecutionProvider"])
    images = pictures_alone.render(simple_shapes.stool(), views=2)
    names = ["probabilities", "open_probabilities", "features"]
    probabilities, opened, features = session.run(names, {"images": images})
    assert np.allclose(probabilities, pictures_alone.predict(images), atol=1e-5)
    assert np.allclose(probabilities.sum(axis=1), 1.0, atol=1e-5)
    assert np.all(opened <= probabilities + 1e-6), "none takes a share of each"
    assert np.all(opened.sum(axis=1) < 1.0)
    assert np.allclose(opened / opened.sum(axis=1, keepdims=True), probabilities, atol=1e-3)
    assert features.shape == (2, 1280)
    assert session.get_modelmeta().custom_metadata_map["class_names"] == '["bench", "cross", "block"]'


def test_the_graph_computes_the_trained_head():
    # Torch's head and ONNX Runtime's graph agree, temperature included.
    rng = np.random.default_rng(0)
    from shapewright.network import FeatureExtractor
    from shapewright.training.export import classifier_metadata

    backbone = load_backbone()
    settings = TrainingSettings(image_size=64)
    calibration = Calibration(2.5, None, None, None, {})
    metadata = classifier_metadata(("a", "b", "c", "d"), (), backbone, settings, {}, calibration)
    images = rng.integers(0, 256, (5, 64, 64, 3), dtype=np.uint8)
    features = FeatureExtractor(backbone)(images)
    for widths in ((1280, 4), (1280, 5), (1280, 7, 5)):
        layers = tuple(
            Layer(rng.normal(size=(wide, narrow)).astype(np.float32).T, rng.normal(size=narrow).astype(np.float32))
            for wide, narrow in pairwise(widths)
        )
        head = Head(layers=layers, class_count=4, temperature=2.5, curves={}, best_epoch=0)
        content = export_classifier(backbone, head, metadata)
        assert np.abs(Classifier(content).predict(images) - head.probabilities(features)).max() < 1e-4
        session = onnxruntime.InferenceSession(content, providers=["CPUExecutionProvider"])
        (opened,) = session.run(["open_probabilities"], {"images": images})
        assert np.abs(opened - head.open_probabilities(features)).max() < 1e-4


def _with_metadata(content: bytes, **changes: str) -> bytes:
    model = onnx.load_model_from_string(content)
    props = {prop.key: prop.value for prop in model.metadata_props}
    onnx.helper.set_model_props(model, {**props, **changes})
    return model.SerializeToString()


def test_damaged_and_foreign_files_are_refused(trained, tmp_path):
    good = trained.onnx
    damaged = {
        "empty": b"",
        "text": b"this is no network",
        "truncated": good[: len(good) // 2],
        "foreign": load_backbone().graph,
        "broken json": _with_metadata(good, shapewright="{"),
    }
    text = next(prop.value for prop in onnx.load_model_from_string(good).metadata_props if prop.key == "shapewright")
    whole = json.loads(text)
    version = {"version": FORMAT_VERSION}
    for name, document in {
        "no classes": {"format": whole["format"], **version},
        "other format": {**whole, "format": "cake"},
        "older": {**whole, "version": FORMAT_VERSION - 1},
        "newer": {**whole, "version": FORMAT_VERSION + 1},
        "a curve of another kind": {**whole, "known": {"pictures": {"slope": "steep"}, "geometry": None}},
        "more shifts than classes": {
            **whole,
            "known": {"pictures": {"slope": 1.0, "intercept": 0.0, "shifts": [0.1] * 9}, "geometry": None},
        },
        "no word on what is known": {key: value for key, value in whole.items() if key != "known"},
        "an unknown style": {**whole, "rendering": {**whole["rendering"], "style": "cubist"}},
        "an unknown framing": {**whole, "rendering": {**whole["rendering"], "framing": "gold"}},
        "a trade-off of another kind": {**whole, "metrics": {**whole["metrics"], "trade_off": [{"threshold": 0.5}]}},
        "figures that are none": {**whole, "metrics": ["trade_off"]},
        "models without digests": {**whole, "models": [{"name": "bench"}]},
        "a list": [1, 2],
    }.items():
        damaged[name] = _with_metadata(good, shapewright=json.dumps(document))
    damaged["other class count"] = _with_metadata(good, shapewright=text.replace('"bench", ', "", 1))
    damaged["other size"] = _with_metadata(good, shapewright=text.replace('"image_size": 128', '"image_size": 64'))
    for name, content in damaged.items():
        with pytest.raises(ClassifierError):
            Classifier(content)
        path = tmp_path / "damaged.onnx"
        path.write_bytes(content)
        with pytest.raises(ClassifierError) as caught:
            Classifier(path)
        assert caught.value.where == "damaged.onnx", name
    with pytest.raises(ClassifierError, match="cannot be read"):
        Classifier(tmp_path / "missing.onnx")


def test_wrong_pictures_and_views_are_refused(pictures_alone):
    classifier = pictures_alone
    with pytest.raises(ClassifierError) as caught:
        classifier.predict(np.zeros((1, 64, 64, 3), dtype=np.uint8))
    assert caught.value.where == "images"
    with pytest.raises(ClassifierError) as caught:
        classifier.classify(simple_shapes.box(), views=0)
    assert caught.value.where == "views"


def test_classifying_imports_nothing_that_only_learning_and_estimating_need(trained, tmp_path):
    path = tmp_path / "classifier.onnx"
    path.write_bytes(trained.onnx)
    trained.exemplars.save(exemplars_file(path))
    script = f"""
import sys
import numpy as np
from shapewright import TriangleMesh
from shapewright.classification import load_classifier
assert "numba" not in sys.modules, "kernels are loaded where they are first called"
mesh = TriangleMesh(np.eye(4, 3), np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]))
answer = load_classifier({str(path)!r}).classify(mesh, views=2)
assert answer.distances is not None
print(answer.class_name)
others = {{"torch", "onnx", "trimesh", "moderngl", "scipy.optimize"}}  # trees and sparse sums read the mesh
ours = {{"shapewright.training", "shapewright.modeling.compiled", "shapewright.estimation.estimating"}}
assert not (others | ours) & set(sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() in ("bench", "cross", "block")
