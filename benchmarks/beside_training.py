"""What a training costs who classifies beside it: ``.venv/bin/python benchmarks/beside_training.py``, in JSON.

A service with two workers on the embedded default. One mesh is classified again and again: alone, beside a training,
and beside processes that do nothing but count, one for each core. The last is what the shared cores explain;
``training_over_busy_cores`` is what remains of the slowdown of the work, 1.0 if nothing. Answers come in steps of the
intervals at which queue and events are polled.
"""

import argparse
import json
import multiprocessing
import os
import statistics
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

from cli.client import Client, connected
from cli.local_service import local_service
from models_store.library.shipped import list_shipped

SAMPLE = Path(__file__).parents[1] / "examples" / "goblet.ply"


def count_for_ever() -> None:
    """Keep one core busy."""
    number = 0
    while True:
        number += 1


@contextmanager
def busy_cores(count: int) -> Iterator[None]:
    """Processes that count, until the end of the block."""
    processes = [multiprocessing.Process(target=count_for_ever, daemon=True) for _ in range(count)]
    for process in processes:
        process.start()
    yield
    for process in processes:
        process.kill()
        process.join()


def classify(client: Client, body: dict[str, Any], repeats: int) -> dict[str, float]:
    """Medians: from the request to the answer, and of that the worker's own time."""
    whole, worked = [], []
    for _ in range(repeats):
        started_s = perf_counter()
        accepted = client.post("/v1/classifications", body)
        client.follow(accepted["job"])
        whole.append(perf_counter() - started_s)
        worked.append(client.get(accepted["url"])["result"]["seconds"])
    return {
        "answer_ms": round(1e3 * statistics.median(whole), 1),
        "answer_worst_ms": round(1e3 * max(whole), 1),
        "work_ms": round(1e3 * statistics.median(worked), 1),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=25)
    options = parser.parse_args()
    os.environ["SHAPEWRIGHT_WORKER_CONCURRENCY"] = "2"
    with (
        tempfile.TemporaryDirectory() as folder,
        local_service(Path(folder) / "data", port=0, log=Path(folder) / "log") as service,
        connected(service["url"], ready_within_s=60.0) as client,
    ):
        models = [client.post_document("/v1/models", path.read_text())[0] for path in list_shipped().values()]
        wanted = {"model_ids": [model["id"] for model in models]}
        small = {"variations": 20, "images_per_variation": 2, "negatives": 10}
        first = client.post("/v1/classifiers", wanted | {"settings": small})
        client.follow(first["job"])
        mesh = client.upload("/v1/meshes", SAMPLE)
        body = {"mesh_id": mesh["id"], "classifier_id": first["id"]}
        classify(client, body, 6)  # both workers are warm then
        alone = classify(client, body, options.repeats)
        with busy_cores(os.cpu_count() or 2):
            beside_busy_cores = classify(client, body, options.repeats)
        training = client.post("/v1/classifiers", wanted | {"settings": {"seed": 1}})["job"]
        sleep(15.0)  # compiling is over, drawing has begun, and the free worker has taken a part
        beside_training = classify(client, body, options.repeats)
        state = client.get(training["url"])
        parts = client.get(f"/v1/jobs?parent_id={training['id']}&limit=200")["items"]
        client.post(f"/v1/jobs/{training['id']}/cancel", {})
    document = {
        "cores": os.cpu_count(),
        "alone": alone,
        "beside_busy_cores": beside_busy_cores,
        "beside_training": beside_training,
        "training": {"state": state["state"], "progress": state["progress"], "parts": len(parts)},
        "training_over_alone": round(beside_training["work_ms"] / alone["work_ms"], 2),
        "training_over_busy_cores": round(beside_training["work_ms"] / beside_busy_cores["work_ms"], 2),
    }
    print(json.dumps(document, indent=2))


if __name__ == "__main__":
    main()
