"""What the store refuses, translated once at the edge of the service and of the workers."""

from shapewright.errors import ShapewrightError


class StoreError(ShapewrightError):
    """Base of every error that the store raises on purpose."""


class NotFoundError(StoreError):
    """There is no such model, mesh, job or result.

    Args:
        what: the kind of thing, e.g. ``"mesh"``.
        identifier: the id, of a class the name, that was asked for.
    """

    def __init__(self, what: str, identifier: str) -> None:
        super().__init__(f"there is no {what} with the {'name' if what == 'class' else 'id'} {identifier!r}")
        self.what = what
        self.identifier = identifier


class NotReadyError(StoreError):
    """The thing exists, but what is asked of it is not there yet (e.g. a classifier still in training)."""


class CursorError(StoreError):
    """A paging cursor that this service has not handed out, or a limit out of range."""


class JobFinishedError(StoreError):
    """The job has ended already, so it can no longer be cancelled."""


class StaleClaim(StoreError):  # noqa: N818 - it tells the holder that it lost the job, not that something broke
    """The claim is no longer the current one: the job was given to another worker, or it has ended."""


class ArtifactError(StoreError):
    """An artefact cannot be written or read: full disk, no permission, a store that does not answer."""


class ArtifactNotFoundError(ArtifactError):
    """There is no artefact under this key."""
