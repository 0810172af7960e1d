"""The published descriptions: ``openapi/openapi.json`` and ``openapi/procedural-model.schema.json``.

``python -m service.openapi`` writes them, with ``--check`` it tells whether they are stale.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any, Final

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from service.schemas.common import ProblemOut
from service.schemas.jobs import JobProgressOut
from shapewright.modeling import json_schema

FOLDER: Final = Path(__file__).resolve().parents[1] / "openapi"
_REF: Final = "#/components/schemas/{model}"


def install_openapi(app: FastAPI) -> None:
    """Let the app describe itself with what FastAPI does not know: problem documents and the model format."""

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            document = get_openapi(title=app.title, version=app.version, summary=app.summary, routes=app.routes)
            schemas = document["components"]["schemas"]
            for unused in ("HTTPValidationError", "ValidationError"):
                schemas.pop(unused, None)
            problem = ProblemOut.model_json_schema(ref_template=_REF, mode="serialization")
            schemas.update(problem.pop("$defs"))
            schemas["ProblemOut"] = problem
            schemas["JobProgressOut"] = JobProgressOut.model_json_schema(mode="serialization")
            schemas["ProceduralModelDocument"] = {k: v for k, v in json_schema().items() if k != "$schema"}
            document["components"]["schemas"] = dict(sorted(schemas.items()))
            app.openapi_schema = document
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]


def documents() -> dict[Path, str]:
    """The text of each published file."""
    from service.app import create_app
    from service.settings import ServiceSettings

    settings = ServiceSettings(
        database_url="sqlite://", artifacts_url="memory://", broker_url="memory://", cors_origins=()
    )
    texts = {
        FOLDER / "openapi.json": create_app(settings).openapi(),
        FOLDER / "procedural-model.schema.json": json_schema(),
    }
    return {path: json.dumps(content, indent=2, ensure_ascii=False) + "\n" for path, content in texts.items()}


def stale() -> list[Path]:
    """The published files that are missing or not what the code says."""
    return [
        path for path, text in documents().items() if not path.is_file() or path.read_text(encoding="utf-8") != text
    ]


def main() -> int:
    """Write or check the files. Returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m service.openapi", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if a file is stale")
    if parser.parse_args().check:
        for path in (old := stale()):
            print(f"{path.relative_to(FOLDER.parent)} is stale: run python -m service.openapi", file=sys.stderr)
        return 1 if old else 0
    FOLDER.mkdir(exist_ok=True)
    for path, text in documents().items():
        path.write_text(text, encoding="utf-8")
        print(path.relative_to(FOLDER.parent))
    return 0


if __name__ == "__main__":
    sys.exit(main())
