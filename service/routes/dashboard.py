"""The dashboard's built files at ``/``."""

from pathlib import Path

from fastapi import APIRouter, Response
from fastapi.responses import FileResponse, HTMLResponse
from starlette.exceptions import HTTPException

from service.conditional import CACHE_CONTROL
from service.dependencies import ServicesDep

router = APIRouter(include_in_schema=False)

_NOT_BUILT = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Shapewright</title></head>
<body style="font-family: sans-serif; max-width: 40rem; margin: 4rem auto; line-height: 1.5">
<h1>Shapewright</h1>
<p>The service runs; its dashboard is not built yet. Build it with</p>
<pre>cd service/dashboard &amp;&amp; npm ci &amp;&amp; npm run build</pre>
<p>and reload this page; <code>bash scripts/demo</code> does it, too. The API is described in
<a href="/openapi.json">openapi.json</a>.</p>
</body></html>
"""


@router.get("/")
def get_index(services: ServicesDep) -> Response:
    """The page, never cached: it names the files that belong to it."""
    index = services.settings.dashboard_dir / "index.html"
    headers = {"Cache-Control": "no-cache"}
    if not index.is_file():
        return HTMLResponse(_NOT_BUILT, headers=headers)
    return FileResponse(index, headers=headers)


@router.get("/assets/{path:path}")
def get_asset(services: ServicesDep, path: str) -> Response:
    """A file of the build; its name carries a hash of its content, so it may be cached for ever."""
    return _file(services.settings.dashboard_dir / "assets", path, CACHE_CONTROL)


@router.get("/{name}")
def get_file(services: ServicesDep, name: str) -> Response:
    """A file beside the page, like its icon."""
    return _file(services.settings.dashboard_dir, name, "no-cache")


def _file(folder: Path, name: str, cache_control: str) -> Response:
    root = folder.resolve()
    if "\0" in name or not (path := (root / name).resolve()).is_relative_to(root) or not path.is_file():
        raise HTTPException(404)
    return FileResponse(path, headers={"Cache-Control": cache_control})
