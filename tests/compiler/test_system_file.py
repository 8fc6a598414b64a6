"""System files: equal content gives equal bytes; damaged or hostile content gives one clear error."""

import zlib

import numpy as np
import pytest

from mbs import System, SystemFileError
from mbs.system.compiled_model import ENTRY, FLOATS, HEADER, INTEGERS
from tests.compiler.mechanisms import compiled


@pytest.fixture(scope="module")
def data():
    return compiled("every row").to_bytes()


@pytest.mark.parametrize("name", ["every row", "bricard"])
def test_round_trip(name, tmp_path):
    system = compiled(name)
    path = tmp_path / "scene.ali3"
    system.save(path)
    again = System.load(path)
    assert again.to_bytes() == system.to_bytes()
    assert again.meta == system.meta
    assert str(again) == str(system)
    for key, values in system.arrays.items():
        np.testing.assert_array_equal(again.arrays[key], values)


def test_a_system_cannot_be_changed():
    system = compiled("every row")
    with pytest.raises(ValueError, match="read-only"):
        system.arrays["q0"][0] = 1.0
    with pytest.raises(TypeError):
        system.arrays["q0"] = np.zeros(3)
    system.meta["name"] = "other"
    assert system.name == "every row"


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
    for kind in (0, 4):
        entry = b"unknown".ljust(40, b"\0") + kind.to_bytes(4, "little")
        with pytest.raises(SystemFileError, match="an unknown, repeated or mistyped array 'unknown'"):
            System.from_bytes(forged(data, HEADER.size, entry))
    with pytest.raises(SystemFileError, match=r"mistyped array 'two\\nlines'\.$"):
        System.from_bytes(forged(data, HEADER.size, b"two\nlines".ljust(40, b"\0")))


def test_an_index_out_of_range_is_refused_even_with_a_fitting_checksum(data):
    _, (_, _, _, offset, _) = directory(data)["row_ptr"]
    with pytest.raises(SystemFileError):
        System.from_bytes(forged(data, offset + 4, (2**30).to_bytes(4, "little")))
    with pytest.raises(SystemFileError):
        System.from_bytes(data[:-1])


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


def test_the_file_has_the_arrays_of_its_description(data):
    assert set(directory(data)) == FLOATS | INTEGERS | {"meta", "drawing"}
