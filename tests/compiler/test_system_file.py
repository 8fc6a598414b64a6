"""System files: equal content gives equal bytes; damaged or hostile content gives one clear error."""

import zlib

import numpy as np
import pytest

from mbs import System, SystemFileError, compile
from mbs.system.compiled_model import ENTRY, FLOATS, HEADER, INTEGERS
from tests.compiler.mechanisms import MODELS, rows_of_every_kind


@pytest.fixture(scope="module")
def data():
    return compile(rows_of_every_kind()).to_bytes()


@pytest.mark.parametrize("name", MODELS)
def test_round_trip(name, tmp_path):
    system = compile(MODELS[name]())
    path = tmp_path / "scene.ali3"
    system.save(path)
    again = System.load(path)
    assert again.to_bytes() == system.to_bytes()
    assert again.meta == system.meta
    assert str(again) == str(system)
    for key, values in system.arrays.items():
        np.testing.assert_array_equal(again.arrays[key], values)


@pytest.mark.slow
def test_compiling_twice_gives_equal_bytes(data):
    assert compile(rows_of_every_kind()).to_bytes() == data


def test_a_system_cannot_be_changed():
    system = compile(rows_of_every_kind())
    with pytest.raises(ValueError, match="read-only"):
        system.arrays["q0"][0] = 1.0
    with pytest.raises(TypeError):
        system.arrays["q0"] = np.zeros(3)
    system.meta["name"] = "other"
    assert system.name == "every row"


def test_every_truncation_is_refused(data):
    for length in [*range(0, 200, 7), *range(200, len(data), 997), len(data) - 1]:
        with pytest.raises(SystemFileError):
            System.from_bytes(data[:length])
    with pytest.raises(SystemFileError):
        System.from_bytes(data + b"\0")


def test_every_altered_byte_is_refused(data):
    rng = np.random.default_rng(5)
    for at in [0, 8, 12, 16, 24, *rng.integers(32, len(data), size=60)]:
        altered = bytearray(data)
        altered[at] ^= 0x40
        with pytest.raises(SystemFileError):
            System.from_bytes(bytes(altered))


def forged(data, at, content):
    """Content changed and the checksum made to fit again."""
    altered = bytearray(data)
    altered[at : at + len(content)] = content
    altered[24:28] = zlib.crc32(bytes(altered[HEADER.size :])).to_bytes(4, "little")
    return bytes(altered)


def directory(data):
    return {
        entry[0].rstrip(b"\0").decode(): (k, entry)
        for k in range(HEADER.unpack_from(data)[2])
        for entry in [ENTRY.unpack_from(data, HEADER.size + k * ENTRY.size)]
    }


def test_an_unknown_array_of_any_type_is_refused(data):
    for kind in range(5):
        entry = b"unknown".ljust(40, b"\0") + kind.to_bytes(4, "little")
        with pytest.raises(SystemFileError, match="an unknown, repeated or mistyped array 'unknown'"):
            System.from_bytes(forged(data, HEADER.size, entry))
    with pytest.raises(SystemFileError, match=r"mistyped array 'two\\nlines'\.$"):
        System.from_bytes(forged(data, HEADER.size, b"two\nlines".ljust(40, b"\0")))


@pytest.mark.parametrize("name", ["row_ptr", "row_col", "front_idx", "el_sig", "mass_col", "sig_ptr", "front_parent"])
def test_an_index_out_of_range_is_refused_even_with_a_fitting_checksum(data, name):
    _, (_, _, _, offset, count) = directory(data)[name]
    assert count > 1
    for value in (2**30, -5):
        with pytest.raises(SystemFileError):
            System.from_bytes(forged(data, offset + 4, value.to_bytes(4, "little", signed=True)))


def test_a_number_that_is_not_finite_is_refused(data):
    _, (_, _, _, offset, _) = directory(data)["mass_val"]
    with pytest.raises(SystemFileError):
        System.from_bytes(forged(data, offset, np.float64(np.nan).tobytes()))


def test_an_array_outside_the_file_or_unknown_is_refused(data):
    k, (raw, kind, zero, offset, count) = directory(data)["q0"]
    at = HEADER.size + k * ENTRY.size
    for entry in (
        ENTRY.pack(raw, kind, zero, 8 * (len(data) // 8), count + 2),
        ENTRY.pack(raw, kind, zero, 2**62, count),
        ENTRY.pack(raw, kind, zero, offset, 2**61),
        ENTRY.pack(b"surprise", kind, zero, offset, count),
        ENTRY.pack(raw, 1, zero, offset, count),
    ):
        with pytest.raises(SystemFileError):
            System.from_bytes(forged(data, at, entry))


def test_damaged_names_are_refused(data):
    _, (_, _, _, offset, _) = directory(data)["meta"]
    with pytest.raises(SystemFileError):
        System.from_bytes(forged(data, offset, b"["))


def test_the_file_has_the_arrays_of_its_description(data):
    assert set(directory(data)) == FLOATS | INTEGERS | {"meta", "drawing"}
