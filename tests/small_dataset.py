"""A dataset made by code: boxes and posts in arbitrary poses, an `other`, and files that cannot be read."""

import csv
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from simple_shapes import box

from shapewright.modeling import CompiledModel, ProceduralModel, Recorder, group


def slab() -> ProceduralModel:
    """A flat box of any width."""
    recorder = Recorder("slab", "slab")
    recorder.parameter("width", "Width", 0.5, 2.0)
    plate = recorder.box(1.0, 1.0, 0.2)
    recorder.mark_sharp(*plate.faces)
    recorder.scale(group(plate.whole, frame="world"), 1.0, "u", size="width")
    return recorder.build()


def rod() -> ProceduralModel:
    """A rod of any length on a foot."""
    recorder = Recorder("rod", "rod")
    recorder.parameter("length", "Length", 0.5, 2.0)
    foot = recorder.box(1.0, 1.0, 0.3)
    recorder.extrude(foot.top, 0.05)
    recorder.scale(foot.top, 0.3)
    recorder.extrude(foot.top, 2.0, length="length")
    return recorder.build()


def bent_rod() -> ProceduralModel:
    """Another model of the class of rods: without a foot."""
    recorder = Recorder("rod_bent", "rod")
    recorder.parameter("length", "Length", 0.5, 2.0)
    lower = recorder.box(0.3, 0.3, 1.0)
    recorder.mark_sharp(*lower.faces)
    recorder.extrude(lower.top, 1.0, rho=0.5, length="length")
    return recorder.build()


def write_dataset(folder: Path, models: list[tuple[CompiledModel, int]], seed: int = 5) -> list[str]:
    """Write random, turned instances of the models as OFF files, and what must be left out; return the good files."""
    rng = np.random.default_rng(seed)
    meshes = folder / "meshes"
    meshes.mkdir(parents=True)
    rows = []
    for compiled, count in models:
        for number, values in enumerate(compiled.random_values(rng, count)):
            turn = Rotation.random(rng=rng).as_matrix()
            mesh = compiled.instance(values).transformed(turn, rng.normal(size=3), rng.uniform(0.1, 10.0))
            name = f"{compiled.model.name}{number}.off"
            mesh.save(meshes / name)
            rows.append((name, compiled.model.class_name))
    good = [file for file, _ in rows]
    box().save(meshes / "cube.off")
    (meshes / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n")
    with (folder / "labels.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["file", "class", "faces"])
        writer.writerows((*row, 12) for row in rows)
        writer.writerows([("cube.off", "other", 1), ("broken.off", "slab", 1), ("missing.off", "slab", 1)])
    return good
