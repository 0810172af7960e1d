"""A client of the REST service: what the demo does, another program can do the same way."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import httpx
from httpx_sse import SSEError, connect_sse

from shapewright.errors import ShapewrightError
from shapewright.progress import NULL_PROGRESS, Progress

TERMINAL_STATES = frozenset({"succeeded", "failed", "cancelled"})
RECONNECT_PAUSE_S = 0.5
RECONNECT_ATTEMPTS = 20


class ServiceError(ShapewrightError):
    """The service refused a request, did not answer, or a job of it did not succeed."""


class Client:
    """Speaks with one service; errors of the service become :class:`ServiceError`.

    Args:
        url: address of the service, e.g. ``http://127.0.0.1:8000``.
        timeout_s: of one request; following a job has no limit.
    """

    def __init__(self, url: str, *, timeout_s: float = 60.0) -> None:
        # trust_env: a proxy of the environment has no business between us and the service
        self._http = httpx.Client(base_url=url, timeout=timeout_s, trust_env=False)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._http.close()

    def wait_until_ready(self, timeout_s: float) -> None:
        """Ask ``/readyz`` until it says yes.

        Raises:
            ServiceError: it did not within the time.
        """
        deadline_s = time.monotonic() + timeout_s
        while True:
            try:
                self.get("/readyz")
                return
            except ServiceError as error:
                if time.monotonic() > deadline_s:
                    raise ServiceError(f"not ready after {timeout_s:g} s: {error.message}", where="/readyz") from None
            time.sleep(0.1)

    def get(self, path: str) -> Any:
        """Get a JSON answer."""
        return self._request("GET", path).json()

    def get_bytes(self, path: str) -> bytes:
        """Get a file."""
        return self._request("GET", path).content

    def post(self, path: str, body: Any) -> Any:
        """Post a JSON document and return the JSON answer."""
        return self._request("POST", path, json=body).json()

    def post_document(self, path: str, document: str) -> tuple[Any, bool]:
        """Post a document as it is; return the answer and whether it was new."""
        response = self._request("POST", path, content=document.encode(), headers={"Content-Type": "application/json"})
        return response.json(), response.status_code == 201

    def upload(self, path: str, file: Path) -> Any:
        """Post a file as the multipart field ``file``."""
        with file.open("rb") as content:
            return self._request("POST", path, files={"file": (file.name, content)}).json()

    def list_items(self, path: str) -> Iterator[Any]:
        """Walk through all pages of a list."""
        cursor: str | None = None
        while True:
            page = self._request("GET", path, params={"cursor": cursor} if cursor else None).json()
            yield from page["items"]
            cursor = page["next_cursor"]
            if cursor is None:
                return

    def follow(self, job: Any, progress: Progress = NULL_PROGRESS) -> Any:
        """Wait for a job by its event stream, which is taken up again where it broke; return the finished job.

        Raises:
            ServiceError: the job failed or was cancelled, or the service went away.
        """
        last_id, ended, failures = "", False, 0
        while not ended:
            headers = {"Last-Event-ID": last_id} if last_id else {}
            try:
                with connect_sse(self._http, "GET", job["events_url"], headers=headers, timeout=None) as source:
                    source.response.raise_for_status()
                    for event in source.iter_sse():
                        last_id, failures = event.id or last_id, 0
                        if event.event == "progress":
                            data = event.json()
                            progress.report(float(data["fraction"]), str(data["message"] or ""))
                        elif event.event == "state" and event.json()["state"] in TERMINAL_STATES:
                            ended = True
                            break
            except (httpx.HTTPError, SSEError) as error:
                failures += 1
                if failures >= RECONNECT_ATTEMPTS:
                    raise ServiceError(f"lost the job's event stream: {error}", where=job["url"]) from None
            if not ended:
                time.sleep(RECONNECT_PAUSE_S)
                ended = self.get(job["url"])["state"] in TERMINAL_STATES
        finished = self.get(job["url"])
        if finished["state"] != "succeeded":
            problem = finished.get("error") or {}
            reason = problem.get("detail") or problem.get("title") or "no reason given"
            raise ServiceError(f"the {finished['kind']} job {finished['state']}: {reason}", where=problem.get("where"))
        return finished

    def _request(self, method: str, path: str, **options: Any) -> httpx.Response:
        try:
            response = self._http.request(method, path, **options)
        except httpx.HTTPError as error:
            raise ServiceError(f"no answer: {error}", where=f"{method} {path}") from None
        if response.is_error:
            raise ServiceError(_reason(response), where=f"{method} {path}")
        return response


def _reason(response: httpx.Response) -> str:
    """What a problem document (RFC 9457) says, or the status line."""
    try:
        problem = response.json()
        text = problem.get("detail") or problem["title"]
        return f"{problem['where']}: {text}" if problem.get("where") else str(text)
    except (ValueError, KeyError, AttributeError):
        return f"{response.status_code} {response.reason_phrase}"


@contextmanager
def connected(url: str, *, ready_within_s: float) -> Iterator[Client]:
    """A client of a service that has said that it is ready."""
    with Client(url) as client:
        client.wait_until_ready(ready_within_s)
        yield client
