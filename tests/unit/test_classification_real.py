"""The shipped models teach what real meshes are: polygon soup from elsewhere gets its class."""

from pathlib import Path

import numpy as np
import pytest

from shapewright.classification import Classifier
from shapewright.mesh.file import load_mesh
from shapewright.modeling import compile_model
from shapewright.training import TrainingSettings, train_classifier

QUERIES = {"m495.off": "glass_with_stem", "m872.off": "table", "m707.off": "sword"}


@pytest.fixture(scope="module")
def classifier(library_models) -> Classifier:
    missing = set(QUERIES.values()) - {model.class_name for model in library_models.values()}
    if missing:
        pytest.skip(f"no shipped models of {sorted(missing)}")
    by_class: dict[str, list] = {}
    for model in library_models.values():
        if model.class_name in QUERIES.values():
            by_class.setdefault(model.class_name, []).append(compile_model(model))
    settings = TrainingSettings(variations=16, images_per_variation=4, negatives=8, held_out=0.2, epochs=40)
    trained = train_classifier(by_class, settings)
    return Classifier(trained.onnx, exemplars=trained.exemplars)


@pytest.mark.real_data
@pytest.mark.parametrize("name", sorted(QUERIES))
def test_a_real_mesh_gets_its_class(real_data: Path, classifier: Classifier, name: str):
    mesh = load_mesh(real_data / "meshes" / "psb" / name)
    answer = classifier.classify(mesh, rng=np.random.default_rng(0))
    assert answer.class_name == QUERIES[name]
    assert answer.probabilities[QUERIES[name]] > 0.6
