"""Exemplars of what a classifier learned from."""

import numpy as np
from jaxtyping import Float

from shapewright.classification.exemplars import Exemplars
from shapewright.training.dataset import Plan


def exemplars_of(plan: Plan, descriptors: Float[np.ndarray, "A D"], seed: int, subdivision_steps: int) -> Exemplars:
    """Return the exemplars of a plan's classes.

    Args:
        plan: the sources, and how many meshes each one gave.
        descriptors: of all meshes of the plan, see :func:`shapewright.training.dataset.load_descriptors`.
        seed: of the variations.
        subdivision_steps: of the variations.
    """
    known = [share for share in plan.shares if share.label < len(plan.class_names)]
    digests = tuple(share.source.digest for share in known)
    counts = [share.count for share in known]
    return Exemplars(
        class_names=plan.class_names,
        digests=digests,
        seed=seed,
        subdivision_steps=subdivision_steps,
        classes=np.repeat([share.label for share in known], counts),
        models=np.repeat(np.arange(len(known)), counts),
        numbers=np.concatenate([np.arange(count) for count in counts]),
        descriptors=descriptors[: sum(counts)],
    )
