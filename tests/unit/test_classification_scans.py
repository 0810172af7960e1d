"""What a classifier says of point clouds and of scans with more in them than the object."""

import numpy as np
import pytest
import simple_shapes
from simple_shapes import toy_classes

from shapewright.classification import Classifier
from shapewright.distances.surface import uniform_points
from shapewright.errors import ClassifierError
from shapewright.evaluation.corruptions.dust import add_dust
from shapewright.evaluation.corruptions.ground import add_ground
from shapewright.evaluation.corruptions.half import see_one_side
from shapewright.mesh import PointCloud, TriangleMesh
from shapewright.training import TrainingSettings, train_classifier

SETTINGS = TrainingSettings(
    variations=24, images_per_variation=4, image_size=96, negatives=12, held_out=0.25, epochs=15
)
NAMES = sorted(toy_classes())


@pytest.fixture(scope="module")
def classifier() -> Classifier:
    trained = train_classifier(toy_classes(), SETTINGS)
    return Classifier(trained.onnx, exemplars=trained.exemplars)


def variations(name: str, count: int = 2) -> list[TriangleMesh]:
    (model,) = toy_classes()[name]
    return [model.instance(values) for values in model.random_values(np.random.default_rng(77), count)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("count", [1000, 8000])
def test_a_cloud_gets_the_class_of_its_mesh(classifier, name: str, count: int) -> None:
    for mesh in variations(name):
        cloud = PointCloud(uniform_points(mesh, count, rng=np.random.default_rng(1)))
        assert classifier.classify(cloud, views=6).class_name == classifier.classify(mesh, views=6).class_name == name


@pytest.mark.parametrize("name", ["bench", "cross"])
def test_ground_and_dust_change_no_class(classifier, name: str) -> None:
    rng = np.random.default_rng(3)
    for mesh in variations(name):
        for scan in (add_ground(mesh, 1.5, rng), add_dust(mesh, 0.2, rng)):
            assert classifier.classify(scan, views=6).class_name == name


def test_dust_changes_no_answer(classifier) -> None:
    (mesh,) = variations("bench", 1)
    dusty = add_dust(mesh, 0.2, np.random.default_rng(0))
    clean, other = (classifier.classify(one, views=6) for one in (mesh, dusty))
    assert np.abs(clean.per_view - other.per_view).mean() < 0.1
    assert other.known == pytest.approx(clean.known, abs=0.1)


def test_winding_hardly_changes_answers(classifier) -> None:
    for name in NAMES:
        (mesh,) = variations(name, 1)
        answer = classifier.classify(mesh, views=6)
        for share in (0.5, 1.0):
            other = classifier.classify(simple_shapes.flipped(mesh, share), views=6)
            assert other.class_name == answer.class_name
            assert np.abs(other.per_view.mean(axis=0) - answer.per_view.mean(axis=0)).mean() < 0.1


def test_answers_about_clouds_repeat(classifier) -> None:
    cloud = PointCloud(uniform_points(simple_shapes.goblet(), 2000, rng=np.random.default_rng(1)))
    first, again = classifier.classify(cloud, views=3), classifier.classify(cloud, views=3)
    assert first.probabilities == again.probabilities
    assert np.array_equal(first.images, again.images)


def test_a_classifier_of_triangles_refuses_clouds() -> None:
    settings = TrainingSettings.paper(variations=4, images_per_variation=1, image_size=64, epochs=2)
    classifier = Classifier(train_classifier(toy_classes(), settings).onnx)
    cloud = PointCloud(uniform_points(simple_shapes.stool(), 500, rng=np.random.default_rng(1)))
    for ask in (classifier.classify, classifier.render):
        with pytest.raises(ClassifierError, match="need faces; a point cloud has none") as caught:
            ask(cloud, views=2)
        assert caught.value.where == "style"
    assert classifier.classify(simple_shapes.stool(), views=2).class_name in NAMES


def test_a_scan_of_one_side_is_seen_three_times_as_often_and_classified_by_pictures(classifier) -> None:
    (mesh,) = variations("bench", 1)
    scan = see_one_side(mesh, 128, np.random.default_rng(2))
    for query in (scan, PointCloud(scan.vertices)):
        answer = classifier.classify(query, views=4)
        assert len(answer.per_view) == len(answer.images) == 12
        assert answer.probabilities == pytest.approx(answer.picture_probabilities)
        assert answer.distances is not None
        assert np.array_equal(classifier.render(query, views=4), answer.images)
