"""Annotations: what a person says about the operations of a model before any algorithm does.

A model's ``annotations.json`` is the ground truth for automatic parameter insertion (paper, sections 3.1 and 4.1):
which variations of Table 1 are important, and which belong together. The person who models says so beside the
modelling call (:class:`AnnotatingRecorder`), from looking at the object; no measure takes part. The document::

    {"format": "shapewright-annotations", "version": 1, "model": "stool", "annotator": "...", "notes": "...",
     "judgements": [{"operation": 1, "mode": "size", "label": "seat diameter", "important": true}, ...],
     "groups": [{"label": "leg length", "members": [{"operation": 6, "mode": "length"}, ...]}, ...]}

``operation`` is an index into the model's list, ``mode`` how an inserted parameter acts on it. There is one judgement
for each variation that :func:`variations_of` lists, in that order. A variation is important if changing it, together
with its group, makes a visibly other object of the same class. A group holds at least two variations of one kind of
operation, and shares none with another: a parameter for one of them should vary all. An operation of an optional part
is judged on an object that has the part, which the base object need not.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from models_store.library.author import publish
from shapewright.errors import ModelError
from shapewright.modeling import ProceduralModel, Recorder
from shapewright.modeling.operations import (
    Drag,
    Extrude,
    InsertVertex,
    Operation,
    Rotate,
    RotationExtrude,
    Scale,
)

ANNOTATIONS = "annotations.json"
FORMAT, VERSION = "shapewright-annotations", 1
ANNOTATOR = "the modeller of the object, by eye, before any importance measure existed"
NOTES = (
    "Important means: varied with its group, a person sees another object of the class. Directions of extrusions are"
    " not called important where they would turn left and right the same way."
)
SIDEWAYS = 0.15  # Table 1 varies the direction of an extrusion with rho > 0.15 z


@dataclass(frozen=True, order=True)
class Variation:
    """One way to vary one operation."""

    operation: int
    mode: str


@dataclass(frozen=True)
class Judgement:
    """What a person says about a variation; ``label`` names what it changes."""

    variation: Variation
    label: str
    important: bool


@dataclass(frozen=True)
class Group:
    """Variations that one parameter should carry out together."""

    label: str
    members: tuple[Variation, ...]


@dataclass(frozen=True)
class Annotation:
    """The ground truth for one model."""

    model: str
    judgements: tuple[Judgement, ...]
    groups: tuple[Group, ...]
    annotator: str = ANNOTATOR
    notes: str = NOTES

    @property
    def important(self) -> frozenset[Variation]:
        """The variations that a person calls important."""
        return frozenset(j.variation for j in self.judgements if j.important)

    def check(self, model: ProceduralModel) -> None:
        """Hold the annotation against its model.

        Raises:
            ModelError: it is about another model; a variation is missing, unknown or judged twice; a group has
                fewer than two members, unequal ones, or one that another group has too.
        """
        if self.model != model.name:
            raise ModelError(f"the annotation is of {self.model!r}, not of {model.name!r}")
        expected = variations_of(model.operations)
        known = set(expected)
        judged = [judgement.variation for judgement in self.judgements]
        for variation in judged:
            if variation not in known:
                raise ModelError(f"operation {variation.operation} has no {variation.mode!r} to judge")
        if judged != expected:
            raise ModelError("the judgements are not one for each variation, in order")
        seen: set[Variation] = set()
        for group in self.groups:
            members = set(group.members)
            if len(members) < 2 or len(members) < len(group.members):
                raise ModelError(f"the group {group.label!r} needs at least two members, each once")
            if not members <= known:
                raise ModelError(f"the group {group.label!r} has a member that is not judged")
            if len({(model.operations[m.operation].kind, m.mode) for m in members}) > 1:
                raise ModelError(f"the members of {group.label!r} are of different kinds")
            if members & seen:
                raise ModelError(f"the group {group.label!r} shares a member with another")
            seen |= members

    @classmethod
    def from_json(cls, text: str | bytes) -> "Annotation":
        """Read a document.

        Raises:
            ModelError: the text is not a document of this format and version.
        """
        try:
            document = json.loads(text)
            if (document["format"], document["version"]) != (FORMAT, VERSION):
                raise ModelError(f"not a document of {FORMAT!r}, version {VERSION}")
            return cls(
                model=str(document["model"]),
                judgements=tuple(_read_judgement(item) for item in document["judgements"]),
                groups=tuple(
                    Group(str(item["label"]), tuple(_read_variation(member) for member in item["members"]))
                    for item in document["groups"]
                ),
                annotator=str(document["annotator"]),
                notes=str(document["notes"]),
            )
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise ModelError(f"not an annotation: {error!r}") from None

    def to_json(self) -> str:
        """Return the document, one judgement or group a line."""
        head = {"format": FORMAT, "version": VERSION, "model": self.model}
        head |= {"annotator": self.annotator, "notes": self.notes}
        judgements = [{**_written(j.variation), "label": j.label, "important": j.important} for j in self.judgements]
        groups = [{"label": g.label, "members": [_written(member) for member in g.members]} for g in self.groups]
        lines = [f"  {json.dumps(name)}: {json.dumps(value)}," for name, value in head.items()]
        for name, items, end in (("judgements", judgements, ","), ("groups", groups, "")):
            lines += [f'  "{name}": [', ",\n".join(f"    {json.dumps(item)}" for item in items), f"  ]{end}"]
        return "\n".join(["{", *lines, "}", ""])


class AnnotatingRecorder(Recorder):
    """A recorder in which the person who models says what each operation means.

    :meth:`judge` is a heading: it holds for all operations until the next one. Variations of one kind of operation
    under the same label belong together.
    """

    def __init__(
        self, name: str, class_name: str, *, description: str = "", closed: bool = True, unit_m: float | None = None
    ) -> None:
        super().__init__(name, class_name, description=description, closed=closed, unit_m=unit_m)
        self._heading: Mapping[str, tuple[str, bool]] = {}
        self._judgements: list[Judgement] = []

    def judge(self, label: str, *, important: bool, direction: str = "", direction_important: bool = False) -> None:
        """Say what the following operations change, and whether that is worth a parameter.

        Args:
            direction: the label for the angle of extrusions to the side, which is a variation of its own.
        """
        self._heading = {"": (label, important)}
        if direction:
            self._heading = {**self._heading, "angle": (direction, direction_important)}

    def annotation(self) -> Annotation:
        """Return the annotation of everything recorded; labels that occur more than once become groups."""
        alike: dict[tuple[str, str, str], list[Variation]] = {}
        for judgement in self._judgements:
            variation = judgement.variation
            kind = self._operations[variation.operation].kind
            alike.setdefault((judgement.label, kind, variation.mode), []).append(variation)
        groups = tuple(Group(label, tuple(members)) for (label, _, _), members in alike.items() if len(members) > 1)
        return Annotation(self.name, tuple(self._judgements), groups)

    def _do(self, operation: Operation, varies: dict[str, str]) -> None:
        super()._do(operation, varies)
        index = len(self._operations) - 1
        for mode in _modes_to_judge(operation):
            # A rotation's only mode is called angle too; it is what its heading says.
            key = "angle" if mode == "angle" and isinstance(operation, Extrude) else ""
            if key not in self._heading:
                raise ModelError(f"operation {index} ({operation.kind}): nobody says what its {mode} means")
            label, important = self._heading[key]
            self._judgements.append(Judgement(Variation(index, mode), label, important))


def publish_annotated(recorder: AnnotatingRecorder, folder: Path) -> None:
    """Write the model, its picture and ``annotations.json``; raises what :func:`publish` raises, and ModelError."""
    model = recorder.build()
    annotation = recorder.annotation()
    annotation.check(model)
    (folder / ANNOTATIONS).write_text(annotation.to_json(), encoding="utf-8")
    publish(model, folder)


def variations_of(operations: tuple[Operation, ...]) -> list[Variation]:
    """Return every variation of Table 1 that changes something, in the order of the operations."""
    return [Variation(index, mode) for index, operation in enumerate(operations) for mode in _modes_to_judge(operation)]


def _modes_to_judge(operation: Operation) -> tuple[str, ...]:
    match operation:
        case Extrude(z=z, rho=rho):
            moves = ("length",) if z or rho else ()
            return (*moves, "angle") if abs(rho) > SIDEWAYS * abs(z) else moves
        case Drag(z=z, rho=rho):
            return ("length",) if z or rho else ()
        case Rotate(alpha_deg=alpha_deg):
            return ("angle",) if alpha_deg else ()
        case RotationExtrude():
            return ("length", "width")
        case Scale() | InsertVertex():
            return tuple(operation.modes)
    return ()


def _written(variation: Variation) -> dict[str, Any]:
    return {"operation": variation.operation, "mode": variation.mode}


def _read_variation(item: Mapping[str, Any]) -> Variation:
    operation, mode = item["operation"], item["mode"]
    if type(operation) is not int or type(mode) is not str:
        raise TypeError("an operation's index and a mode's name are needed")
    return Variation(operation, mode)


def _read_judgement(item: Mapping[str, Any]) -> Judgement:
    if type(item["important"]) is not bool:
        raise TypeError("important is true or false")
    return Judgement(_read_variation(item), str(item["label"]), item["important"])
