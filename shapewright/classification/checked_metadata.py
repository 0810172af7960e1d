"""The metadata of a classifier's file, held against its graph."""

import json
from typing import Any

from shapewright.classification.evidence import KnownCurves
from shapewright.classification.file_format import FORMAT, FORMAT_VERSION, METADATA_KEY
from shapewright.classification.look import Look
from shapewright.classification.trade_off import trade_off_of
from shapewright.errors import ClassifierError
from shapewright.network.ports import IMAGES, OPEN_PROBABILITIES, PROBABILITIES


def checked_metadata(session: Any, where: str | None) -> dict[str, Any]:
    """Return what a file says about itself.

    Args:
        session: the file, loaded by ONNX Runtime.
        where: its name, for errors.

    Raises:
        ClassifierError: graph or metadata are not ours, or do not agree.
    """
    text = session.get_modelmeta().custom_metadata_map.get(METADATA_KEY)
    if text is None:
        raise ClassifierError("an ONNX file, but not a Shapewright classifier: it has no metadata of ours", where=where)
    try:
        metadata = json.loads(text)
        if metadata["format"] != FORMAT:
            raise ClassifierError(f"the format is {metadata['format']!r}, not {FORMAT!r}", where=where)
        if metadata["version"] != FORMAT_VERSION:
            raise ClassifierError(
                f"version {metadata['version']!r} of the format is not known, this library reads {FORMAT_VERSION}",
                where=where,
            )
        class_names = metadata["class_names"]
        size = _checked_look(metadata["rendering"], where).image_size
        known = (metadata["known"]["pictures"], metadata["known"]["geometry"])
        pairs = [KnownCurves.from_dict(curves) for curves in known if curves is not None]
        for geometry in (False, True):
            trade_off_of(dict(metadata["metrics"]), geometry=geometry)
        usual = metadata["usual_distances"]
        sound = (
            (usual is None or ([float(one) for one in usual] == usual and len(usual) == len(class_names)))
            and isinstance(class_names, list)
            and all(isinstance(name, str) for name in class_names)
            and all(len(one.shifts) <= len(class_names) for pair in pairs for one in (pair.whole, pair.rough))
            and all(isinstance(model["digest"], str) for model in metadata["models"])
            and isinstance(metadata["metrics"], dict)
        )
    except (ValueError, KeyError, TypeError) as error:
        raise ClassifierError(f"the metadata is damaged: {error!r}", where=where) from error
    shapes = {port.name: (port.type, list(port.shape)[1:]) for port in session.get_inputs() + session.get_outputs()}
    expected = {
        IMAGES: ("tensor(uint8)", [size, size, 3]),
        PROBABILITIES: ("tensor(float)", [len(class_names)]),
        OPEN_PROBABILITIES: ("tensor(float)", [len(class_names)]),
    }
    if not sound or any(shapes.get(name) != shape for name, shape in expected.items()):
        raise ClassifierError("the metadata does not fit the graph", where=where)
    return dict(metadata)


def _checked_look(rendering: dict[str, Any], where: str | None) -> Look:
    """Return the look that the metadata names; an error names the file, not a setting that nobody has made."""
    try:
        return Look.from_dict(rendering)
    except ClassifierError as error:
        raise ClassifierError(f"the metadata is damaged: {error}", where=where) from error
