"""A copy of the project in which one mutant at a time is tried, and what its tests say."""

import json
import multiprocessing
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import psutil
import pytest

from tests.modules import module_of
from tests.mutation.table import ROOT, SOURCES
from viewer import page_build
from viewer.bundle import bundle

KILLED, SURVIVED, BROKEN, GONE = "killed", "survived", "broken", "gone"
NOT_BUILT = 99
LIMIT = 600.0  # s of CPU: a mutant whose tests take longer runs for ever, which a test has noticed
STILL = 300.0  # s: tests that use no CPU for so long wait for ever
PAUSE = 0.5  # s between looks at the CPU time
OPTIONS = ("-x", "-q", "-p", "no:cacheprovider", "--hypothesis-seed=0", "-m", "not proof")
IGNORED = shutil.ignore_patterns("__pycache__", "*.so", "*.dylib", "*.dll", ".hypothesis", "node_modules")
WARM = ("numpy", "scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.sparse", "scipy.spatial.transform")
WARM += ("fmpy", "matplotlib.figure", "pydantic")
"""What a process imports once, for all mutants."""

Batch = tuple[str, ...]
"""Tests that one call of pytest runs, with its options; files of JavaScript are run by Node, before."""


class Applied(Protocol):
    """A mutant of a table, or one that was drawn."""

    def apply(self, root: Path) -> tuple[Path, str]: ...


@dataclass(frozen=True)
class Verdict:
    """Result of the tests for a copy of the project."""

    outcome: str
    why: str
    """`outcome`, `why`: one of the four outcomes, and the reason in one line."""
    test: str = ""
    """The test that failed, or that was running at the end; empty where all passed."""
    seconds: float = 0.0
    last: float = 0.0
    """`seconds`, `last`: CPU time of all, and of the test that was running at the limit, with the processes that they
    started."""


class _Notes:
    """A plugin of pytest: writes down which test runs, from when, and which has failed."""

    def __init__(self, path: Path) -> None:
        self._stream = path.open("w", encoding="utf-8", buffering=1)

    def write(self, kind: str, test: str) -> None:
        self._stream.write(json.dumps([kind, test, sum(os.times()[:4])]) + "\n")

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self.write("at", nodeid)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.write("failed", report.nodeid)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.write("failed", report.nodeid)


def compiles(root: Path, changed: Path) -> None:
    """Make what a changed file is a part of: the kernel, an object of the FMU, the page.

    Raises `RuntimeError` with the words of the compiler.
    """
    build: Any = module_of(root / "mbs" / "kernel" / "build.py")  # of the copy, without the package around it
    if changed.suffix == ".js":
        bundle()
    elif "kernel" in changed.parts:
        build.compile_library()
    elif changed.suffix == ".c":
        include = [f"-I{place}" for place in (changed.parent, root / "mbs" / "kernel" / "include")]
        flags = [flag for flag in build.FLAGS if flag not in ("-shared", "-s")]
        output_options = ["-c", str(changed), "-o", str(root.with_suffix(".o"))]
        command = [build.compiler(), "cc", *flags, *include, *output_options]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode and "file not found" not in result.stderr:
            raise RuntimeError(result.stderr)


def build_and_test(root: Path, batches: Sequence[Batch], changed: Path | None, message: Path, notes: Path) -> None:
    """In a process of its own: what is said goes to a file, the outcome is the exit code."""
    with message.open("w") as stream:
        os.dup2(stream.fileno(), 1)
        os.dup2(stream.fileno(), 2)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # for which tests/conftest.py writes all the same
    sys.dont_write_bytecode = True
    os.chdir(root)
    sys.path.insert(0, str(root))
    temporary = root.with_suffix(".tmp")
    temporary.mkdir(exist_ok=True)
    os.environ |= {"PYTHONPATH": str(root), "TMPDIR": str(temporary), "ALI3_CACHE": str(temporary / "cache")}
    os.environ["ZIG_GLOBAL_CACHE_DIR"] = str(root.parent / "zig")
    plugin, code = _Notes(notes), 0
    if changed is not None:
        try:
            compiles(root, changed)
        except RuntimeError as error:
            print(error, flush=True)
            os._exit(NOT_BUILT)
    for batch in batches:
        pages = [test for test in batch if test.endswith(".js") and not test.startswith("-")]
        others = [test for test in batch if test not in pages]
        code = next((code for page in pages if (code := _run_in_node(root, page, plugin))), 0)
        if not code and any(".py" in test and not test.startswith("-") for test in others):
            code = int(pytest.main([*OPTIONS, *others], [plugin]))
        if code not in (0, 4, 5):  # 4: a test is no longer there; 5: all are left out by their marks
            break
        code = 0
    sys.stdout.flush()
    os._exit(code)


def _run_in_node(root: Path, test: str, notes: _Notes) -> int:
    page = root / "viewer" / "page"
    page_build.install_packages(page)
    notes.write("at", test)
    code = subprocess.run([page_build.node_and_npm()[0], "--test", str(root / test)], cwd=page, check=False).returncode
    if code:
        notes.write("failed", test)
    return code


class Scratch:
    """A copy of the project in which one mutant at a time is tried."""

    def __init__(self, place: Path) -> None:
        self.root = place
        for name in (*SOURCES, "tests", "examples", "docs"):
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, place / name, ignore=IGNORED)
        for path in ROOT.glob("*.*"):
            if path.is_file():
                shutil.copy(path, place)
        packages = Path("viewer", "page", "node_modules")
        if (ROOT / packages).is_dir():
            (place / packages).symlink_to(ROOT / packages, target_is_directory=True)
        methods = multiprocessing.get_all_start_methods()
        self._context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        if "forkserver" in methods:
            self._context.set_forkserver_preload(list(WARM))

    def run(self, batches: Sequence[Batch], changed: Path | None = None, limit: float = LIMIT) -> Verdict:
        """What the tests say of the copy as it is, within a limit of CPU time; `changed` is compiled before."""
        message, notes = self.root.with_suffix(".txt"), self.root.with_suffix(".notes")
        notes.unlink(missing_ok=True)
        process = self._context.Process(target=build_and_test, args=(self.root, batches, changed, message, notes))
        process.start()
        seconds = _wait(process.pid, process.is_alive, limit)
        over = process.is_alive()
        process.kill()
        process.join()
        shutil.rmtree(self.root.with_suffix(".tmp"), ignore_errors=True)
        lines = message.read_text(errors="replace").strip().splitlines() or [""]
        noted = [json.loads(line) for line in notes.read_text().splitlines()] if notes.is_file() else []
        _, test, since = noted[-1] if noted else ("", "", 0.0)
        if over:
            return Verdict(SURVIVED, f"no end within {seconds:.0f} s of CPU", test, seconds, seconds - since)
        if process.exitcode == NOT_BUILT:
            return Verdict(BROKEN, "\n".join(lines))
        if process.exitcode == 0:
            count = sum(note[0] == "at" for note in noted)
            why = f"{count} tests pass" if count else lines[-1]
            return Verdict(SURVIVED if count or not batches else BROKEN, why, "", seconds)
        why = next((line for line in lines if line.startswith(("FAILED ", "ERROR "))), lines[-1])
        return Verdict(KILLED if test else BROKEN, why, test, seconds)

    def attempt(self, mutant: Applied, batches: Sequence[Batch], limit: float = LIMIT, build: bool = True) -> Verdict:
        """What the tests say of one mutant; the copy is afterwards as before."""
        try:
            path, content = mutant.apply(self.root)
        except ValueError as error:
            return Verdict(GONE, str(error))
        original = path.read_text(encoding="utf-8")
        library = self.root / "mbs" / "kernel" / "lib"
        kept = self.root.with_suffix(".lib")
        compiled = build and path.suffix != ".py"
        if compiled:
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(library, kept)
        path.write_text(content, encoding="utf-8")
        try:
            return self.run(batches, path if compiled else None, limit)
        finally:
            path.write_text(original, encoding="utf-8")
            if compiled:
                shutil.rmtree(library)
                shutil.copytree(kept, library)


def _wait(pid: int | None, alive: Callable[[], bool], limit: float) -> float:
    """CPU time of a process and all that it started, when it ends, is over the limit or stands still; none is left."""
    used, before, moved = 0.0, 0.0, time.monotonic()
    visited: set[psutil.Process] = set()
    while alive() and used < limit and time.monotonic() - moved < STILL:
        time.sleep(PAUSE)
        now = 0.0
        with suppress(psutil.Error):
            tree = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
            visited.update(tree)
            now = sum(sum(process.cpu_times()[:4]) for process in tree)
        used = max(used, now)
        if used > before + 0.5:
            before, moved = used, time.monotonic()
    for process in visited:
        if process.pid != pid:
            with suppress(psutil.Error):
                process.kill()
    return used
