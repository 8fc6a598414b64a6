"""Constants in C headers and in Python: one source; a library of other sources is refused."""

import ctypes
import re
import shutil

import pytest

from mbs.kernel import header_tables, read_headers
from mbs.kernel.binding import library, load_library
from mbs.kernel.header.arrays import ARRAYS
from mbs.kernel.header.enumerations import SensorType, Status
from mbs.kernel.header.steps import METHOD_ORDERS, MethodNumber
from mbs.kernel.header.structures import STRUCTURES
from mbs.settings.methods import METHOD_TABLE


def test_constants_in_python_are_those_of_the_headers():
    present = {f.name: f.read_text(encoding="utf-8") for f in read_headers.HEADER.glob("*.py") if f.stem != "__init__"}
    assert read_headers.header() == present, "run: python mbs/kernel/read_headers.py"
    assert read_headers.entries() == read_headers.ENTRIES.read_text(encoding="utf-8")


def test_every_method_of_the_kernel_has_an_entry_with_its_order():
    assert {method.number for method in METHOD_TABLE.values()} == set(MethodNumber)
    assert {method.number: method.order_of_changing_steps for method in METHOD_TABLE.values()} == METHOD_ORDERS


def test_the_tables_of_sensors_and_arrays_have_a_row_for_each():
    rows = re.findall(r"^\| (\d+) \| ([A-Z_]+) \|", header_tables.sensor_table(), re.MULTILINE)
    assert [(int(number), name) for number, name in rows] == [(t.value, t.name) for t in SensorType]
    tables = [header_tables.array_table(part) for part in ("", *header_tables.TABLE_PREFIXES)]
    names = [name for table in tables for name in re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)]
    assert sorted(names) == sorted(ARRAYS)
    assert not re.search(r"\b(ANY|ANY_IF|IF_ANY|OR_NONE|BELOW|WITHIN|OFFSETS|RELATED|FINITE)\b", "\n".join(tables))
    assert "| `row_ptr` | i nc + 1 | offsets in `row_col` |" in tables[0]
    sizes = dict(re.findall(r"^\| `(\w+)` \| [^|]+ \| items of `(\w+)`", header_tables.size_table(), re.MULTILINE))
    assert set(sizes.values()) <= set(ARRAYS)


def test_every_status_has_a_sentence_of_its_own():
    texts = [load_library().ali3_status_text(status).decode() for status in Status]
    assert len(set(texts)) == len(texts)
    assert "unknown status" not in texts
    assert load_library().ali3_status_text(len(Status)) == load_library().ali3_status_text(-1) == b"unknown status"


def test_the_kernel_has_the_same_structures():
    for name, structure in STRUCTURES.items():
        assert load_library().ali3_structure_size(name.encode()) == ctypes.sizeof(structure), name


def test_a_missing_kernel_is_reported_with_its_build_command(tmp_path):
    with pytest.raises(OSError, match=r"There is no kernel .*gone\.so\. Compile it: python -m ali3 build --kernel"):
        load_library(tmp_path / "gone.so")


def test_a_library_with_another_structure_is_refused(monkeypatch, tmp_path):
    class Other(ctypes.Structure):
        _fields_ = (*STRUCTURES["ali3_report"]._fields_, ("more", ctypes.c_double))

    copy = shutil.copy(library.library_path(), tmp_path)
    monkeypatch.setitem(STRUCTURES, "ali3_report", Other)
    with pytest.raises(OSError, match=r"ali3_report has \d+ bytes, in this package \d+: .*ali3 build --kernel"):
        load_library(copy)
    monkeypatch.undo()
    monkeypatch.setitem(library._SIGNATURES, "ali3_of_tomorrow", (None, []))
    with pytest.raises(OSError, match=r"has no function ali3_of_tomorrow: .*ali3 build --kernel"):
        load_library(copy)
