"""Planted faults by check, and which of them other programs find, printed: python -m tests.hosts.odd_fmus.table."""

import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from multiprocessing import get_context
from pathlib import Path

from benchmarks.shared.pages import table
from tests.hosts.odd_fmus import planted_fmu
from tests.hosts.one_check import one_check
from tests.hosts.test_check_planted import ALSO, PLANTS

_BY_FMPY = """
import sys, fmpy
from fmpy.validation import validate_fmu
print(len(validate_fmu(sys.argv[1])), flush=True)
fmpy.simulate_fmu(sys.argv[1], stop_time=0.1, output_interval=0.01, start_values={"u": 0.5})
"""
WAYS = ("`ali3 check`", "FMPy's validation", "FMPy's run fails")


def looked_at(case: tuple[str, bool]) -> tuple[str, tuple[bool, ...]]:
    """The check that a fault is of, and in which of `WAYS` it is found."""
    plant, three = case
    check, verdict, message = PLANTS.get(plant) or ("messages", "note" if three else "BAD", ALSO[plant])
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        fmu = planted_fmu(Path(folder), plant, three)
        actual, words = one_check(fmu, check)
        ours = actual == verdict.lower() and message in words
        command = [sys.executable, "-c", _BY_FMPY, str(fmu)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, cwd=folder)
    problems = next((line for line in done.stdout.splitlines() if line.isdigit()), "0")
    return check, (ours, problems != "0", done.returncode != 0)


def rows() -> list[dict[str, str]]:
    """A row for each check, and their sum: how many faults of its kind, and how many each way finds, by standard."""
    cases = list(product([*PLANTS, *ALSO], (False, True)))
    planted, seen = Counter[str](), Counter[tuple[str, str, bool]]()
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for (_, three), (check, ways) in zip(cases, pool.map(looked_at, cases), strict=True):
            for name in (check, "all"):
                planted[name] += not three
                for way, hit in zip(WAYS, ways, strict=True):
                    seen[name, way, three] += hit
    names = [*(name for name in planted if name != "all"), "all"]
    return [
        {"check": name, "faults": str(planted[name])}
        | {way: f"{seen[name, way, False]}, {seen[name, way, True]}" for way in WAYS}
        for name in names
    ]


if __name__ == "__main__":
    print(table(rows(), dict.fromkeys(("check", "faults", *WAYS), "")))
