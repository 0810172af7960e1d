"""How quickly the API is there, how much memory it takes, and how fast a slider moves.

Run ``.venv/bin/python benchmarks/startup.py``; one JSON document goes to stdout. Every figure of a start comes from
fresh processes; memory is the resident size that the operating system tells. ``--only sliders`` leaves the rest out:
how long it takes over REST from the parameters of one instance to its GLB file, for the model with the largest surface
and for the slowest one.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

REPEATS = 5

IMPORT = """
import json, time
before = time.perf_counter()
import {module}
print(json.dumps(time.perf_counter() - before))
"""

READY = """
import asyncio, json, sys, time
before = time.perf_counter()
from pathlib import Path
from service.app import create_app
from service.settings import ServiceSettings

async def start():
    app = create_app(ServiceSettings(data_dir=Path(sys.argv[1]), log_level="error"))
    async with app.router.lifespan_context(app):
        return time.perf_counter() - before

print(json.dumps(asyncio.run(start())))
"""


def fresh(code: str, *arguments: str) -> float:
    """Median of what a program prints, each time in a process of its own."""
    command = [sys.executable, "-c", code, *arguments]
    runs = [subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(REPEATS)]
    return statistics.median(json.loads(run) for run in runs)


def resident_mb(pid: int) -> float:
    """Resident memory of a process in 10^6 bytes."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def milliseconds(work: Callable[[int], object], repeats: int) -> dict[str, float]:
    """Median and 95th percentile of one call, after two that fill caches."""
    times = []
    for index in range(repeats + 2):
        start = perf_counter()
        work(index)
        times.append((perf_counter() - start) * 1000)
    times = sorted(times[2:])
    return {"median": statistics.median(times), "p95": times[int(0.95 * (len(times) - 1))]}


def documents() -> dict[str, str]:
    """The shipped models; a box with a neck where none are shipped."""
    library = Path(__file__).parents[1] / "models_store" / "library"
    shipped = {path.parent.name: path.read_text() for path in sorted(library.glob("*/*/model.json"))}
    if shipped:
        return shipped
    from shapewright.modeling import Recorder

    recorder = Recorder("box", "box")
    recorder.parameter("neck_length", "neck length", 0.5, 2.0)
    recorder.extrude(recorder.box(1.0, 1.0, 1.0).top, 0.5, length="neck_length")
    return {"box": recorder.build().to_json()}


def api_process(ask: Callable[[Any], dict[str, Any]]) -> dict[str, Any]:
    """Figures of a whole API process that answers what ``ask`` asks over HTTP."""
    import socket

    import httpx

    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "uvicorn", "--factory", "service.app:create_app", "--port", str(port)]
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "SHAPEWRIGHT_DATA_DIR": folder, "SHAPEWRIGHT_LOG_LEVEL": "error"}
        start = perf_counter()
        process = subprocess.Popen(
            [*command, "--log-level", "error", "--no-access-log"],
            env=environment,
            cwd=Path(__file__).parents[1],
            stdout=subprocess.DEVNULL,
        )
        try:
            with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60) as client:
                while True:
                    try:
                        client.get("/readyz").raise_for_status()
                        break
                    except httpx.TransportError:
                        if process.poll() is not None:
                            raise
                figures: dict[str, Any] = {"seconds_to_first_answer": perf_counter() - start}
                figures["resident_mb_after_start"] = resident_mb(process.pid)
                figures |= ask(client)
                figures["resident_mb_after_requests"] = resident_mb(process.pid)
                return figures
        finally:
            process.terminate()
            process.wait(30)


def sliders(client: Any, repeats: int = 100) -> dict[str, Any]:
    """From the parameters of an instance to its GLB file, for every model; each request asks for another variation."""
    headers = {"Content-Type": "application/json"}
    models: dict[str, Any] = {}
    for name, document in documents().items():
        model = client.post("/v1/models", content=document, headers=headers).raise_for_status().json()
        url = f"/v1/models/{model['id']}/instances"
        content = client.post(url, json={}).raise_for_status().content

        def slide(seed: int, url: str = url) -> None:
            client.post(url, json={"seed": seed}).raise_for_status()

        models[name] = {
            "operations": model["operation_count"],
            "parameters": len(model["parameters"]),
            "surface_vertices": vertex_count(content),
            "glb_bytes": len(content),
            "milliseconds": milliseconds(slide, repeats),
        }
    largest = max(models, key=lambda name: models[name]["surface_vertices"])
    slowest = max(models, key=lambda name: models[name]["milliseconds"]["median"])
    named = {"largest": {"model": largest, **models[largest]}, "slowest": {"model": slowest, **models[slowest]}}
    return {"sliders": named, "instance_post_to_glb": models}


def vertex_count(glb: bytes) -> int:
    """Vertices of the first mesh of a GLB file."""
    length = int.from_bytes(glb[12:16], "little")
    document = json.loads(glb[20 : 20 + length])
    position = document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    return int(document["accessors"][position]["count"])


def requests(client: Any) -> dict[str, Any]:
    """What a person at the dashboard does: models, a mesh, sliders."""
    instances = sliders(client)

    def upload(index: int) -> None:
        off = f"OFF\n4 4 6\n0 0 0\n{index + 1} 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
        client.post("/v1/meshes", files={"file": ("mesh.off", off.encode())}).raise_for_status()

    listing = milliseconds(lambda _: client.get("/v1/models").raise_for_status(), 100)
    return {
        **instances,
        "small_mesh_upload_milliseconds": milliseconds(upload, 5),
        "model_list_milliseconds": listing,
    }


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=["sliders"], help="measure this alone")
    if parser.parse_args().only:
        print(json.dumps(api_process(sliders)["sliders"], indent=2))
        return
    with tempfile.TemporaryDirectory() as folder:
        figures = {
            "seconds_import_shapewright": fresh(IMPORT.format(module="shapewright")),
            "seconds_import_torch_for_comparison": fresh(IMPORT.format(module="torch")),
            "seconds_create_app_to_ready": fresh(READY, folder),
            "api_process": api_process(requests),
        }
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
