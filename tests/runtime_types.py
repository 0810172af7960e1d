"""The run-time type checker of the tests: shapes and types of every call of the library are checked.

An int may stand for a float, as PEP 484 says.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from beartype import BeartypeConf, beartype
from jaxtyping import install_import_hook

check = beartype(conf=BeartypeConf(is_pep484_tower=True))

UNCHECKED: Final = frozenset(
    {"shapewright.modeling.elements", "shapewright.modeling.fields", "shapewright.modeling.subdivision"}
)
"""They read, write or collect single numbers: to check millions of such calls takes minutes and finds nothing that the
static types, and the checks of those who use them, do not tell."""


def check_library(package: Path) -> None:
    """Have all modules of the package checked that are imported from now on."""
    install_import_hook([name for name in _modules(package) if name not in UNCHECKED], "runtime_types.check")


def _modules(package: Path) -> Iterator[str]:
    for file in sorted(package.rglob("*.py")):
        parts = file.relative_to(package.parent).with_suffix("").parts
        if parts[-1] != "__init__":  # which only pass names on
            yield ".".join(parts)
