"""Constants in C headers and in Python: one source; a library of other sources is refused."""

import ctypes
import itertools
import re
import shutil

import pytest

from mbs.kernel import build, read_headers
from mbs.kernel.binding import library, load_library
from mbs.kernel.header import limits
from mbs.kernel.header.arrays import ARRAYS
from mbs.kernel.header.enumerations import GuideType, ParameterTarget, RoadType, SensorType, SolverValue, Status
from mbs.kernel.header.steps import METHOD_ORDERS, MethodNumber
from mbs.kernel.header.structures import STRUCTURES
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import METHODS, Settings


def test_constants_in_python_are_those_of_the_headers():
    present = {f.name: f.read_text(encoding="utf-8") for f in read_headers.HEADER.glob("*.py") if f.stem != "__init__"}
    assert read_headers.header() == present, "run: python mbs/kernel/read_headers.py"
    assert read_headers.entries() == read_headers.ENTRIES.read_text(encoding="utf-8")


def test_the_table_of_sensors_has_a_row_for_each_type():
    rows = re.findall(r"^\| (\d+) \| ([A-Z_]+) \|", read_headers.sensor_table(), re.MULTILINE)
    assert [(int(number), name) for number, name in rows] == [(t.value, t.name) for t in SensorType]


def test_the_tables_of_arrays_have_a_row_for_each_array():
    tables = [read_headers.array_table(part) for part in ("", *read_headers.PARTS)]
    names = [name for table in tables for name in re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)]
    assert sorted(names) == sorted(ARRAYS)
    assert not re.search(r"\b(ANY|ANY_IF|IF_ANY|OR_NONE|BELOW|WITHIN|OFFSETS|RELATED|FINITE)\b", "\n".join(tables))
    assert "| `row_ptr` | i nc + 1 | offsets in `row_col` |" in tables[0]
    assert "| `el_front` | i ne | -1 to nf - 1 |" in tables[0]
    assert "| `guide_second` | i ng or 0, may be missing |  |" in tables[0]
    assert "| `tree_gravity` | f 3, or 0 without n_joint |  |" in "\n".join(tables)
    sizes = dict(re.findall(r"^\| `(\w+)` \| [^|]+ \| items of `(\w+)`", read_headers.size_table(), re.MULTILINE))
    assert sizes["nq"] == "q0"
    assert set(sizes.values()) <= set(ARRAYS)


def test_numbers_known_from_the_documents():
    assert (Status.OK, Status.BAD_ARGUMENT, Status.BRANCH_CHANGED) == (0, 1, 17)
    assert (SolverValue.ITERATIONS, SolverValue.STATUS, SolverValue.ENERGY_BALANCE) == (0, 5, 7)
    targets = ["ELEMENT", "GUIDE", "ROAD", "PAYLOAD", "SWITCH", "ARMATURE", "INERTIA", "SENSOR", "AXIS"]
    assert [t.name for t in ParameterTarget] == targets
    assert list(ParameterTarget) == list(range(len(targets)))
    assert (SensorType.SIGNAL, SensorType.ELEMENT_OUTPUT, SensorType.WORK) == (0, 8, 19)
    assert (GuideType.OF_TIME, GuideType.OF_INPUT, RoadType.PLANE, RoadType.GRID) == (0, 1, 0, 2)
    assert (limits.OPEN, limits.FARTHEST, limits.FASTEST) == (1e-9, 1e8, 1e6)


def test_every_method_of_the_kernel_has_an_entry_with_its_order():
    assert {method.number for method in METHOD_TABLE.values()} == set(MethodNumber)
    assert {method.number: method.order_of_changing_steps for method in METHOD_TABLE.values()} == METHOD_ORDERS
    assert METHODS["ali3p_no_projection"] == {"method": 0, "project": 0}
    assert METHODS["radau_5"] == {"method": MethodNumber.RADAU_5} == {"method": 7}
    for name in METHOD_TABLE:
        assert f'- "{name}"' in (Settings.__doc__ or ""), name


def test_orders_of_changing_steps_are_at_most_those_of_fixed_ones():
    """Error control divides by two to the power of the first, estimates from a repeat by that of the second."""
    for name, method in METHOD_TABLE.items():
        assert 1 <= method.order_of_changing_steps <= method.order, name


def test_every_status_has_a_sentence_of_its_own():
    texts = [load_library().ali3_status_text(status).decode() for status in Status]
    assert len(set(texts)) == len(texts)
    assert "unknown status" not in texts
    assert load_library().ali3_status_text(len(Status)) == load_library().ali3_status_text(-1) == b"unknown status"


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_kernel_has_the_same_structures(name):
    assert load_library().ali3_structure_size(name.encode()) == ctypes.sizeof(STRUCTURES[name])


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


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("enum { ALI3_ONE = 0, OTHER };", "OTHER"),
        ("enum { ALI3_TWO = 0 };", "no enumeration that starts with ALI3_ONE"),
    ],
)
def test_a_header_that_cannot_be_read_is_refused(monkeypatch, tmp_path, text, what):
    monkeypatch.setattr(read_headers, "KERNEL", tmp_path)
    (tmp_path / "some.h").write_text(text)
    with pytest.raises(ValueError, match=what):
        read_headers.enumeration("some.h", "ALI3_ONE", "ALI3_")


def test_pragmas_of_clang_are_read_by_clang_alone():
    """Others warn of them, and warnings are errors in the kernel with checks (tests/sanitize.py)."""
    results = []
    for file in sorted((build.HERE / "src").rglob("*.[ch]")):
        lines = file.read_text(encoding="utf-8").splitlines()
        for before, line in itertools.pairwise(lines):
            if line.lstrip().startswith("#pragma clang") and "__clang__" not in before:
                results.append(f"{file.name}: {line}")
    assert not results
