"""Exemplars: instances of procedural models that stand for their class where distances are measured."""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from jaxtyping import Float32

from shapewright.distances.panorama import panorama_descriptor
from shapewright.errors import ClassifierError
from shapewright.modeling import CompiledModel
from shapewright.progress import NULL_PROGRESS, PartialProgress, Progress

INSTANCES: Final = 500
"""Random instances that stand for a class, shared by its models."""

BankOf = Callable[[CompiledModel, int, Progress], Float32[np.ndarray, "M D"]]
"""Gives the panorama descriptors of so many random instances of a model."""


def gather_instances(
    models: Sequence[CompiledModel],
    bank_of: BankOf,
    *,
    instances: int = INSTANCES,
    progress: Progress = NULL_PROGRESS,
) -> Float32[np.ndarray, "M D"]:
    """Descriptors of the base instance of each model, and of random ones.

    Args:
        models: of the class, or the one that is wanted.
        bank_of: called for each model with its share of the instances.
        instances: random ones, as many of each model; 0 leaves the base instances alone, as the paper's
            comparison does.
        progress: told as banks are built; may cancel.

    Raises:
        ClassifierError: no models, or a negative count.
    """
    if not models or instances < 0:
        raise ClassifierError("exemplars need a model, and a count that is not negative", where="instances")
    found = [base_descriptor(compiled)[None] for compiled in models]
    share = -(-instances // len(models))
    for number, compiled in enumerate(models if share else ()):
        part = PartialProgress(progress, number / len(models), (number + 1) / len(models))
        found.append(np.asarray(bank_of(compiled, share, part), dtype=np.float32))
    return np.concatenate(found)


def base_descriptor(compiled: CompiledModel) -> Float32[np.ndarray, " D"]:
    """The panorama descriptor of a model's base instance."""
    mesh = compiled.instance(compiled.base_values())
    return panorama_descriptor(mesh.vertices, mesh.faces).to_array()
