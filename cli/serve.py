"""`shapewright serve`: the service and a worker together, with nothing else to install."""

import contextlib
import os
import signal
import socket
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.console import AsJson, print_json
from cli.worker_process import WorkerProcess, worker_command
from shapewright.errors import ShapewrightError

if TYPE_CHECKING:
    import uvicorn

SHUTDOWN_S = 3


class ServeError(ShapewrightError):
    """The service cannot be started."""


def serve(
    host: Annotated[str, typer.Option(help="Address to listen on; 0.0.0.0 means every interface.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 takes a free one.")] = 8000,
    data_dir: Annotated[
        Path | None,
        typer.Option(help="Folder of the database, files and queue (default: ./shapewright-data).", show_default=False),
    ] = None,
    worker: Annotated[bool, typer.Option(help="Start a worker beside the service.")] = True,
    concurrency: Annotated[
        int | None,
        typer.Option(min=1, max=64, help="Jobs that the worker does at a time (default: 1).", show_default=False),
    ] = None,
    log_level: Annotated[str, typer.Option(help="debug, info, warning or error.")] = "warning",
    as_json: AsJson = False,
) -> None:
    """Start the REST service, the dashboard and a worker; Ctrl-C stops all of them.

    A new database begins with the models that ship and the ready classifier: open the address, drop a mesh.
    SHAPEWRIGHT_ADD_SHIPPED_ON_START=false begins with nothing.

    The embedded default needs no server: SQLite, a folder of files and a queue in --data-dir. For production set
    SHAPEWRIGHT_DATABASE_URL, SHAPEWRIGHT_BROKER_URL and SHAPEWRIGHT_ARTIFACTS_URL, and start as many workers as you
    like with [bold]celery -A workers.app worker[/].

    With --json one document with the addresses is printed as soon as the service answers.

    Examples:

      [bold]shapewright serve[/]
      [bold]shapewright serve --port 0 --data-dir /srv/shapewright --json[/]
    """
    if log_level.lower() not in ("debug", "info", "warning", "error"):
        raise ServeError("use debug, info, warning or error", where=f"--log-level {log_level}")
    _set_environment(data_dir, concurrency, log_level.upper())
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # both end as KeyboardInterrupt, in order
    with ExitStack() as stack:
        listener = stack.enter_context(_listen(host, port))
        stack.callback(_ignore_signals)
        server = _make_server(log_level.lower())
        worker_pid = None
        with contextlib.suppress(KeyboardInterrupt):
            if worker:
                child = WorkerProcess(worker_command(), os.environ, say=_remark)
                stack.callback(child.stop)
                stack.callback(_ignore_signals)
                worker_pid = child.start()
            shown_host = "127.0.0.1" if host in ("0.0.0.0", "::", "") else host
            url = f"http://{shown_host}:{listener.getsockname()[1]}"
            _announce(server, url, worker_pid, as_json)
            server.run(sockets=[listener])
            if not server.started:
                raise ServeError("the service did not start; its messages are above")


def _set_environment(data_dir: Path | None, concurrency: int | None, log_level: str) -> None:
    """Service and worker read their settings from the environment; an option goes before a variable."""
    if data_dir is not None:
        os.environ["SHAPEWRIGHT_DATA_DIR"] = str(data_dir.resolve())
    if concurrency is not None:
        os.environ["SHAPEWRIGHT_WORKER_CONCURRENCY"] = str(concurrency)
    os.environ["SHAPEWRIGHT_LOG_LEVEL"] = log_level


def _ignore_signals() -> None:
    """While the worker is stopped, an impatient second Ctrl-C shall not leave it behind."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)


def _listen(host: str, port: int) -> socket.socket:
    """Take the port before anything is started, so that a busy one is a clear error."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
    except (OSError, OverflowError) as error:
        listener.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise ServeError(f"cannot listen there: {reason}", where=f"{host}:{port}") from None
    return listener


def _make_server(log_level: str) -> "uvicorn.Server":
    import uvicorn
    from pydantic import ValidationError

    from service.app import create_app

    try:
        app = create_app()
    except ValidationError as error:
        first = error.errors()[0]
        variable = "SHAPEWRIGHT_" + "_".join(str(part) for part in first["loc"]).upper()
        raise ServeError(first["msg"], where=variable) from None
    config = uvicorn.Config(
        app, log_level=log_level, access_log=False, timeout_graceful_shutdown=SHUTDOWN_S
    )  # the service writes an access log of its own
    return uvicorn.Server(config)


def _announce(server: "uvicorn.Server", url: str, worker_pid: int | None, as_json: bool) -> None:
    """Print the addresses once the service answers; uvicorn calls ``startup`` before it takes requests."""
    startup = server.startup

    async def startup_and_tell(sockets: list[socket.socket] | None = None) -> None:
        await startup(sockets=sockets)
        if not server.started:
            return
        if as_json:
            print_json(
                {
                    "url": url,
                    "dashboard_url": f"{url}/",
                    "openapi_url": f"{url}/openapi.json",
                    "pid": os.getpid(),
                    "worker_pid": worker_pid,
                }
            )
        else:
            typer.echo(f"Dashboard      {url}/")
            typer.echo(f"REST API       {url}/openapi.json")
            typer.echo("Ctrl-C stops the service and its worker." if worker_pid else "Ctrl-C stops the service.")
        sys.stdout.flush()

    server.startup = startup_and_tell  # type: ignore[method-assign]


def _remark(message: str) -> None:
    print(f"shapewright: {message}", file=sys.stderr, flush=True)
