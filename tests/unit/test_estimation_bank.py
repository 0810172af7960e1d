"""The bank of random instances of layer 1."""

from pathlib import Path

import numpy as np
import pytest
from ell_generator import EllGenerator

from shapewright.distances.descriptor_files import FIRST_VERSION
from shapewright.distances.panorama import DESCRIPTOR_SIZE, panorama_descriptor
from shapewright.errors import Cancelled, EstimationError
from shapewright.estimation import PanoramaBank, build_bank
from shapewright.estimation.bank import bank_chunks, joined
from shapewright.mapped_arrays import read_header, write_arrays
from shapewright.progress import CallbackProgress


@pytest.fixture(scope="module")
def generator() -> EllGenerator:
    return EllGenerator("length", "height")


@pytest.fixture(scope="module")
def bank(generator: EllGenerator) -> PanoramaBank:
    return build_bank(generator, 20, np.random.default_rng(4))


def test_each_row_describes_the_instance_of_its_values(generator: EllGenerator, bank: PanoramaBank) -> None:
    assert bank.values.shape == (20, 2)
    assert bank.descriptors.shape == (20, DESCRIPTOR_SIZE)
    assert bank.descriptors.dtype == np.float32
    assert ((bank.values >= generator.minimum) & (bank.values <= generator.maximum)).all()
    for row in (0, 7, 19):
        points = generator.surface_points(bank.values[row : row + 1])[0]
        one = panorama_descriptor(points, generator.surface_triangles()).to_array()
        np.testing.assert_allclose(bank.descriptors[row], one, atol=1e-6)


def test_the_same_seed_gives_the_same_bank_however_it_is_cut(
    generator: EllGenerator, bank: PanoramaBank, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shapewright.estimation.bank._CHUNK_BYTES", 24 * 7 * 196)
    pieces = list(bank_chunks(generator, 20, np.random.default_rng(4)))
    assert [len(piece) for piece in pieces] == [7, 7, 6]
    whole = joined(pieces)
    np.testing.assert_array_equal(whole.values, bank.values)
    np.testing.assert_allclose(whole.descriptors, bank.descriptors, atol=1e-6)


@pytest.mark.parametrize("memory_map", [True, False])
def test_survives_a_file(bank: PanoramaBank, tmp_path: Path, memory_map: bool) -> None:
    path = tmp_path / "model.bank.npz"
    bank.save(path)
    loaded = PanoramaBank.load(path, memory_map=memory_map)
    np.testing.assert_array_equal(loaded.values, bank.values)
    np.testing.assert_array_equal(loaded.descriptors, bank.descriptors)
    assert (loaded.model_digest, loaded.subdivision_steps) == ("an uneven L", 2)
    assert isinstance(loaded.descriptors, np.memmap) == memory_map
    assert loaded.descriptors.flags.aligned
    if memory_map:
        assert loaded.descriptors.ctypes.data % 64 == 0
    with np.load(path) as archive:
        np.testing.assert_array_equal(archive["values"], bank.values)
    assert [item.name for item in tmp_path.iterdir()] == [path.name]


def test_a_bank_without_parameters_has_one_instance(tmp_path: Path) -> None:
    single = build_bank(EllGenerator(), 50)
    assert single.values.shape == (1, 0)
    single.save(tmp_path / "single.npz")
    assert PanoramaBank.load(tmp_path / "single.npz").values.shape == (1, 0)


def test_damaged_and_foreign_files_are_refused(bank: PanoramaBank, tmp_path: Path) -> None:
    path = tmp_path / "bank.npz"
    bank.save(path)
    data = path.read_bytes()
    for name, content in {
        "empty": b"",
        "cut": data[: len(data) // 2],
        "text": b"no archive" * 50,
    }.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(EstimationError, match="no bank"):
            PanoramaBank.load(tmp_path / name)
    np.savez(tmp_path / "other.npz", values=np.zeros(3))
    with pytest.raises(EstimationError, match="no bank"):
        PanoramaBank.load(tmp_path / "other.npz")
    with pytest.raises(FileNotFoundError):
        PanoramaBank.load(tmp_path / "nowhere.npz")


def test_a_bank_of_another_model_does_not_fit(generator: EllGenerator, bank: PanoramaBank) -> None:
    bank.check_fits(generator, 2)
    with pytest.raises(EstimationError, match="subdivision"):
        bank.check_fits(generator, 1)
    foreign = PanoramaBank(bank.values, bank.descriptors, "another model")
    with pytest.raises(EstimationError, match="another model"):
        foreign.check_fits(generator, 2)
    with pytest.raises(EstimationError, match="columns"):
        PanoramaBank(bank.values, bank.descriptors[:, 1:], bank.model_digest).check_fits(generator, 2)
    with pytest.raises(EstimationError, match="as many"):
        PanoramaBank(bank.values[:3], bank.descriptors, bank.model_digest)


def test_building_reports_and_can_be_cancelled(generator: EllGenerator, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shapewright.estimation.bank._CHUNK_BYTES", 24 * 4 * 196)
    reports: list[float] = []
    build_bank(generator, 10, progress=CallbackProgress(lambda fraction, _: reports.append(fraction)))
    assert reports == sorted(reports)
    assert (reports[0], reports[-1]) == (0.0, 1.0)

    def cancel(fraction: float, message: str) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        build_bank(generator, 10, progress=CallbackProgress(cancel))
    with pytest.raises(EstimationError, match="at least one"):
        build_bank(generator, 0)


@pytest.mark.parametrize(("field", "message"), [("version", "its format"), ("descriptor_version", "the descriptor")])
def test_a_bank_of_another_version_is_refused(bank: PanoramaBank, tmp_path: Path, field: str, message: str) -> None:
    path = tmp_path / "bank.npz"
    bank.save(path)
    header = read_header(path)
    arrays = {"values": bank.values, "descriptors": bank.descriptors}
    write_arrays(path, {**header, field: header[field] + 1}, arrays)
    with pytest.raises(EstimationError, match=message):
        PanoramaBank.load(path)


def test_a_bank_that_names_no_descriptor_is_of_the_first(
    bank: PanoramaBank, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "bank.npz"
    bank.save(path)
    header = read_header(path)
    del header["descriptor_version"]  # as files had it before
    write_arrays(path, header, {"values": bank.values, "descriptors": bank.descriptors})
    assert len(PanoramaBank.load(path)) == len(bank)
    monkeypatch.setattr("shapewright.distances.descriptor_files.VERSION", FIRST_VERSION + 1)
    with pytest.raises(EstimationError, match="make it anew"):
        PanoramaBank.load(path)
