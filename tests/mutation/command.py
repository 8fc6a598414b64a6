"""Mutants of the kernel and the compiler: each changes one line in a scratch copy, and its tests must fail.

    python -m tests.mutation [--only TEXT] [--jobs N] [--json FILE]

The score is the share of mutants that a test notices. The tree itself is not touched.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import multiprocessing
import os
import queue
import shutil
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

import pytest
from tqdm import tqdm

from tests.mutation.table import ROOT, SOURCES, Mutant, all_mutants

KILLED, SURVIVED, BROKEN = "killed", "survived", "broken"
NOT_BUILT = 99
TIMEOUT = 600.0  # s: a mutant whose tests take longer runs for ever, which a test has noticed
OPTIONS = ("-x", "-q", "-p", "no:cacheprovider", "--hypothesis-seed=0")
COMPILE_THEMSELVES = ("tests/elements/", "tests/kernel/test_elementary.py", "tests/fmu/")
IGNORED = shutil.ignore_patterns("__pycache__", "*.so", "*.dylib", "*.dll", ".hypothesis")
WARM = ("numpy", "scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.sparse", "scipy.spatial.transform")
"""What a process imports once, for all mutants."""


def build_kernel(root: Path) -> None:
    """Compile the kernel of a copy, without the package around `build.py`."""
    spec = importlib.util.spec_from_file_location("kernel_build", root / "mbs" / "kernel" / "build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.compile_library()


def build_and_test(root: Path, tests: tuple[str, ...], build: bool, words: Path) -> None:
    """In a process of its own: what is said goes to a file, the outcome is the exit code."""
    with words.open("w") as stream:
        os.dup2(stream.fileno(), 1)
        os.dup2(stream.fileno(), 2)
    sys.dont_write_bytecode = True
    os.chdir(root)
    sys.path.insert(0, str(root))
    os.environ |= {"ZIG_GLOBAL_CACHE_DIR": str(root.parent / "zig"), "PYTHONPATH": str(root)}
    if build:
        try:
            build_kernel(root)
        except RuntimeError as error:
            print(error, flush=True)
            os._exit(NOT_BUILT)
    code = pytest.main([*OPTIONS, *tests]) if tests else 0
    sys.stdout.flush()
    os._exit(int(code))


class Scratch:
    """A copy of the project in which one mutant at a time is tried."""

    def __init__(self, place: Path) -> None:
        self.root = place
        for name in (*SOURCES, "ali3", "benchmarks", "tests", "examples", "docs"):
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, place / name, ignore=IGNORED)
        for path in ROOT.glob("*.*"):
            if path.is_file():
                shutil.copy(path, place)
        methods = multiprocessing.get_all_start_methods()
        self._context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        if "forkserver" in methods:
            self._context.set_forkserver_preload(list(WARM))

    def run(self, tests: tuple[str, ...], build: bool) -> tuple[str, str]:
        """What the tests say of the copy as it is, and why."""
        words = self.root.with_suffix(".txt")
        process = self._context.Process(target=build_and_test, args=(self.root, tests, build, words))
        process.start()
        process.join(TIMEOUT)
        if process.is_alive():
            process.kill()
            process.join()
            return KILLED, f"no end within {TIMEOUT:.0f} s"
        lines = words.read_text(errors="replace").strip().splitlines() or [""]
        if process.exitcode == NOT_BUILT:
            return BROKEN, "\n".join(lines)
        if process.exitcode in (0, 4, 5):  # 4, 5: no such tests
            return (SURVIVED if process.exitcode == 0 else BROKEN), lines[-1]
        return KILLED, next((line for line in lines if line.startswith(("FAILED", "ERROR"))), lines[-1])

    def attempt(self, mutant: Mutant) -> tuple[str, str]:
        """Outcome of one mutant, and why."""
        path, content = mutant.apply(self.root)
        original = path.read_text(encoding="utf-8")
        path.write_text(content, encoding="utf-8")
        try:
            by_themselves = all(test.startswith(COMPILE_THEMSELVES) for test in mutant.tests)
            return self.run(mutant.tests, path.suffix != ".py" and "kernel" in path.parts and not by_themselves)
        finally:
            path.write_text(original, encoding="utf-8")


def prepare(place: Path, tests: tuple[str, ...]) -> Scratch:
    """A copy whose unchanged tests pass."""
    scratch = Scratch(place)
    outcome, words = scratch.run(tests, build=True)
    if outcome != SURVIVED:
        raise SystemExit(f"Without any mutant the tests do not pass: {words}")
    return scratch


def run(mutants: list[Mutant], jobs: int, folder: Path) -> list[dict[str, object]]:
    """Outcomes in the order of the mutants."""
    tests = tuple(dict.fromkeys(test for mutant in mutants for test in mutant.tests))
    copies: queue.Queue[Scratch] = queue.Queue()
    for k in range(jobs):
        copies.put(prepare(folder / str(k), tests if k == 0 else ()))
    with tqdm(total=len(mutants), unit="mutant", dynamic_ncols=True) as bar:

        def one(mutant: Mutant) -> dict[str, object]:
            scratch, start = copies.get(), time.perf_counter()
            try:
                outcome, words = scratch.attempt(mutant)
            finally:
                copies.put(scratch)
            if outcome != KILLED:
                tqdm.write(f"{outcome}: {mutant}\n    {words}")
            bar.update()
            return asdict(mutant) | {"outcome": outcome, "why": words, "seconds": time.perf_counter() - start}

        with ThreadPoolExecutor(jobs) as pool:
            return list(pool.map(one, mutants))


def main() -> int:
    """Command line; returns 1 where a mutant survives or cannot be tried."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="TEXT", default="", help="mutants with this text in their row")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="mutants at a time (default 1)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the outcomes there")
    arguments = parser.parse_args()
    mutants = [m for m in all_mutants() if arguments.only in f"{m} {' '.join(m.tests)}"]
    if not mutants:
        parser.error(f"no row has the text {arguments.only!r}")
    with tempfile.TemporaryDirectory(prefix="ali3-mutation-") as folder:
        outcomes = run(mutants, max(1, arguments.jobs), Path(folder))
    killed = sum(o["outcome"] == KILLED for o in outcomes)
    print(f"{killed} of {len(outcomes)} mutants killed: {100.0 * killed / len(outcomes):.1f} %")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps({"killed": killed, "mutants": outcomes}, indent=1), encoding="utf-8")
    return 0 if killed == len(outcomes) else 1
