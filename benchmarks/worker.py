"""Memory of a worker and the time of its jobs, through the REST service on the embedded default.

Run ``.venv/bin/python benchmarks/worker.py``; one JSON document goes to stdout. ``overhead_s`` is what a job costs
beside its work: the time from POST to the result, less the seconds that the worker says it worked.
"""

import argparse
import json
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

from cli.client import Client, connected
from cli.local_service import local_service
from models_store.library.shipped import list_classes, list_shipped

CLASS = "glass_with_stem"
SAMPLE = Path(__file__).parents[1] / "examples" / "goblet.ply"


def resident_mb(pid: int) -> float:
    """Resident memory of a process and the children it forked, each in full, in 10^6 bytes."""
    status = Path(f"/proc/{pid}/status").read_text()
    own = next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS"))
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return round(own * 1024 / 1e6 + sum(resident_mb(int(child)) for child in children), 1)


def run(client: Client, path: str, body: dict[str, Any]) -> dict[str, float]:
    """Do one job; return how long it took and what of that was not work."""
    start = perf_counter()
    accepted = client.post(path, body)
    client.follow(accepted["job"])
    seconds = perf_counter() - start
    document = client.get(accepted["url"])
    worked = (document.get("result") or document)["seconds"]
    return {"id": accepted["id"], "seconds": round(seconds, 2), "overhead_s": round(seconds - worked, 2)}


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--variations", type=int, default=30)
    arguments = parser.parse_args()
    figures: dict[str, Any] = {"resident_mb": {}, "jobs": {}}
    with tempfile.TemporaryDirectory() as folder:
        started = perf_counter()
        with (
            local_service(Path(folder) / "data", port=0, log=Path(folder) / "log") as service,
            connected(service["url"], ready_within_s=60.0) as client,
        ):
            figures["seconds_serve_to_ready"] = round(perf_counter() - started, 2)
            memory = figures["resident_mb"]
            memory["worker_after_start"] = resident_mb(service["worker_pid"])
            paths = [list_shipped()[name] for name in list_classes()[CLASS]]
            own = [client.post_document("/v1/models", path.read_text())[0] for path in paths]
            mesh = client.upload("/v1/meshes", SAMPLE)
            query = {"mesh_id": mesh["id"], "model_id": own[0]["id"]}
            first, again = run(client, "/v1/estimations", query), run(client, "/v1/estimations", query)
            whole_class = run(client, "/v1/estimations", {"mesh_id": mesh["id"], "class_name": CLASS})
            memory["worker_after_estimations"] = resident_mb(service["worker_pid"])
            models = [client.post_document("/v1/models", path.read_text())[0] for path in list_shipped().values()]
            settings = {"variations": arguments.variations, "images_per_variation": 5}
            body: dict[str, Any] = {"model_ids": [model["id"] for model in models], "settings": settings}
            classifier = run(client, "/v1/classifiers", body)
            memory["worker_after_training"] = resident_mb(service["worker_pid"])
            query = {"mesh_id": mesh["id"], "classifier_id": classifier["id"]}
            run(client, "/v1/classifications", query)
            warm = run(client, "/v1/classifications", query)
            memory["worker_after_classification"] = resident_mb(service["worker_pid"])
            figures["jobs"] = {
                "estimate_first": first,
                "estimate_again": again,
                "estimate_class": whole_class,
                "train": classifier,
                "classify_warm": warm,
            }
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
