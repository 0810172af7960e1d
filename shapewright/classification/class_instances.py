"""Exemplars: instances of procedural models that stand for their class where distances are measured."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Float32

from shapewright.distances.panorama import panorama_descriptor
from shapewright.errors import ClassifierError
from shapewright.estimation.estimator import BankOf
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

INSTANCES: Final = 500
"""Random instances that stand for a class, shared by its models."""


def instances_of_each(models: Sequence[CompiledModel], instances: int = INSTANCES) -> int:
    """Return how many random instances of each model make the instances of a class.

    Raises:
        ClassifierError: no models, or a negative count.
    """
    if not models or instances < 0:
        raise ClassifierError("exemplars need a model, and a count that is not negative", where="instances")
    return -(-instances // len(models))


def gather_instances(
    models: Sequence[CompiledModel],
    banks: BankOf | None,
    *,
    progress: Progress = NULL_PROGRESS,
) -> Float32[np.ndarray, "M D"]:
    """Descriptors of the base instance of each model, and of random ones.

    Args:
        models: of the class, or the one that is wanted.
        banks: finds the random instances of a model, see :func:`instances_of_each`; without it the base instances are
            left alone, as in the paper's comparison.
        progress: told as banks are built; may cancel.

    Raises:
        ClassifierError: no models.
    """
    if not models:
        raise ClassifierError("exemplars need a model", where="models")
    found = [base_descriptor(compiled)[None] for compiled in models]
    for number, compiled in enumerate(models):
        if banks is None:
            break
        part = PartialProgress(progress, number / len(models), (number + 1) / len(models))
        found.append(np.asarray(banks(compiled, part).descriptors, dtype=np.float32))
    return np.concatenate(found)


def base_descriptor(compiled: CompiledModel) -> Float32[np.ndarray, " D"]:
    """The panorama descriptor of a model's base instance."""
    mesh = compiled.instance(compiled.base_values())
    return panorama_descriptor(mesh.vertices, mesh.faces).to_array()
