"""Compile what a classification runs before the first query comes: ``python -m shapewright.classification.warm_up``.

As :mod:`shapewright.estimation.fast.warm_up` does for estimations; it takes about twenty seconds of one processor.
"""

import numpy as np

from shapewright.classification.ready import load_ready_classifier
from shapewright.mesh import PointCloud, TriangleMesh


def warm_up() -> None:
    """Ask the ready classifier about a small mesh and a small cloud.

    Raises:
        ClassifierError: it does not ship with this installation.
    """
    classifier = load_ready_classifier()
    corners = np.eye(4, 3)
    for query in (
        TriangleMesh(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])),
        PointCloud(np.random.default_rng(0).dirichlet(np.ones(4), 500) @ corners),
    ):
        classifier.classify(query, views=1)


if __name__ == "__main__":
    warm_up()
