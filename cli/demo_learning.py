"""The step of the demo that shows learning: a class more for the ready classifier, through the REST service."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cli.console import shown_progress

if TYPE_CHECKING:
    from rich.console import Console

    from cli.client import Client

ADDED: Final = "chair"
"""A class that ships, and that the ready classifier has not learned."""


def can_add(client: "Client", classifier_id: str) -> bool:
    """Tell whether a classifier has yet to learn the class, and the service has a model of it."""
    known = client.get(f"/v1/classifiers/{classifier_id}")["class_names"]
    return ADDED not in known and any(one["name"] == ADDED for one in client.list_items("/v1/classes"))


def add_class(client: "Client", console: "Console", classifier_id: str, output: Path, seed: int) -> dict[str, Any]:
    """Ask what a variation of the class is, add the class to a classifier, and ask the new one.

    Args:
        client: of the service.
        console: where the outcome is printed.
        classifier_id: the classifier.
        output: folder for the variation's file.
        seed: of the variation.

    Returns:
        What was found, as JSON values.
    """
    file = _write_variation(output, seed)
    mesh = client.upload("/v1/meshes", file)
    before = _answer(client, mesh["id"], classifier_id, seed)
    console.print(f"   {file}, a random {ADDED}, is [bold]{before['answer']}[/]", soft_wrap=True)
    base = client.get(f"/v1/classifiers/{classifier_id}")
    models = {one["name"]: [m["id"] for m in one["models"]] for one in client.list_items("/v1/classes")}
    others = {name: ids for name, ids in models.items() if name not in base["class_names"] and name != ADDED}
    started_s = time.monotonic()
    body = {
        "name": f"{base['name']} and {ADDED}",
        "base_classifier_id": classifier_id,
        "model_ids": models[ADDED],
        "negative_model_ids": [model for ids in others.values() for model in ids],
    }
    accepted = client.post("/v1/classifiers", body)
    with shown_progress("   learning") as progress:
        client.follow(accepted["job"], progress)
    learning_s = time.monotonic() - started_s
    extended = client.get(accepted["url"])
    after = _answer(client, mesh["id"], extended["id"], seed)
    metrics = extended["metrics"]
    count = len(models[ADDED])
    console.print(
        f"   learned from {count} procedural model{'' if count == 1 else 's'} in {learning_s:.0f} s; "
        f"the same mesh is now [bold]{after['answer']}[/]"
    )
    console.print(
        f"   right among held-out variations: {ADDED} {metrics['new_accuracy']:.0%}, "
        f"other classes {metrics['known_accuracy']:.0%} (before: {metrics['known_accuracy_before']:.0%})"
    )
    return {
        "class_name": ADDED,
        "classifier_id": extended["id"],
        "before": before,
        "after": after,
        **{name: metrics[name] for name in ("new_accuracy", "known_accuracy", "known_accuracy_before")},
        "seconds": learning_s,
    }


def _write_variation(output: Path, seed: int) -> Path:
    """Write a random instance of a shipped model of the class as a mesh file."""
    import numpy as np

    from cli.sources import load_class

    model = load_class(ADDED)[0]
    file = output / f"{ADDED}.ply"
    values = model.random_values(np.random.default_rng(seed), 1)
    model.instance(values[0]).save(file)
    return file


def _answer(client: "Client", mesh_id: str, classifier_id: str, seed: int) -> dict[str, Any]:
    body = {"mesh_id": mesh_id, "classifier_id": classifier_id, "seed": seed}
    accepted = client.post("/v1/classifications", body)
    client.follow(accepted["job"])
    result = client.get(accepted["url"])["result"]
    return {name: result[name] for name in ("answer", "class_name", "known")}
