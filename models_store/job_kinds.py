"""The words of jobs: which kinds there are, which states, and the task that carries out each kind."""

from enum import StrEnum
from typing import Final


class JobKind(StrEnum):
    """What a job does."""

    TRAIN_CLASSIFIER = "train_classifier"
    DESCRIBE_VARIATIONS = "describe_variations"
    CLASSIFY = "classify"
    ESTIMATE = "estimate"
    ESTIMATE_COLLECTION = "estimate_collection"
    ESTIMATE_MESHES = "estimate_meshes"
    RENDER_THUMBNAIL = "render_thumbnail"
    INDEX_COLLECTION = "index_collection"
    RETRIEVE = "retrieve"


class JobState(StrEnum):
    """Where a job is: ``queued → running → succeeded | failed | cancelled``."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def is_final(self) -> bool:
        """Whether the job has ended."""
        return self in FINAL_STATES


FINAL_STATES: Final = frozenset({JobState.SUCCEEDED, JobState.FAILED, JobState.CANCELLED})

TASK_NAMES: Final[dict[JobKind, str]] = {kind: f"shapewright.{kind.value}" for kind in JobKind}
"""Name of the Celery task of each kind; the service sends by name and never imports the workers."""
