"""The service's own log: one JSON object a line on stderr."""

import logging
import sys
from typing import Final

import structlog

_NAMES: Final = ("shapewright.service", "shapewright.access")


def configure_logs(level: str) -> None:
    """Let the service's loggers write. Doing it again changes only the level.

    A program that has set up these loggers, or the root logger, keeps its own handlers.
    """
    structlog.configure(
        processors=[
            structlog.stdlib.add_log_level,
            structlog.stdlib.add_logger_name,
            structlog.processors.TimeStamper(fmt="iso", utc=True),
            structlog.processors.format_exc_info,
            structlog.processors.JSONRenderer(),
        ],
        wrapper_class=structlog.stdlib.BoundLogger,
        logger_factory=structlog.stdlib.LoggerFactory(),
        cache_logger_on_first_use=False,
    )
    for name in _NAMES:
        logger = logging.getLogger(name)
        logger.setLevel(level.upper())
        if not logger.hasHandlers():
            handler = logging.StreamHandler(sys.stderr)
            handler.setFormatter(logging.Formatter("%(message)s"))
            logger.addHandler(handler)
