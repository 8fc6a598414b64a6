"""Mutants of the kernel and the compiler: each changes one line in a scratch copy, and its tests must fail.

    python -m tests.mutation [--only TEXT] [--jobs N] [--json FILE]

The score is the share of mutants that a test notices. The tree itself is not touched.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

from tqdm import tqdm

from tests.mutation.table import ROOT, SOURCES, Mutant, all_mutants

KILLED, SURVIVED, BROKEN = "killed", "survived", "broken"
TIMEOUT = 300.0  # s: a mutant whose tests take longer runs for ever, which a test has noticed
PYTEST = ("-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:randomly", "--hypothesis-seed=0")
COMPILE = "from mbs.kernel import build; build.FLAGS.append('-Wno-error'); build.compile_library()"
IGNORED = shutil.ignore_patterns("__pycache__", "*.so", "*.dylib", "*.dll", ".hypothesis")


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
        cache = str(place.parent / "zig")
        self._environment = os.environ | {"ZIG_GLOBAL_CACHE_DIR": cache, "PYTHONPATH": str(place)}

    def run(self, *command: str, timeout: float = TIMEOUT) -> subprocess.CompletedProcess[str]:
        """Python with these arguments, in the copy."""
        return subprocess.run(
            [sys.executable, *command],
            cwd=self.root,
            env=self._environment | {"PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            text=True,
            check=False,
            timeout=timeout,
        )

    def build(self) -> str:
        """Compile the kernel; the words of the compiler where it refuses."""
        result = self.run("-c", COMPILE, timeout=900.0)
        return "" if result.returncode == 0 else result.stderr

    def test(self, tests: tuple[str, ...]) -> tuple[str, str]:
        """What the tests say, and the last line of it."""
        try:
            result = self.run(*PYTEST, *tests)
        except subprocess.TimeoutExpired:
            return KILLED, f"no end within {TIMEOUT:.0f} s"
        last = (result.stdout.strip().splitlines() or [result.stderr.strip()[-200:]])[-1]
        if result.returncode in (0, 4, 5):  # 4, 5: no such tests
            return (SURVIVED if result.returncode == 0 else BROKEN), last
        return KILLED, next((line for line in result.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))), last)

    def attempt(self, mutant: Mutant) -> tuple[str, str]:
        """Outcome of one mutant, and why."""
        path, content = mutant.apply(self.root)
        original = path.read_text(encoding="utf-8")
        path.write_text(content, encoding="utf-8")
        try:
            in_kernel = path.suffix != ".py" and "kernel" in path.parts
            words = self.build() if in_kernel else ""
            return (BROKEN, words) if words else self.test(mutant.tests)
        finally:
            path.write_text(original, encoding="utf-8")


def prepare(place: Path, tests: tuple[str, ...]) -> Scratch:
    """A copy whose unchanged tests pass."""
    scratch = Scratch(place)
    words = scratch.build()
    if words:
        raise SystemExit(f"The kernel does not compile:\n{words}")
    if tests:
        outcome, last = scratch.test(tests)
        if outcome != SURVIVED:
            raise SystemExit(f"Without any mutant the tests do not pass: {last}")
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


if __name__ == "__main__":
    raise SystemExit(main())
