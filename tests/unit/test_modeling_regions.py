"""Regions of a model: what its optional parts and other components are called, and where they are on the surface."""

import chair_model
import numpy as np
import pytest

from shapewright.modeling import Recorder, compile_model
from shapewright.modeling.regions import find_regions


def test_regions_are_parts_and_what_their_parameters_measure():
    regions = find_regions(chair_model.armchair())
    assert regions.names == ("low back", "high back", "armrests", "component 0", "Leg", "Ring")
    assert regions.of_component.tolist() == [3, 4, 5, 0, 1, 2, 2]


def test_a_region_covers_what_its_part_adds():
    model = chair_model.armchair()
    compiled, regions = compile_model(model), find_regions(model)
    values = compiled.values_from_mapping({"armrests": 1, "back": 3})
    for steps in range(3):
        instance = compiled.instance(values, steps)
        of_vertex = regions.of_instance(compiled, values, steps)
        assert len(of_vertex) == len(instance.vertices)
        assert {regions.names[number] for number in set(of_vertex.tolist())} == {
            "armrests",
            "component 0",
            "Leg",
            "Ring",
        }
        arms = instance.vertices[of_vertex == regions.names.index("armrests")]
        assert (np.abs(arms[:, 1]) > 0.35).all()
        assert (of_vertex[instance.faces] == of_vertex[instance.faces[:, :1]]).all(), "no face joins two components"


def test_parts_with_one_name_before_a_colon_are_one_region():
    recorder = Recorder("rotor", "helicopter")
    recorder.choice("rotor", "Rotor", ("blades", "disc"))
    hub = recorder.box(1.0, 1.0, 1.0)
    parts = [recorder.box(4.0, 0.2, 0.1, anchor=hub.top), recorder.box(4.0, 4.0, 0.1, anchor=hub.top)]
    for number, (name, part) in enumerate(zip(("blades", "disc"), parts, strict=True), 1):
        recorder.part(f"Rotor: {name}", [part], [chair_model.when("rotor", number)])
    assert find_regions(recorder.build()).names == ("Rotor", "component 0")


@pytest.mark.parametrize("name", ["helicopter", "office_chair", "spider", "glass_with_stem"])
def test_names_of_shipped_models_are_told_apart(library_models, name):
    model = library_models[name]
    compiled, regions = compile_model(model), find_regions(model)
    assert len(set(regions.names)) == len(regions.names)
    assert len(regions.of_component) == compiled.control_components.max() + 1
    values = compiled.random_values(np.random.default_rng(0), 1)[0]
    assert len(regions.of_instance(compiled, values)) == len(compiled.instance(values).vertices)
