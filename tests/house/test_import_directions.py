"""Allowed imports: rooms of the kernel and C files of the others here, Python packages in `import_directions.ini`."""

import posixpath
import re
import subprocess
import sys
from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from mbs.kernel import build

ROOT = Path(__file__).parents[2]
DIRECTIONS = Path(__file__).with_name("import_directions.ini")
"""Contracts of the Python packages; new packages and rooms get their line there."""
KERNEL = ROOT / "mbs" / "kernel" / "src"
ROOMS = (
    "api",
    "lanes",
    "methods",
    "start",
    "sensors",
    "state",
    "system",
    "tree",
    "rows",
    "elements",
    "roads",
    "flexible",
    "lookup",
    "algebra",
    "files",
)
"""Rooms of the kernel; each may include headers of those behind it."""
SHARED = ("method.h", "request.h", "instance.h", "instance", "system.h", "generated.h", "system_arrays.h")
"""Contract of methods and data that all rooms share: each header may include those behind it, and none of a room; the
parts of `instance.h` are a folder."""
PUBLIC = "../include/ali3.h"
STANDARD = ("fmi2FunctionTypes.h", "fmi3FunctionTypes.h")
"""Headers as the FMI standard has them: hosts know no others."""
C_FOLDERS = {
    "fmu_src/native/src": ("ali3.h",),
    "fmu_src/python_slave": ("fmi2.h", "fmi2_adapter.h"),
    "hosts/c": STANDARD,
    "benchmarks/car/c": ("fmi2.h", "../../../hosts/c/library.h"),
}
"""C files outside the kernel: besides headers of their own folder they may include these."""


def sources(folder: Path) -> dict[str, str]:
    """Texts of C files and headers by path from `folder`."""
    files = (f for pattern in ("*.c", "*.h") for f in folder.rglob(pattern))
    return {f.relative_to(folder).as_posix(): f.read_text(encoding="utf-8") for f in sorted(files)}


def includes(texts: Mapping[str, str]) -> dict[str, list[str]]:
    """Included files by including file, both as paths from the folder of `texts`."""
    return {
        file: [
            posixpath.normpath(posixpath.join(posixpath.dirname(file), name))
            for name in re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.MULTILINE)
        ]
        for file, text in texts.items()
    }


def layer(file: str) -> int:
    """Place of a file of the kernel in the order of includes; -1: it lies nowhere."""
    order = (*ROOMS, *SHARED, PUBLIC)
    name = file if file in order else file.split("/")[0]
    return order.index(name) if name in order else -1


def code(text: str) -> str:
    """C without comments and texts."""
    return re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\])*"', " ", text, flags=re.DOTALL)


def calls(texts: Mapping[str, str], prefix: str = "ali3_") -> dict[str, dict[str, str]]:
    """Functions and descriptions of other files by using file, with the file that defines them."""
    codes = {file: code(text) for file, text in texts.items() if file.endswith(".c")}
    pattern = re.compile(rf"^(?!static)\w[\w *]*?\b({prefix}\w+)(?:\([^;{{}}]*\)\s*| = )\{{", re.MULTILINE)
    home = {name: file for file, text in codes.items() for name in pattern.findall(text)}
    used = {file: set(re.findall(rf"\b{prefix}\w+", text)) & home.keys() for file, text in codes.items()}
    for file, text in codes.items():  # a table of all names that begin so
        for begin in re.findall(rf"\b({prefix}\w+)##", text):
            used[file] |= {name for name in home if name.startswith(begin)}
    return {file: {name: home[name] for name in names if home[name] != file} for file, names in used.items()}


def wrong_in_kernel(texts: Mapping[str, str]) -> list[str]:
    """Sentences about files without a room, includes of nothing, includes and calls against the order, and circles."""
    results = [f"{file} lies in no room" for file in texts if layer(file) < 0]
    graph = includes(texts)
    for file, names in graph.items():
        for name in names:
            if name not in texts and name != PUBLIC:
                results.append(f"{file} includes {name}, which is not there")
            elif layer(name) < layer(file):
                results.append(f"{file} includes {name}: against the order of the rooms")
    for file, names in calls(texts).items():
        results += [
            f"{file} calls {n}: against the order of the rooms" for n, f in names.items() if layer(f) < layer(file)
        ]
    return results + circles(graph)


def circles(graph: Mapping[str, Iterable[str]]) -> list[str]:
    """The first circle of includes, in words."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return ["circle of includes: " + " includes ".join(reversed(error.args[1]))]
    return []


def test_the_kernel_includes_in_one_direction():
    texts = sources(KERNEL)
    assert {file.split("/")[0] for file in texts} == {*ROOMS, *SHARED}
    assert sum(map(len, calls(texts).values())) > 300
    assert wrong_in_kernel(texts) == []


@pytest.mark.parametrize(
    ("file", "line", "message"),
    [
        ("algebra/fronts.c", '#include "../rows/constraints.h"', "against the order"),
        ("elements/tyre.c", '#include "../instance.h"\n  # include "../api/run.h"', "api/run.h, which is not there"),
        ("system.h", '#include "rows/constraints.h"', "against the order"),
        ("rows/driving_functions.h", '#include "../tree/tree.h"', "against the order"),
        ("system/message.h", '#include "loading.h"', "circle of includes"),
        ("state/report.c", "int x = ali3_balance_step;", "calls ali3_balance_step: against the order"),
        ("more.c", "", "more.c lies in no room"),
    ],
)
def test_a_direction_turned_round_is_seen(file, line, message):
    texts = sources(KERNEL)
    texts[file] = f"{texts.get(file, '')}\n{line}\n"
    assert any(message in sentence for sentence in wrong_in_kernel(texts))


@pytest.mark.slow
def test_every_header_of_the_kernel_includes_what_it_uses(tmp_path):
    files = []
    for k, name in enumerate(file for file in sources(KERNEL) if file.endswith(".h")):
        files.append(tmp_path / f"header_{k}.c")
        files[-1].write_text(f'#include "{name}"\n#include "{name}"\nextern int header_{k};\n', encoding="utf-8")
    target = build.host_target()
    library = tmp_path / build.library_name(target)
    build.compile_c(files, target, library, include=(KERNEL,), what="a header by itself")
    assert library.is_file()


@pytest.mark.parametrize("folder", C_FOLDERS)
def test_other_c_files_include_their_own_headers_and_public_ones(folder):
    texts = sources(ROOT / folder)
    assert texts
    graph = includes(texts)
    foreign = {n for names in graph.values() for n in names if n not in texts} - set(C_FOLDERS[folder])
    assert not foreign
    assert circles(graph) == []


def test_python_packages_import_in_one_direction():
    call = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    command = [sys.executable, "-c", call, "--no-cache", "--no-logo", "--config", str(DIRECTIONS)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stdout + done.stderr
