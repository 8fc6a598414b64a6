"""No end of a process aborts it, for all kinds of FMU; the Python kind where host or FMU has the interpreter."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from mbs.kernel import build as kernel_build
from tests.fmu import native

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the tools of these tests are those of glibc")
HOST = Path(__file__).parent / "ends.py"
ENDS = (
    *("nothing freed", "unloaded", "freed and unloaded", "many", "handler before", "handler after"),
    *("fork", "threads step", "threads make and free", "threads wait to free"),
    *("freed by the last destructor", "made by the last destructor"),
)
C_ENDS = ("nothing", "freed", "unloaded", "unloaded alone", "handler", "threads", "interpreter ended", "fork")
FOUND = 99
"""Exit code where `freed.c` has found something."""
SECONDS = 120.0
LEAST = 300
FIRST_MINOR, LAST_MINOR = 10, 16
ABOUT = """
import json, sys, sysconfig
place = [sysconfig.get_config_var(name) for name in ("LIBDIR", "INSTSONAME")]
print(json.dumps([sys.version_info[1], sys.executable, "/".join(place) if all(place) else ""]))
"""


class Python(NamedTuple):
    """An interpreter and its library, empty if it has none."""

    program: str
    library: str


class Ends:
    """Runs processes to their end."""

    def __init__(self, folder: Path, fmus: list[Path]) -> None:
        self.folders = [native.unpack(fmu, folder / fmu.stem) for fmu in fmus]
        self.host = native.compile_host(folder, source=native.C_FOLDER / "ends.c")
        self.freed = folder / "freed.so"
        target = kernel_build.host_target()
        kernel_build.compile_c([native.C_FOLDER / "freed.c"], target, self.freed, what="the list of freed blocks")

    def in_python(self, python: Python, end: str, watched: bool) -> str:
        """What went wrong."""
        return self._run([python.program, str(HOST), end, *map(str, self.folders)], watched)

    def in_c(self, python: Python, end: str, watched: bool) -> str:
        """The same where the interpreter is the FMU's."""
        command = [str(self.host), end, python.library]
        for folder in self.folders:
            (library,) = folder.glob("binaries/linux64/*Python.so")
            command += [str(library), (folder / "resources").as_uri(), native.guid_of(folder)]
        return self._run(command, watched, Path(python.program).parent)

    def _run(self, command: list[str], watched: bool, first: Path | None = None) -> str:
        environment = dict(os.environ)
        if first is not None:
            environment["PATH"] = f"{first}{os.pathsep}{environment['PATH']}"
        if watched:
            environment["LD_PRELOAD"] = str(self.freed)
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=SECONDS, check=False)
        return "" if done.returncode == 0 else f"{command[:3]}: {done.returncode}, {done.stderr[-400:]}"


@pytest.fixture(scope="session")
def ends(build: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Ends:
    return Ends(tmp_path_factory.mktemp("ends"), [build(scene, "python") for scene in ("crane", "reach")])


def about(program: str) -> tuple[int, Python] | None:
    """Version and place of an interpreter that runs."""
    done = subprocess.run([program, "-c", ABOUT], capture_output=True, text=True, check=False)
    if done.returncode:
        return None
    minor, executable, library = json.loads(done.stdout)
    return minor, Python(executable, library if Path(library).is_file() else "")


def pythons() -> list[Python]:
    """One of each version that is on the path or where pyenv and uv keep them."""
    names = [f"python3.{minor}" for minor in range(FIRST_MINOR, LAST_MINOR + 1)]
    kept = [Path.home() / ".pyenv" / "versions", Path.home() / ".local" / "share" / "uv" / "python"]
    places = [str(p) for folder in kept for name in names for p in sorted(folder.glob(f"*/bin/{name}"))]
    on_path = [place for name in names if (place := shutil.which(name))]
    results = [about(program) for program in [*places, *on_path, sys.executable]]
    return list(dict(one for one in results if one is not None).values())


@pytest.fixture(scope="session")
def own_python() -> Python:
    result = about(sys.executable)
    assert result is not None
    return result[1]


def test_a_write_to_a_freed_block_and_a_second_free_are_seen(ends: Ends) -> None:
    make = "import ctypes; c = ctypes.CDLL(None); c.malloc.restype = ctypes.c_void_p; "
    environment = os.environ | {"LD_PRELOAD": str(ends.freed)}
    for act, code in (("", 0), ("ctypes.memset(block, 0, 1)", FOUND), ("c.free(block)", FOUND)):
        free = f"block = ctypes.c_void_p(c.malloc(64)); c.free(block); {act}"
        done = subprocess.run([sys.executable, "-c", make + free], env=environment, capture_output=True, check=False)
        assert done.returncode == code


@pytest.mark.slow
def test_ends_of_a_host_in_python(ends: Ends, own_python: Python) -> None:
    assert [text for end in ENDS if (text := ends.in_python(own_python, end, watched=True))] == []


def test_ends_of_a_host_in_c(ends: Ends, own_python: Python) -> None:
    if not own_python.library:
        pytest.skip("this Python is linked statically (Debian packs libpython apart): a host in C has nothing to load")
    assert [text for end in C_ENDS if (text := ends.in_c(own_python, end, watched=True))] == []


@pytest.mark.proof
def test_three_hundred_ends_on_a_busy_machine(ends: Ends) -> None:
    result = pythons()
    tasks = [(ends.in_python, python, end) for python in result for end in ENDS]
    tasks += [(ends.in_c, python, end) for python in result if python.library for end in C_ENDS]
    rounds = 2 * -(-LEAST // (2 * len(tasks)))
    with ThreadPoolExecutor(4 * (os.cpu_count() or 1)) as pool:
        done = [pool.submit(run, python, end, watched=bool(k % 2)) for k in range(rounds) for run, python, end in tasks]
        bad = [text for one in done if (text := one.result())]
    assert len(done) >= LEAST
    assert not bad, f"{len(bad)} of {len(done)}: {bad[:10]}"
