"""Indexing a collection and ranking it: what is found first, and what must hold of every ranking."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fake_classifier import ExtentClassifier
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from simple_shapes import box
from small_dataset import rod, slab

from shapewright.classification import gather_instances, instances_of_each
from shapewright.distances.panorama import DESCRIPTOR_SIZE, panorama_descriptor, panorama_distance
from shapewright.errors import Cancelled, ClassifierError
from shapewright.estimation import build_bank
from shapewright.mapped_arrays import read_header, write_arrays
from shapewright.mesh import TriangleMesh
from shapewright.modeling import compile_model
from shapewright.progress import CallbackProgress
from shapewright.retrieval import ClassQuery, CollectionIndex, MeshQuery, index_meshes, look_at, rank
from shapewright.retrieval.indexing import index_chunks
from shapewright.retrieval.ranking import combined_scores

DIGEST = "d" * 64
FLAT = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]]), np.array([[0, 1, 2]]))
"""No area."""


def collection() -> Iterator[tuple[str, TriangleMesh | str]]:
    yield "long", box((0.2, 0.2, 3.0))
    yield "broken", "the file is truncated"
    yield "flat", box((2.0, 2.0, 0.2))
    yield "line", FLAT
    yield "longer", box((0.2, 0.2, 5.0))
    yield "wide", box((3.0, 2.5, 0.2))
    yield "cube", box()


@pytest.fixture(scope="module")
def index() -> CollectionIndex:
    return index_meshes(collection(), ExtentClassifier(), DIGEST, total=7).index


def names(ranked) -> list[str]:
    return [one.name for one in ranked]


def test_what_cannot_be_looked_at_is_listed_with_the_reason() -> None:
    reports: list[tuple[float, str]] = []
    indexed = index_meshes(
        collection(),
        ExtentClassifier(),
        DIGEST,
        total=7,
        progress=CallbackProgress(lambda fraction, message: reports.append((fraction, message))),
    )
    assert indexed.index.names == ("long", "flat", "longer", "wide", "cube")
    assert [skipped.name for skipped in indexed.skipped] == ["broken", "line"]
    assert indexed.skipped[0].reason == "the file is truncated"
    assert "area" in indexed.skipped[1].reason
    fractions = [fraction for fraction, _ in reports]
    assert fractions == sorted(fractions)
    assert reports[-1] == (1.0, "meshes: 7 of 7")
    assert len(reports) == 8


def test_rows_hold_what_is_said_of_each_mesh(index: CollectionIndex) -> None:
    assert index.class_names == ("rod", "slab")
    wide = dict(collection())["wide"]
    facts = look_at(wide, ExtentClassifier())
    row = index.names.index("wide")
    np.testing.assert_allclose(index.probabilities[row], [facts.probabilities[name] for name in index.class_names])
    np.testing.assert_array_equal(index.descriptors[row], panorama_descriptor(wide.vertices, wide.faces).to_array())
    assert index.known[row] == facts.known == 0.75, "what the classifier said"


def test_what_was_indexed_before_a_cancellation_is_there() -> None:
    many = [(f"box{number:02}", box((1, 1, 1 + number))) for number in range(20)]

    def cancel(fraction: float, message: str) -> None:
        if fraction > 0.85:
            raise Cancelled

    chunks = index_chunks(many, ExtentClassifier(), DIGEST, total=20, progress=CallbackProgress(cancel))
    assert len(next(chunks).index) == 16
    with pytest.raises(Cancelled):
        next(chunks)


def test_an_index_survives_a_file(index: CollectionIndex, tmp_path: Path) -> None:
    path = tmp_path / "index.npz"
    index.save(path)
    for memory_map in (True, False):
        loaded = CollectionIndex.load(path, memory_map=memory_map)
        assert (loaded.names, loaded.class_names, loaded.classifier_digest) == (index.names, index.class_names, DIGEST)
        assert isinstance(loaded.descriptors, np.memmap) == memory_map
        for name in ("probabilities", "picture_probabilities", "known", "descriptors"):
            np.testing.assert_array_equal(getattr(loaded, name), getattr(index, name))
    nothing = CollectionIndex.empty(index.class_names, DIGEST)
    nothing.save(path)
    assert len(CollectionIndex.load(path)) == 0
    assert rank(CollectionIndex.load(path), ClassQuery("rod"), "probabilities") == []


def test_damaged_and_foreign_files_are_refused(index: CollectionIndex, tmp_path: Path) -> None:
    path = tmp_path / "index.npz"
    index.save(path)
    data = path.read_bytes()
    for content in (b"", data[: len(data) // 2], b"no archive" * 50):
        path.write_bytes(content)
        with pytest.raises(ClassifierError, match="no index"):
            CollectionIndex.load(path)
    build_bank(compile_model(slab()), 2).save(path)
    with pytest.raises(ClassifierError, match="no index"):
        CollectionIndex.load(path)
    with pytest.raises(FileNotFoundError):
        CollectionIndex.load(tmp_path / "nowhere.npz")


def test_an_index_of_another_descriptor_is_refused(index: CollectionIndex, tmp_path: Path) -> None:
    path = tmp_path / "index.npz"
    index.save(path)
    header = read_header(path)
    names = ("probabilities", "picture_probabilities", "known", "descriptors")
    arrays = {name: getattr(index, name) for name in names}
    write_arrays(path, {**header, "descriptor_version": header["descriptor_version"] + 1}, arrays)
    with pytest.raises(ClassifierError, match="version of the descriptor"):
        CollectionIndex.load(path)


def test_an_index_of_another_classifier_does_not_fit(index: CollectionIndex) -> None:
    index.check_fits(("rod", "slab"), DIGEST)
    for class_names, digest in ((("rod", "slab"), "e" * 64), (("slab", "rod"), DIGEST)):
        with pytest.raises(ClassifierError, match="another classifier"):
            index.check_fits(class_names, digest)
    with pytest.raises(ClassifierError, match="another classifier"):
        index.joined(CollectionIndex.empty(("rod", "slab"), "e" * 64))


def test_indexes_are_cut_and_joined_by_name(index: CollectionIndex) -> None:
    first, rest = index.taken([2, 0]), index.taken([0, 1, 3, 4])
    assert first.names == ("longer", "long")
    whole = first.joined(rest)
    assert whole.names == ("longer", "long", "flat", "wide", "cube")
    assert whole.rows_of(["wide", "nowhere", "long"]) == {"wide": 3, "long": 1}
    for name, row in whole.rows_of(index.names).items():
        np.testing.assert_array_equal(whole.descriptors[row], index.descriptors[index.names.index(name)])
        np.testing.assert_array_equal(whole.probabilities[row], index.probabilities[index.names.index(name)])
    assert index.taken([4, 4], ["a", "b"]).names == ("a", "b")
    with pytest.raises(ClassifierError, match="twice"):
        index.taken([4, 4])


@pytest.fixture(scope="module")
def exemplars() -> dict[str, np.ndarray]:
    def banks(compiled, progress):
        return build_bank(compiled, 30, np.random.default_rng(0), progress)

    return {model.class_name: gather_instances([compile_model(model)], banks) for model in (rod(), slab())}


@pytest.mark.parametrize("evidence", ["probabilities", "panorama", "combined"])
def test_a_class_finds_its_meshes_first(index: CollectionIndex, exemplars, evidence) -> None:
    flat_first = rank(index, ClassQuery("slab", exemplars["slab"]), evidence)
    assert set(names(flat_first)[:2]) == {"flat", "wide"}
    assert sorted(names(flat_first)) == sorted(index.names)
    long_first = rank(index, ClassQuery("rod", exemplars["rod"]), evidence)
    assert set(names(long_first)[:2]) == {"long", "longer"}
    for one in flat_first:
        assert index.names[one.row] == one.name
        assert (one.probability is None) == (evidence == "panorama")
        assert (one.distance is None) == (evidence == "probabilities")


def test_the_distance_is_that_to_the_nearest_exemplar(index: CollectionIndex, exemplars) -> None:
    from shapewright.distances.panorama import PanoramaDescriptor

    chosen = exemplars["slab"]
    for some in (chosen[:1], chosen[:3], chosen):  # fewer and more than there are meshes
        for one in rank(index, ClassQuery(None, some), "panorama"):
            mesh = PanoramaDescriptor.from_array(index.descriptors[one.row])
            nearest = min(panorama_distance(PanoramaDescriptor.from_array(row), mesh) for row in some)
            assert one.distance == pytest.approx(nearest, abs=1e-6)
            assert one.score == -one.distance


def test_a_base_instance_alone_is_the_papers_comparison(exemplars) -> None:
    (base,) = gather_instances([compile_model(slab())], None)
    np.testing.assert_array_equal(base, exemplars["slab"][0])
    mesh = compile_model(slab()).instance(np.ones(1))
    np.testing.assert_array_equal(base, panorama_descriptor(mesh.vertices, mesh.faces).to_array())


@pytest.mark.parametrize("evidence", ["probabilities", "panorama", "combined"])
def test_a_mesh_finds_itself_or_its_like_first(index: CollectionIndex, evidence) -> None:
    row = index.names.index("longer")
    ranked = rank(index, MeshQuery.of(index, row), evidence)
    facts = look_at(dict(collection())["longer"], ExtentClassifier())  # type: ignore[arg-type]
    again = rank(index, facts.as_query(index.class_names), evidence)
    assert names(again) == names(ranked)
    np.testing.assert_allclose([one.score for one in again], [one.score for one in ranked], atol=1e-6)
    assert set(names(ranked)[:2]) == {"long", "longer"}
    if evidence == "panorama":
        assert ranked[0].name == "longer"
        assert ranked[0].distance == pytest.approx(0, abs=1e-6)


def test_a_mesh_that_is_of_no_class_comes_last(index: CollectionIndex) -> None:
    known = index.known.copy()
    known[index.names.index("wide")] = 0.0
    doubted = CollectionIndex(
        index.names, index.class_names, DIGEST, index.probabilities, index.picture_probabilities, known,
        index.descriptors,
    )  # fmt: skip
    assert names(rank(doubted, ClassQuery("slab"), "probabilities"))[0] == "flat"
    assert rank(doubted, ClassQuery("slab"), "probabilities")[-1].score == 0.0


def test_what_cannot_be_ranked_is_said(index: CollectionIndex) -> None:
    for evidence in ("panorama", "combined"):
        with pytest.raises(ClassifierError, match="instances of a model"):
            rank(index, ClassQuery("slab"), evidence)
    with pytest.raises(ClassifierError, match="does not know 'teapot'"):
        rank(index, ClassQuery("teapot"), "probabilities")
    with pytest.raises(ClassifierError, match="need a model"):
        gather_instances([], None)
    with pytest.raises(ClassifierError, match="not negative"):
        instances_of_each([compile_model(slab())], -1)
    assert [instances_of_each([compile_model(slab())] * models, 500) for models in (1, 3)] == [500, 167]


SHARES = st.floats(0.0, 1.0)


@given(st.lists(SHARES, min_size=1, max_size=20))
def test_equal_scores_are_in_the_order_of_names(shares: list[float]) -> None:
    rows = np.array([[share, 1 - share] for share in shares], dtype=np.float32).round(1)
    labels = tuple(f"m{(7 * number) % 23:02}" for number in range(len(shares)))
    zeros = np.zeros((len(shares), DESCRIPTOR_SIZE), np.float32)
    index = CollectionIndex(labels, ("a", "b"), DIGEST, rows, rows, np.ones(len(shares), np.float32), zeros)
    found = rank(index, ClassQuery("a"), "probabilities")
    assert [(-one.score, one.name) for one in found] == sorted((-one.score, one.name) for one in found)


@given(
    arrays.arrays(np.float64, 8, elements=st.floats(0, 1)),
    arrays.arrays(np.float64, 8, elements=st.integers(0, 40).map(lambda n: n / 16)),
    st.sampled_from([0.25, 1.0, 2.0, 16.0]),
    st.sampled_from([0.0, 1.0, 4.0]),
)
def test_neither_unit_nor_offset_of_the_distance_matter(probabilities, distances, unit, offset) -> None:
    scores = combined_scores(probabilities, distances)
    others = combined_scores(probabilities, distances * unit + offset)
    if np.quantile(distances, 0.75) > np.quantile(distances, 0.25):
        np.testing.assert_allclose(others - others[0], scores - scores[0], atol=1e-9)


@given(arrays.arrays(np.float64, 6, elements=SHARES), arrays.arrays(np.float64, 6, elements=st.floats(0, 2)))
def test_better_in_both_is_better_in_the_combination(probabilities, distances) -> None:
    scores = combined_scores(probabilities, distances)
    for i in range(6):
        for j in range(6):
            if probabilities[i] >= probabilities[j] and distances[i] <= distances[j]:
                assert scores[i] >= scores[j]
