"""Analysis by synthesis: a fit begins at the nearest exemplar and comes nearer, with the values of what it found."""

import numpy as np
import pytest

from models_store.library.shipped import load_shipped
from shapewright.classification import Classifier
from shapewright.classification.synthesis import fit_class
from shapewright.distances.panorama import panorama_descriptor, panorama_distance
from shapewright.errors import ClassifierError
from shapewright.modeling import compile_model
from shapewright.training import TrainingSettings, train_classifier

SETTINGS = TrainingSettings(variations=16, images_per_variation=2, image_size=96, negatives=0, epochs=10)


@pytest.fixture(scope="module")
def models():
    return {name: compile_model(load_shipped(name)) for name in ("table_wire", "glass_with_stem_shell")}


@pytest.fixture(scope="module")
def trained(models):
    return train_classifier({compiled.model.class_name: [compiled] for compiled in models.values()}, SETTINGS)


@pytest.fixture(scope="module")
def by_digest(models):
    return {compiled.model.digest: compiled for compiled in models.values()}


@pytest.mark.parametrize("seed", range(3))
def test_a_fit_comes_nearer_and_says_with_which_values(trained, models, by_digest, seed):
    compiled = models["table_wire"]
    query = compiled.instance(compiled.random_values(np.random.default_rng([9, seed]), 1)[0])
    descriptor = panorama_descriptor(query.vertices, query.faces)
    distances = trained.exemplars.distances(descriptor)
    number = trained.class_names.index("table")
    fit = fit_class(descriptor, trained.exemplars, distances, number, by_digest, np.random.default_rng(0))
    assert fit is not None
    assert fit.exemplar_distance == distances[trained.exemplars.classes == number].min()
    assert fit.distance <= fit.exemplar_distance
    assert fit.digest == compiled.model.digest
    np.testing.assert_array_equal(fit.values, compiled.settle(fit.values[None])[0])
    rebuilt = compiled.instance(fit.values)
    again = panorama_distance(descriptor, panorama_descriptor(rebuilt.vertices, rebuilt.faces))
    assert abs(again - fit.distance) < 1e-3


def test_most_fits_come_clearly_nearer(trained, models, by_digest):
    compiled, gains = models["table_wire"], []
    for values in compiled.random_values(np.random.default_rng(4), 6):
        mesh = compiled.instance(values)
        found = Classifier(trained.onnx, exemplars=trained.exemplars).classify(mesh, views=2, models=by_digest)
        assert found.fits is not None
        assert set(found.fits) == {"table", "glass_with_stem"}, "the two most probable of two"
        assert found.class_name == "table"
        assert found.distances is not None
        assert found.distances["table"] == found.fits["table"].distance
        gains.append(1.0 - found.fits["table"].distance / found.fits["table"].exemplar_distance)
    assert np.median(gains) > 0.05


def test_without_the_models_at_hand_nothing_is_fitted(trained, models):
    mesh = models["table_wire"].instance(models["table_wire"].base_values())
    classifier = Classifier(trained.onnx, exemplars=trained.exemplars)
    plain, fitted = (classifier.classify(mesh, views=2, models=given) for given in (None, {}))
    assert plain.fits is None
    assert fitted.fits == {}
    assert fitted.scores == plain.scores
    with pytest.raises(ClassifierError) as caught:
        Classifier(trained.onnx).classify(mesh, models={})
    assert caught.value.where == "models"
