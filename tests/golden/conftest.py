"""Golden images: ``pytest tests/golden --update-golden`` renews them after a look at the difference."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

FOLDER = Path(__file__).resolve().parent
MEAN_TOLERANCE = 1.0
"""Mean absolute difference allowed, in grey levels of 255; another driver shifts a few edge pixels."""
LOUD_LEVEL = 48
LOUD_SHARE = 0.01
"""Share of pixels that may differ by more than ``LOUD_LEVEL``."""


def pytest_addoption(parser: pytest.Parser) -> None:
    # Seen only when this folder is named on the command line, which is all that renewing needs.
    parser.addoption("--update-golden", action="store_true", help="write the golden images anew")


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[str, np.ndarray], None]:
    """A function that compares a picture with its golden image, or writes it under ``--update-golden``."""
    renew = bool(request.config.getoption("--update-golden", default=False))

    def compare(name: str, picture: np.ndarray) -> None:
        path = FOLDER / "images" / f"{name}.png"
        if renew:
            path.parent.mkdir(exist_ok=True)
            Image.fromarray(picture).save(path, optimize=True)
            return
        assert path.is_file(), f"no golden image {path.name}: pytest tests/golden --update-golden makes it"
        with Image.open(path) as image:
            expected = np.asarray(image.convert("RGB"))
        assert expected.shape == picture.shape, f"{name}: {picture.shape}, golden {expected.shape}"
        difference = np.abs(expected.astype(np.int16) - picture)
        mean, loud = difference.mean(), (difference.max(axis=2) > LOUD_LEVEL).mean()
        if mean > MEAN_TOLERANCE or loud > LOUD_SHARE:
            failed = FOLDER / "failed"
            failed.mkdir(exist_ok=True)
            shown = np.concatenate([expected, picture, 255 - difference.astype(np.uint8)], axis=0)
            Image.fromarray(shown).save(failed / f"{name}.png")
            pytest.fail(
                f"{name} differs: mean {mean:.2f}, {100 * loud:.2f} % loudly; expected, drawn and difference "
                f"are in {(failed / name).relative_to(FOLDER.parent.parent)}.png"
            )

    return compare
