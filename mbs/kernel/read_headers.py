"""Writes constants, enumerations and structures of the C headers to Python (folder `header`), and the C functions that
Python calls.

After a change of the headers:

    python mbs/kernel/read_headers.py
"""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

KERNEL = Path(__file__).resolve().parent
HEADER = KERNEL / "header"
ENTRIES = KERNEL / "src" / "api" / "entries.c"
PUBLIC, SYSTEM, SENSORS = "include/ali3.h", "src/system.h", "src/system/sensor_types.h"
ARRAYS, ELEMENTS = "src/system_arrays.h", "src/elements/element_types.h"
MAGIC = "src/elements/magic_formula.h"

ENUMERATIONS = {
    "Cause": (PUBLIC, "ALI3_CAUSE_CALL", "ALI3_CAUSE_", "`ali3_cause`: cause of a refusal."),
    "SolverValue": (PUBLIC, "ALI3_SOLVER_ITERATIONS", "ALI3_SOLVER_", "Diagnostics of the solver."),
    "ParameterTarget": (SYSTEM, "ALI3_TARGET_ELEMENT", "ALI3_TARGET_", "Target of a parameter."),
    "DrivingFunctionType": (
        "src/rows/driving_functions.h",
        "ALI3_DRIVING_OF_TIME",
        "ALI3_DRIVING_",
        "Types of driving functions.",
    ),
    "RoadType": ("src/elements/road.h", "ALI3_ROAD_PLANE", "ALI3_ROAD_", "Types of roads."),
    "JudgedUnit": (PUBLIC, "ALI3_JUDGED_M", "ALI3_JUDGED_", "`ali3_judged.unit`."),
    "JudgedKind": (PUBLIC, "ALI3_JUDGED_PLACE", "ALI3_JUDGED_", "Bits of `ali3_judged.kind`."),
}
"""Header, first item, prefix of its items and docstring of each enumeration, by its name in Python."""
STEP_ENUMERATIONS = {
    "Update": (PUBLIC, "ALI3_UPDATE_LINEARISED", "ALI3_UPDATE_", "`ali3_settings.update`."),
    "Predictor": (PUBLIC, "ALI3_PREDICTOR_PARABOLA", "ALI3_PREDICTOR_", "`ali3_settings.predictor`."),
    "BranchKind": (PUBLIC, "ALI3_BRANCH_NONE", "ALI3_BRANCH_", "`ali3_report.branch_kind`."),
    "Balance": (PUBLIC, "ALI3_BALANCE_KEPT", "ALI3_BALANCE_", "`ali3_report.balance`."),
}
SENSOR_ENUMERATIONS = {"SensorReads": (SENSORS, "ALI3_READS_MOTION", "ALI3_READS_", "Source of the value of a sensor.")}
LIMITS = {
    "ALI3_OPEN": "Least gap of a row that errors name as open, m.",
    "ALI3_FARTHEST": "Largest distance of a start, m.",
    "ALI3_FASTEST": "Largest speed of a start, m/s or rad/s, and its yaw, rad.",
    "ALI3_POSE": "Numbers of a pose.",
    "ALI3_LONGEST_SETTLING": "Longest time for which a start may settle, s.",
    "ALI3_STILL": "Largest range of a quantity at rest, parts of the largest value in its unit or of the length.",
    "ALI3_WRONG_ERROR": "Largest error of a run that is not wrong, parts of the size of the compared quantity.",
    "ALI3_RESOLVED": "Largest missed part of the changes of velocity of resolved steps, h w/2 for a vibration of w.",
    "ALI3_AGREED": "Largest difference of two motions that agree, parts of the error of a wrong one.",
    "ALI3_MOST_PARTS": "Largest factor by which the step of a second motion is longer; half of it if it is shorter.",
    "ALI3_SYSTEM_VERSION": "Version of the System file.",
}
"""Docstring of each constant of the public header."""
ROADS = "src/roads/road_file.h"
ROAD_LIMITS = {
    "ALI3_ROAD_VERSION": "Version of a road file.",
    "ALI3_ROAD_SHARED": "Version of a road file whose equal tiles are stored once.",
    "ALI3_ROAD_TILE": "Number of points along the side of a tile of a road file.",
    "ALI3_ROAD_HIGHEST": "Largest height of a road file, m.",
    "ALI3_ROAD_FARTHEST": "Largest coordinate of a road file, m.",
    "ALI3_ROAD_FRICTION": "Largest friction of a road file.",
    "ALI3_ROAD_POINTS": "Largest number of points of a road file.",
}
"""Docstring of each constant of road files."""
STRUCTURES = {
    "settings": "SettingsFields",
    "report": "ReportFields",
    "sizes": "Sizes",
    "control": "ControlFields",
    "record": "RecordFields",
    "lane": "LaneFields",
    "judged": "JudgedFields",
    "compared": "ComparedFields",
    "input_table": "InputTable",
    "input_tables": "InputTables",
}
"""Names in Python of the structures ``ali3_...``, pointers after what they point to."""

_OPAQUE = "ali3_instance"
_TYPES = {"double": "c_double", "int32_t": "c_int32", "int64_t": "c_int64"}


def read_header(file: str) -> str:
    """Text of a header without comments."""
    return re.sub(r"/\*.*?\*/", " ", (KERNEL / file).read_text(encoding="utf-8"), flags=re.DOTALL)


def enumeration(file: str, first: str, prefix: str) -> dict[str, int]:
    """Items of the enumeration that starts with `first`, without their prefix and without its count.

    Raises `ValueError` if the header has no such enumeration or an item has another prefix.
    """
    match = re.search(r"enum \{\s*(" + first + r"\b[^}]*)\}", read_header(file))
    if match is None:
        raise ValueError(f"{file} has no enumeration that starts with {first}.")
    items: dict[str, int] = {}
    value = 0
    for item in filter(None, (part.strip() for part in match[1].split(","))):
        name, _, number = (part.strip() for part in item.partition("="))
        if not name.startswith(prefix):
            raise ValueError(f"{name} in {file} does not start with {prefix}.")
        value = int(number) if number else value
        if not name.endswith("_COUNT"):
            items[name.removeprefix(prefix)] = value
        value += 1
    return items


_ARGUMENT = re.compile(r"""\s*((?:"(?:[^"\\]|\\.)*"\s*)+|(?:[^,()"]|\([^()]*\))+)\s*([,)])""")
"""An argument of a list macro, strings or a word with at most one pair of parentheses, and the delimiter after it."""


def table(file: str, name: str) -> list[list[str]]:
    """Arguments of each entry ``X(...)`` of a list macro as text, adjacent strings joined and without quotes."""
    match = re.search(rf"#define {name}\(X\)((?:[^\n]*\\\n)+[^\n]*)", read_header(file))
    if match is None:
        raise ValueError(f"{file} has no list {name}.")
    entries, text, position = [], match[1].replace("\\\n", " "), 0
    while (start := text.find("X(", position)) >= 0:
        position, end, entry = start + 2, "", []
        while end != ")":
            argument = _ARGUMENT.match(text, position)
            if argument is None:
                raise ValueError(f"an entry of {name} in {file} cannot be read: {text[start : start + 60]}")
            words = argument[1].strip()
            entry.append(str(ast.literal_eval(f"({words})")) if words.startswith('"') else words)
            position, end = argument.end(), argument[2]
        entries.append(entry)
    return entries


def element_types() -> dict[str, int]:
    """Types of force elements and their numbers; raises `ValueError` if a number is repeated."""
    types = {name.upper(): int(number) for number, name in table(ELEMENTS, "ALI3_ELEMENT_TYPES")}
    if len(set(types.values())) != len(types):
        raise ValueError(f"two types of ALI3_ELEMENT_TYPES in {ELEMENTS} have one number.")
    return types


class SensorEntry(NamedTuple):
    """An entry of ALI3_SENSOR_TYPES, which describes the letters of `integers`."""

    number: int
    name: str
    integers: str
    reads: str
    words: tuple[str, str, str]


def sensor_types() -> list[SensorEntry]:
    """The types of sensors, by number."""
    entries = [
        SensorEntry(int(number), name, integers, reads, (words[0], words[1], words[2]))
        for number, name, _, integers, _, _, _, reads, *words in table(SENSORS, "ALI3_SENSOR_TYPES")
    ]
    if [entry.number for entry in entries] != list(range(len(entries))):
        raise ValueError(f"the numbers of ALI3_SENSOR_TYPES in {SENSORS} do not run from 0.")
    return entries


class ArrayEntry(NamedTuple):
    """An entry of ALI3_SYSTEM_ARRAYS, which describes `length` and `values`."""

    items: str
    name: str
    presence: str
    length: str
    values: str
    words: str


def arrays() -> list[ArrayEntry]:
    """The arrays of a System in the order of their list; raises `ValueError` if a name is repeated."""
    entries = [ArrayEntry(*entry) for entry in table(ARRAYS, "ALI3_SYSTEM_ARRAYS")]
    if len({entry.name for entry in entries}) != len(entries):
        raise ValueError(f"an array appears twice in ALI3_SYSTEM_ARRAYS of {ARRAYS}.")
    return entries


def structure(name: str) -> list[tuple[str, str]]:
    """Fields of ``ali3_name`` and their ctypes."""
    match = re.search(rf"typedef struct \{{([^{{}}]*)\}} ali3_{name};", read_header(PUBLIC))
    if match is None:
        raise ValueError(f"{PUBLIC} has no structure ali3_{name}.")
    fields = []
    for declaration in filter(None, (part.strip() for part in match[1].split(";"))):
        kind, _, names = declaration.removeprefix("const ").partition(" ")
        for field in names.split(","):
            pointer = field.strip().startswith("*")
            if kind == _OPAQUE:
                fields.append((field.strip(" *"), "c_void_p"))
                continue
            ctype = _TYPES.get(kind) or STRUCTURES[kind.removeprefix("ali3_")]
            fields.append((field.strip(" *"), f"POINTER({ctype})" if pointer else ctype))
    return fields


def _constants(file: str, limits: dict[str, str]) -> list[str]:
    """Python constants for macros of a header, with their docstrings."""
    content, constants = read_header(file), []
    for name, text in limits.items():
        value = re.search(rf"#define {name} (\S+)", content)
        if value is None:
            raise ValueError(f"{file} does not define {name}.")
        constants.append(f'{name.removeprefix("ALI3_")} = {value[1]}\n"""{text}"""')
    return constants


def entries() -> str:
    """C file of the functions that Python calls: each sets the floating-point control around one of the kernel."""
    declared = re.findall(r"^ALI3_API ([^;(]*?)(ali3_\w+)\(([^)]*)\);", read_header(PUBLIC), re.MULTILINE)
    rows = []
    for result, name, parameters in declared:
        arguments = ", ".join(re.findall(r"(\w+)(?:\[\d+\])?\s*(?:,|$)", "" if parameters == "void" else parameters))
        instance = "in" if parameters.startswith("ali3_instance *in") else "NULL"
        head = "PROCEDURE(" if result.strip() == "void" else f"ENTRY({result.strip()}, "
        rows.append(f"{head}{name}, ({' '.join(parameters.split())}), ({arguments}), {instance})\n")
    return _ENTRIES + "".join(rows)


_ENTRIES = """/* The functions of the kernel for callers that may round in another way: entry_NAME for ali3_NAME.
 * Written by `python mbs/kernel/read_headers.py`. */
#include "../instance.h"

/* An instance keeps what its caller has, for the function that it is asked for inputs. */
static ali3_float_control set_for(ali3_instance *in) {
  const ali3_float_control before = ali3_float_control_set();
  if (in != NULL) in->inputs.host_control = before;
  return before;
}

/* clang-format off */
#define ENTRY(type, name, parameters, arguments, instance) \\
  ALI3_API type entry_##name parameters; \\
  ALI3_API type entry_##name parameters { \\
    const ali3_float_control before = set_for(instance); \\
    type result = name arguments; \\
    ali3_float_control_restore(before); \\
    return result; \\
  }
#define PROCEDURE(name, parameters, arguments, instance) \\
  ALI3_API void entry_##name parameters; \\
  ALI3_API void entry_##name parameters { \\
    const ali3_float_control before = set_for(instance); \\
    name arguments; \\
    ali3_float_control_restore(before); \\
  }

"""


def header() -> dict[str, str]:
    """Texts of the files of the folder `header`, by name."""
    return {
        "limits.py": _text(
            "Limits and versions", [], ["\n".join(_constants(PUBLIC, LIMITS) + _constants(ROADS, ROAD_LIMITS))]
        ),
        "arrays.py": _text("Arrays of a System", [], [_array_names()]),
        "enumerations.py": _text("Types and codes", [_ENUM], _enumerations()),
        "steps.py": _text("Methods and report codes", [_ENUM], _steps()),
        "sensor_reads.py": _text("Sources of sensor values", [_ENUM + "\n\n" + _SENSOR_TYPE], _sensor_reads()),
        "magic_coefficients.py": _text("Numbers of the Magic Formula", [], [_magic()]),
        "structures.py": _text("Structures", [_CTYPES], _structures()),
    }


_ENUM = "from enum import IntEnum"
_SENSOR_TYPE = "from mbs.kernel.header.enumerations import SensorType"
_CTYPES = "from ctypes import POINTER, Structure, c_double, c_int32, c_int64, c_void_p"


def _text(what: str, imports: list[str], parts: Iterable[str]) -> str:
    head = f'"""{what} from the kernel\'s C headers. Written by `python mbs/kernel/read_headers.py`."""'
    return "\n\n".join([head, *imports, *parts]) + "\n"


def _array_names() -> str:
    rows = "\n".join(f'    "{a.name}": ("{a.items}", "{a.presence}"),' for a in arrays())
    return f'ARRAYS = {{\n{rows}\n}}\n"""Type of the items, and whether a System must or may have the array."""'


def _classes(enumerations: dict[str, tuple[str, str, str, str]]) -> Iterator[str]:
    for name, (file, first, prefix, text) in enumerations.items():
        values = (f"{item} = {value}" for item, value in enumeration(file, first, prefix).items())
        yield _class(name, "IntEnum", text, values)


def _steps() -> Iterator[str]:
    yield from _classes(STEP_ENUMERATIONS)
    methods = table(PUBLIC, "ALI3_METHODS")
    names = (f"{name} = {number}" for number, (name, _, _) in enumerate(methods))
    yield _class("MethodNumber", "IntEnum", "`ali3_settings.method`.", names)
    orders = "\n".join(f"    MethodNumber.{name}: {order}," for name, _, order in methods)
    yield f'\nMETHOD_ORDERS = {{\n{orders}\n}}\n"""Orders of the methods with variable steps."""'


def _sensor_reads() -> Iterator[str]:
    yield from _classes(SENSOR_ENUMERATIONS)
    reads = "\n".join(f"    SensorType.{t.name}: SensorReads.{t.reads}," for t in sensor_types())
    yield f"\nSENSOR_READS = {{\n{reads}\n}}"


def _enumerations() -> Iterator[str]:
    statuses = (f"{name} = {number}" for number, (name, *_) in enumerate(table(PUBLIC, "ALI3_STATUSES")))
    yield _class("Status", "IntEnum", "Codes of `ali3_status`: how a call of the kernel ended.", statuses)
    yield from _classes(ENUMERATIONS)
    types = (f"{t.name} = {t.number}" for t in sensor_types())
    yield _class("SensorType", "IntEnum", "Types of sensors.", types)
    elements = (f"{name} = {number}" for name, number in element_types().items())
    yield _class("ElementType", "IntEnum", "Types of force elements.", elements)


def _magic() -> str:
    numbers = "\n".join(f'    "{name}": {float(value)},' for name, value in table(MAGIC, "ALI3_MAGIC_COEFFICIENTS"))
    text = "Coefficients in the order of the element, with their values if a tyre property file has none."
    return f'MAGIC_COEFFICIENTS = {{\n{numbers}\n}}\n"""{text}"""'


def _structures() -> Iterator[str]:
    for c_name, name in STRUCTURES.items():
        fields = (f'("{field}", {kind}),' for field, kind in structure(c_name))
        body = ("_fields_ = (", *(f"    {field}" for field in fields), ")")
        yield _class(name, "Structure", f"`ali3_{c_name}`.", body)
    structures = "\n".join(f'    "ali3_{c_name}": {name},' for c_name, name in STRUCTURES.items())
    yield f'\nSTRUCTURES = {{\n{structures}\n}}\n"""Structures by their names in C."""'


def _class(name: str, base: str, text: str, body: Iterable[str]) -> str:
    lines = "\n".join(f"    {line}" for line in body)
    return f'\nclass {name}({base}):\n    """{text}"""\n\n{lines}'


def main() -> None:
    """Write the folder `header` and the functions that Python calls."""
    ENTRIES.write_text(entries(), encoding="utf-8", newline="\n")
    for name, text in header().items():
        (HEADER / name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
