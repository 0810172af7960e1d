"""What a shell prints of an estimation, read from its JSON document."""

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from cli.report import STATUS_TEXTS, parameter_table

if TYPE_CHECKING:
    from rich.console import Console

LAYERS = {
    1: "The proportions are those of the nearest instance, but its surface does not lie close enough to the mesh.",
    2: "The surfaces lie close together, but seen from all sides the two differ more than they should.",
    3: "The fit looks like the mesh from all sides.",
}
EXPLANATIONS = {
    "determined": "the mesh says what it is",
    "determined_up_to_scale": "certain in proportion to other lengths; with --units the lengths themselves are",
    "not_determined": "other values would fit about as well",
    "at_range_end": "as far as the model allows; the mesh may ask for more",
}
THRESHOLDS = {"surface": "surface distance", "zbuffer": "z-buffer distance"}
MOST_RATIOS = 8
MOST_PARTS = 4
NOTICED_SHARE = 0.05
"""Of a part's area that is not in the mesh; less is not worth a word."""


def print_estimation(console: "Console", document: Mapping[str, Any], *, seconds: float) -> None:
    """Print the answer of an estimation for people.

    Args:
        console: where to.
        document: what :meth:`shapewright.estimation.Estimation.to_dict` says, or the result of the service.
        seconds: how long it took.
    """
    name = document["model"]["name"]
    if not document["complete"]:
        console.print("[yellow]The search was stopped before its end. This is the best that it had found.[/]")
    console.print(f"[bold]{name}[/] rebuilds the mesh with these parameters:")
    console.print(parameter_table(document["parameters"], width=console.width))
    for lines in (_explanations, _ratios, _combinations, _alternatives, _tried, _verdict):
        for line in lines(document):
            console.print(line)
    distances = document["distances"]
    console.print(
        f"Distances: panorama {distances['panorama']:.4g}, surface {distances['surface']:.4g}, "
        f"z-buffer {distances['zbuffer']:.4g}. {seconds:.1f} s with the {document['estimator']} estimator."
    )


def _explanations(document: Mapping[str, Any]) -> Iterator[str]:
    statuses = {parameter.get("status") for parameter in document["parameters"] if parameter["active"]}
    for status, explanation in EXPLANATIONS.items():
        if status in statuses:
            yield f"[dim]  {STATUS_TEXTS[status]}: {explanation}.[/]"


def _ratios(document: Mapping[str, Any]) -> Iterator[str]:
    ratios = document["ratios"]
    if ratios:
        yield "Ratios, which hold whatever the size of the mesh:"
    for ratio in ratios[:MOST_RATIOS]:
        yield f"  {ratio['label']} = {ratio['value']:.3g}{_interval(ratio['interval'])}"
    if len(ratios) > MOST_RATIOS:
        yield f"  and {len(ratios) - MOST_RATIOS} more, see --json"


def _combinations(document: Mapping[str, Any]) -> Iterator[str]:
    for combination in document["combinations"]:
        yield f"Known together, though not each alone: {combination['label']}"


def _alternatives(document: Mapping[str, Any]) -> Iterator[str]:
    if document["alternatives"]:
        yield "Other answers that fit nearly as well:"
    for number, other in enumerate(document["alternatives"], start=1):
        yield f"  {number}. {other['label']}, z-buffer distance {other['distances']['zbuffer']:.3g}"


def _tried(document: Mapping[str, Any]) -> Iterator[str]:
    if len(document["tried"]) < 2:
        return
    fitted = [_nearness(one) for one in document["tried"] if one["distances"] is not None]
    others = [one["model"]["name"] for one in document["tried"] if one["distances"] is None]
    yield f"Models fitted, best first: {', '.join(fitted)}."
    if others:
        reason = "as others were nearer" if document["complete"] else "as others were nearer or their turn had not come"
        yield f"Not fitted, {reason}: {', '.join(others)}."


def _nearness(tried: Mapping[str, Any]) -> str:
    return f"{tried['model']['name']} (z-buffer {tried['distances']['zbuffer']:.3g})"


def _verdict(document: Mapping[str, Any]) -> Iterator[str]:
    layer, verdict = document["layer"], document["verdict"]
    if layer < 3 and not document["complete"] and not (verdict and verdict["failed"]):
        yield f"[bold]Layer {layer} of 3.[/] The search had not come to the layers above."
    else:
        yield f"[bold]Layer {layer} of 3.[/] {LAYERS[layer]}"
    for failed in verdict["failed"] if verdict else ():
        name, value, threshold = THRESHOLDS[failed["name"]], failed["value"], failed["threshold"]
        yield f"  The {name} is {value:.3g}; it should be below {threshold:g}."
    residuals = verdict["residuals"] if verdict else None
    if residuals:
        yield (
            f"The model follows {_share(residuals['followed_share'])} of the mesh; "
            f"{_share(residuals['invented_share'])} of the fit is not in the mesh."
        )
        yield from _invented(residuals["by_part"])


def _invented(parts: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    worst = sorted(parts, key=lambda part: -part["share_of_area"] * part["invented_share"])
    noticed = [part for part in worst if part["invented_share"] >= NOTICED_SHARE][:MOST_PARTS]
    if noticed:
        listed = ", ".join(f"{part['name']} ({_share(part['invented_share'])} of it)" for part in noticed)
        yield f"  Parts that are not: {listed}."


def _share(fraction: float) -> str:
    """Whole percents; what is nearly all or nearly nothing is not rounded to it."""
    if 0 < fraction < 0.005:
        return "less than 1 %"
    return "more than 99 %" if 0.995 < fraction < 1 else f"{100 * fraction:.0f} %"


def _interval(interval: list[float] | None) -> str:
    return "" if interval is None else f" (90 %: {interval[0]:.3g} … {interval[1]:.3g})"
