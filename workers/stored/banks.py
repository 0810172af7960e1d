"""The panorama bank of a model is the same for every query, so it is built once and kept as an artefact."""

from typing import TYPE_CHECKING

import structlog

from models_store.errors import ArtifactError, ArtifactNotFoundError
from shapewright.errors import EstimationError
from shapewright.progress import Progress
from workers.context import JobContext
from workers.stored.saving import saved_bytes

if TYPE_CHECKING:
    from shapewright.estimation import EstimationSettings, PanoramaBank
    from shapewright.estimation.generator import InstanceGenerator

log = structlog.get_logger(__name__)


def bank_of(
    context: JobContext, settings: "EstimationSettings", compiled: "InstanceGenerator", progress: Progress
) -> "PanoramaBank":
    """Find the bank that an estimation with these settings wants, or build and keep it.

    Raises:
        BankCancelled: the progress cancelled.
    """
    return stored_bank(context, compiled, settings) or new_bank(context, compiled, settings, progress)


def stored_bank(
    context: JobContext, compiled: "InstanceGenerator", settings: "EstimationSettings"
) -> "PanoramaBank | None":
    """The bank that an estimation with these settings wants, mapped into memory; ``None`` if not there yet."""
    from shapewright.estimation import PanoramaBank

    key = bank_key(compiled, settings)
    try:
        bank = PanoramaBank.load(context.artifacts.local_copy(key, context.settings.data_dir / "cache"))
        bank.check_fits(compiled, settings.subdivision_steps)
    except ArtifactNotFoundError:
        return None
    except (EstimationError, ArtifactError, OSError) as error:
        log.warning("stored bank is of no use, a new one is built", key=key, error=str(error))
        return None
    return bank


def new_bank(
    context: JobContext, compiled: "InstanceGenerator", settings: "EstimationSettings", progress: Progress
) -> "PanoramaBank":
    """Build the bank, and keep it for the next query if there is room for it; then it is mapped into memory.

    Raises:
        BankCancelled: the progress cancelled.
    """
    from shapewright.estimation import build_bank_for

    bank = build_bank_for(compiled, settings, progress)
    _keep(context, bank_key(compiled, settings), bank)
    return stored_bank(context, compiled, settings) or bank


def bank_key(compiled: "InstanceGenerator", settings: "EstimationSettings") -> str:
    """The artefact key of a bank: everything that its content depends on."""
    from shapewright.distances.descriptor_files import descriptor_version
    from shapewright.estimation.bank import VERSION

    versions = f"v{VERSION}-d{descriptor_version()}"
    name = f"samples{settings.samples}-seed{settings.seed}-steps{settings.subdivision_steps}-{versions}.npz"
    return f"banks/{compiled.model.digest}/{name}"


def _keep(context: JobContext, key: str, bank: "PanoramaBank") -> None:
    try:
        context.artifacts.put(key, saved_bytes(bank.save))
    except (ArtifactError, OSError) as error:  # the estimation itself needs no room
        log.warning("bank could not be kept", key=key, error=str(error))
