"""The backbone in 8 bits says nearly what the one in floating point says, and takes bytes as they are."""

import json
from importlib import resources
from pathlib import Path

import numpy as np
import onnx
import pytest
import simple_shapes

from shapewright.classification import FeatureExtractor, features, load_backbone
from shapewright.classification.backbone import RANGES_FILE, efficientnet_lite0_layers
from shapewright.classification.quantized_graph import quantized_features_graph, range_names
from shapewright.rendering import random_views, render_images


@pytest.fixture(scope="module")
def ranges() -> dict[str, tuple[float, float]]:
    text = resources.files("shapewright.classification").joinpath(RANGES_FILE).read_text(encoding="utf-8")
    return {name: (low, high) for name, (low, high) in json.loads(text).items()}


def test_both_graphs_agree_on_drawn_pictures() -> None:
    rotations, scales = random_views(np.random.default_rng(0), 12, scale_range=(0.7, 1.0))
    meshes = [simple_shapes.goblet(), simple_shapes.stool(), simple_shapes.crossing_sheets()]
    pictures = render_images(
        meshes,
        None,
        rotations,
        scales,
        objects=np.repeat(np.arange(3), 4),
        style="fused",
        framing="sphere",
        window=1.0,
    )
    exact = FeatureExtractor(load_backbone("efficientnet_lite0"))(pictures)
    whole = FeatureExtractor(load_backbone("efficientnet_lite0_int8"))(pictures)
    alike = [np.corrcoef(one, other)[0, 1] for one, other in zip(exact, whole, strict=True)]
    assert np.mean(alike) > 0.96
    assert min(alike) > 0.93, "bare sheets are the worst"
    others = [np.corrcoef(one, other)[0, 1] for one, other in zip(exact, np.roll(whole, 4, axis=0), strict=True)]
    assert max(others) < min(alike), "another object is never as near"
    middle = exact.mean(axis=0)
    assert np.corrcoef((exact - middle).ravel(), (whole - middle).ravel())[0, 1] > 0.95, (
        "what tells pictures apart, too"
    )


def test_processors_without_vnni_count_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forced onto the slow way, which this machine may not need."""
    pictures = np.random.default_rng(0).integers(0, 256, (2, 224, 224, 3), dtype=np.uint8)
    expected = FeatureExtractor(load_backbone("efficientnet_lite0_int8"))(pictures)
    monkeypatch.setattr(features, "_integers_are_precise", lambda: False)
    np.testing.assert_array_equal(FeatureExtractor(load_backbone("efficientnet_lite0_int8"))(pictures), expected)


@pytest.mark.parametrize(
    ("machine", "facts", "precise"),
    [
        ("aarch64", None, True),
        ("x86_64", "flags: avx2", False),
        ("AMD64", None, False),
        ("x86_64", "avx512_vnni", True),
    ],
)
def test_it_is_known_which_processors_need_the_slow_way(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, machine: str, facts: str | None, precise: bool
) -> None:
    monkeypatch.setattr("platform.machine", lambda: machine)
    if facts is not None:
        (tmp_path / "cpuinfo").write_text(facts)
    assert features._integers_are_precise.__wrapped__(tmp_path / "cpuinfo") is precise


def test_pictures_are_not_converted() -> None:
    graph = onnx.load_model_from_string(load_backbone("efficientnet_lite0_int8").graph).graph
    assert graph.input[0].type.tensor_type.elem_type == onnx.TensorProto.UINT8
    assert "Cast" not in {node.op_type for node in graph.node}
    assert {node.op_type for node in graph.node if graph.input[0].name in node.input} == {"Transpose"}
    convolutions = [node for node in graph.node if node.op_type == "Conv"]
    made = {node.output[0]: node.op_type for node in graph.node}
    assert all(made[name] == "DequantizeLinear" for node in convolutions for name in node.input)


def test_the_ranges_are_those_of_the_float_graph(ranges) -> None:
    layers, _ = efficientnet_lite0_layers()
    assert list(ranges) == range_names(layers)
    made = {
        name
        for node in onnx.load_model_from_string(load_backbone("efficientnet_lite0").graph).graph.node
        for name in node.output
    }
    assert set(ranges) <= made
    assert all(low < high for low, high in ranges.values())


def test_every_constant_is_finite_and_the_graph_repeats(ranges) -> None:
    layers, _ = efficientnet_lite0_layers()
    first, again = (
        quantized_features_graph(layers, ranges, pixel_mean=127.0, pixel_scale=128.0).SerializeToString(
            deterministic=True
        )
        for _ in range(2)
    )
    assert first == again
    for tensor in onnx.load_model_from_string(first).graph.initializer:
        values = onnx.numpy_helper.to_array(tensor)
        assert np.isfinite(values.astype(np.float64)).all()
        if tensor.name.endswith("_scale"):
            assert np.all(values > 0)
    assert len(first) < 0.35 * len(load_backbone("efficientnet_lite0").graph)
