"""The one exception tree of the library.

Misuse and bad input raise a subclass of :class:`ShapewrightError`; expected numerical outcomes are returned.
Entry points (REST, shell, workers) translate these errors once, at their edge.
"""


class ShapewrightError(Exception):
    """Base of every error that the library raises on purpose.

    Args:
        message: what is wrong, in one sentence.
        where: the place in the input, e.g. ``operations[3].faces`` or ``line 12``; ``None`` if there is none.
    """

    def __init__(self, message: str, *, where: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = where

    def __str__(self) -> str:
        return f"{self.where}: {self.message}" if self.where else self.message


class MeshError(ShapewrightError):
    """A triangle mesh that cannot be worked with: no faces, NaN, zero area, indices out of range."""


class MeshFileError(MeshError):
    """A mesh file that cannot be read: empty, truncated, too large, of a wrong type, or with links outside."""


class ModelError(ShapewrightError):
    """A procedural model that is not valid: its document, an operation, an element id, a range."""


class ParameterError(ShapewrightError):
    """Parameter values that do not belong to a model: an unknown name, NaN, a value out of its range."""


class RenderingError(ShapewrightError):
    """Headless OpenGL is missing or refused to draw."""


class ClassifierError(ShapewrightError):
    """A classifier file that is not ours or is damaged, or training data that cannot be learned from."""


class EstimationError(ShapewrightError):
    """Settings of an estimation that make no sense together."""


class EvaluationError(ShapewrightError):
    """A dataset that cannot be read, or an evaluation that is asked to compare nothing."""


class Cancelled(ShapewrightError):  # noqa: N818 - it is a request that was granted, not an error
    """Somebody asked for the work to stop; raised by :meth:`shapewright.progress.Progress.report`."""

    def __init__(self, message: str = "cancelled", *, where: str | None = None) -> None:
        super().__init__(message, where=where)
