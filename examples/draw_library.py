"""Draws docs/library.png: for each class some random variations, going round the class's models."""

import sys
from pathlib import Path

import numpy as np

from models_store.library.shipped import list_classes, load_shipped
from shapewright.modeling import compile_model
from shapewright.rendering import render_mesh, three_quarter_view

SIZE, COLUMNS = 112, 9
CLASSES = (
    "fish",
    "glass_with_stem",
    "helicopter",
    "gun",
    "table",
    "spider",
    "sword",
    "office_chair",
    "bird",
    "bicycle",
)
TARGET = Path(__file__).resolve().parent.parent / "docs" / "library.png"


def main(target: Path = TARGET) -> None:
    """Draw a row a class; the same picture each time."""
    from PIL import Image

    names = list_classes()
    rows = []
    for class_name in CLASSES:
        models = [compile_model(load_shipped(name)) for name in names[class_name]]
        rng = np.random.default_rng(11)
        meshes = [m.instance(m.random_values(rng, 1)[0]) for m in (models * COLUMNS)[:COLUMNS]]
        pictures = [render_mesh(mesh, rotation=three_quarter_view("z"), size=SIZE) for mesh in meshes]
        rows.append(np.concatenate(pictures, axis=1))
    Image.fromarray(np.concatenate(rows)).save(target, optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
