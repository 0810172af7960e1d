"""Using a classifier: the file carries everything, damage is refused, torch is not needed."""

import subprocess
import sys

import numpy as np
import onnx
import onnxruntime
import pytest
import simple_shapes
from simple_shapes import toy_classes

from shapewright.classification import Classifier, TrainingSettings, load_backbone, train_classifier
from shapewright.classification.export import export_classifier
from shapewright.classification.head import Head
from shapewright.errors import ClassifierError

SETTINGS = TrainingSettings(variations=8, images_per_variation=3, image_size=128, held_out=0.25, epochs=25)


@pytest.fixture(scope="module")
def trained():
    return train_classifier(toy_classes(), SETTINGS)


@pytest.fixture(scope="module")
def classifier(trained) -> Classifier:
    return Classifier(trained.onnx)


@pytest.mark.parametrize("name", ["bench", "cross", "block"])
def test_new_instances_get_their_class(classifier, name):
    model = toy_classes()[name][0]
    for values in model.random_values(np.random.default_rng(99), 3):
        answer = classifier.classify(model.instance(values), rng=np.random.default_rng(5))
        assert answer.class_name == name


def test_the_answer_holds_views_and_pictures(classifier):
    mesh = simple_shapes.flipped(simple_shapes.stool(), 0.5)
    answer = classifier.classify(mesh, views=7, rng=np.random.default_rng(1))
    assert answer.images.shape == (7, 128, 128, 3)
    assert answer.per_view.shape == (7, 3)
    assert np.allclose(answer.per_view.sum(axis=1), 1.0, atol=1e-5)
    assert list(answer.probabilities.values()) == sorted(answer.probabilities.values(), reverse=True)
    assert next(iter(answer.probabilities)) == answer.class_name
    for number, name in enumerate(classifier.class_names):
        assert abs(answer.probabilities[name] - answer.per_view[:, number].mean()) < 1e-6
    assert np.allclose(classifier.predict(answer.images), answer.per_view, atol=1e-5)


def test_answers_repeat(classifier):
    mesh = simple_shapes.goblet()
    assert classifier.classify(mesh).probabilities == classifier.classify(mesh).probabilities
    other = classifier.classify(mesh, rng=np.random.default_rng(8))
    assert other.probabilities != classifier.classify(mesh).probabilities


def test_the_file_says_what_training_said(trained, classifier, tmp_path):
    assert classifier.metadata == trained.metadata
    assert classifier.metrics == trained.metrics
    path = tmp_path / "classifier.onnx"
    path.write_bytes(trained.onnx)
    assert Classifier(path).class_names == Classifier(str(path)).class_names == ("bench", "cross", "block")


def test_plain_onnxruntime_reads_the_file(trained, classifier):
    session = onnxruntime.InferenceSession(trained.onnx, providers=["CPUExecutionProvider"])
    images = classifier.render(simple_shapes.stool(), views=2)
    probabilities, features = session.run(["probabilities", "features"], {"images": images})
    assert np.allclose(probabilities, classifier.predict(images), atol=1e-5)
    assert features.shape == (2, 1280)
    assert session.get_modelmeta().custom_metadata_map["class_names"] == '["bench", "cross", "block"]'


def test_the_graph_computes_the_trained_head():
    # Torch's head and ONNX Runtime's graph agree, temperature included.
    rng = np.random.default_rng(0)
    from shapewright.classification import FeatureExtractor
    from shapewright.classification.export import classifier_metadata

    backbone = load_backbone()
    weight, bias = rng.normal(size=(4, 1280)).astype(np.float32), rng.normal(size=4).astype(np.float32)
    head = Head(weight=weight, bias=bias, temperature=2.5, curves={}, best_epoch=0)
    settings = TrainingSettings(image_size=64)
    onnx_bytes = export_classifier(
        backbone, head, classifier_metadata(("a", "b", "c", "d"), (), backbone, settings, {})
    )
    images = rng.integers(0, 256, (5, 64, 64, 3), dtype=np.uint8)
    expected = head.probabilities(FeatureExtractor(backbone)(images))
    assert np.abs(Classifier(onnx_bytes).predict(images) - expected).max() < 1e-4


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
        "no classes": _with_metadata(good, shapewright='{"format": "shapewright-classifier", "version": 1}'),
        "other format": _with_metadata(good, shapewright='{"format": "cake", "version": 1}'),
        "newer": _with_metadata(good, shapewright='{"format": "shapewright-classifier", "version": 2}'),
    }
    text = next(prop.value for prop in onnx.load_model_from_string(good).metadata_props if prop.key == "shapewright")
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


def test_wrong_pictures_and_views_are_refused(classifier):
    with pytest.raises(ClassifierError) as caught:
        classifier.predict(np.zeros((1, 64, 64, 3), dtype=np.uint8))
    assert caught.value.where == "images"
    with pytest.raises(ClassifierError) as caught:
        classifier.classify(simple_shapes.box(), views=0)
    assert caught.value.where == "views"


def test_classifying_imports_neither_torch_nor_onnx(trained, tmp_path):
    path = tmp_path / "classifier.onnx"
    path.write_bytes(trained.onnx)
    script = f"""
import sys
import numpy as np
from shapewright import Classifier, TriangleMesh
mesh = TriangleMesh(np.eye(4, 3), np.array([[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]))
print(Classifier({str(path)!r}).classify(mesh, views=2).class_name)
assert not {{"torch", "onnx"}} & set(sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() in ("bench", "cross", "block")


def test_settings_need_no_heavy_package():
    script = """
import sys
from shapewright.classification import TrainingSettings
TrainingSettings()
assert not {"torch", "onnx", "onnxruntime", "moderngl"} & set(sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
