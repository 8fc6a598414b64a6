"""Mutants: each changes one place in a scratch copy of the project, and its tests must fail.

    python -m tests.mutation [--only TEXT] [--jobs N] [--json FILE]
    python -m tests.mutation --sample N [--seed S] [--limit SECONDS] [--jobs N] [--json FILE]
    python -m tests.mutation --again [FILE] [--limit SECONDS] [--jobs N] [--json FILE]

Without `--sample` and `--again` those of the tables. The score is the share of mutants that a test notices. The tree
itself is not touched.
"""

import argparse
import json
import os
import queue
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any, TypeVar

from tqdm import tqdm

from tests.mutation.choice import batches_of
from tests.mutation.sample import Sampled, draw
from tests.mutation.scratch import BROKEN, KILLED, SURVIVED, Scratch, Verdict
from tests.mutation.table import HERE, Mutant, all_mutants

COMPILE_THEMSELVES = ("tests/elements/", "tests/kernel/test_elementary.py", "tests/fmu/")
STORED = HERE / "sample.json"
LIMIT = 90.0  # s of CPU for the tests of a mutant that was drawn
DRAWN_AGAIN = 20  # at most, for one mutant that cannot be tried
ENDLESS = 20.0  # s of CPU: a test that takes so long, and three times as long as without the mutant, does not end

Item = TypeVar("Item")
Row = dict[str, Any]


def prepare(place: Path, tests: tuple[str, ...]) -> Scratch:
    """A copy whose unchanged tests pass."""
    scratch = Scratch(place)
    verdict = scratch.run([tests] if tests else [], scratch.root / "mbs" / "kernel" / "include" / "ali3.h")
    if verdict.outcome != SURVIVED:
        raise SystemExit(f"Without any mutant the tests do not pass: {verdict.why}")
    return scratch


def row_of(mutant: Mutant | Sampled, verdict: Verdict) -> Row:
    """Fields of the mutant and what its tests say."""
    return asdict(mutant) | {"outcome": verdict.outcome, "why": verdict.why, "seconds": round(verdict.seconds, 1)}


def attempt_named(scratch: Scratch, mutant: Mutant) -> Row:
    """Try a row of the tables."""
    by_themselves = all(test.startswith(COMPILE_THEMSELVES) for test in mutant.tests)
    verdict = scratch.attempt(mutant, [mutant.tests], build=not by_themselves)
    return row_of(mutant, replace(verdict, outcome=KILLED) if verdict.last else verdict)  # it has no end


class Attempts:
    """Tries mutants that were drawn. A test that kills one must pass without it; its outcome is kept.

    Parameters
    ----------
    limit : float
        CPU time for the tests of one mutant, in seconds.
    """

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._sound: dict[str, bool] = {}

    def one_of(self, scratch: Scratch, mutants: Iterable[Sampled]) -> Row:
        """Try the first mutant that compiles."""
        for _, mutant in zip(range(DRAWN_AGAIN), mutants, strict=False):
            row = self.one(scratch, mutant)
            if row["outcome"] != BROKEN:
                break
        return row

    def one(self, scratch: Scratch, mutant: Sampled) -> Row:
        """Try a mutant, which is told with the file that has its line now."""
        with suppress(ValueError):
            mutant = replace(mutant, file=mutant.find(scratch.root)[0].relative_to(scratch.root).as_posix())
        while True:
            unsound = [test for test, sound in self._sound.items() if not sound]
            left_out = [f"--deselect={test}" for test in unsound]
            chosen = [[test for test in batch if test not in unsound] for batch in batches_of(mutant, scratch.root)]
            batches = [(*batch, *left_out) for batch in chosen]
            verdict = scratch.attempt(mutant, batches, self._limit)
            if verdict.outcome == KILLED and not self._passes(scratch, verdict.test):
                continue
            if verdict.outcome == SURVIVED and verdict.last > ENDLESS:
                without = scratch.run([(verdict.test,)], limit=verdict.last / 3.0)
                if without.outcome == SURVIVED and not without.test:
                    verdict = replace(verdict, outcome=KILLED)
            return row_of(replace(mutant, killed_by=verdict.test if verdict.outcome == KILLED else ""), verdict)

    def _passes(self, scratch: Scratch, test: str) -> bool:
        if test not in self._sound:
            files = ("--collect-only",) if "::" not in test and test.endswith(".py") else ()  # they did not import
            verdict = scratch.run([(*files, test)], limit=self._limit)
            self._sound[test] = verdict.outcome != KILLED
            if verdict.outcome == KILLED:
                tqdm.write(f"left out, because it fails without any mutant: {verdict.why}")
        return self._sound[test]


def run(
    items: list[Item], attempt: Callable[[Scratch, Item], Row], jobs: int, tests: tuple[str, ...], file: Path | None
) -> list[Row]:
    """Outcomes in the order of the mutants; a file has those that are known at any time."""
    rows: dict[int, Row] = {}
    with tempfile.TemporaryDirectory(prefix="ali3-mutation-", ignore_cleanup_errors=True) as folder:
        copies: queue.Queue[Scratch] = queue.Queue()
        for k in range(jobs):
            copies.put(prepare(Path(folder, str(k)), tests if k == 0 else ()))
        with tqdm(total=len(items), unit="mutant", dynamic_ncols=True) as bar, ThreadPoolExecutor(jobs) as pool:

            def one(k: int) -> None:
                scratch = copies.get()
                try:
                    row = attempt(scratch, items[k])
                finally:
                    copies.put(scratch)
                if row["outcome"] != KILLED:
                    tqdm.write(f"{row['outcome']}: {words_of(row)}\n    {row['why']}")
                rows[k] = row
                if file is not None:
                    write(file, [rows[k] for k in sorted(rows)])
                bar.update()

            list(pool.map(one, range(len(items))))
    return [rows[k] for k in range(len(items))]


def words_of(row: Row) -> str:
    """A mutant as it is printed."""
    return str(stored(row) if "line" in row else Mutant(row["file"], row["original"], row["changed"], ()))


def write(file: Path, rows: list[Row]) -> None:
    """Write outcomes, whole or not at all."""
    killed = sum(row["outcome"] == KILLED for row in rows)
    part = file.with_name(f"{file.name}.part-{os.getpid()}")
    part.write_text(json.dumps({"killed": killed, "mutants": rows}, indent=1) + "\n", encoding="utf-8")
    part.replace(file)


def stored(row: Row) -> Sampled:
    """The mutant of an outcome."""
    return Sampled(**{field.name: row[field.name] for field in fields(Sampled)})


def read(file: Path) -> list[Sampled]:
    """The mutants of a file of outcomes that were killed."""
    rows = json.loads(file.read_text(encoding="utf-8"))["mutants"]
    return [stored(row) for row in rows if row["outcome"] == KILLED]


def summary(rows: list[Row]) -> str:
    """Killed of all, by room and by language."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for row in rows:
        path = Path(row["file"])
        room = "/".join(path.parts[:-1][:2]) or "named rows"
        language = {".py": "Python", ".js": "JavaScript"}.get(path.suffix, "C")
        for name in (room, language):
            counts[name][row["outcome"]] += 1
    width = max(map(len, counts))
    return "\n".join(f"{name:{width}} {c[KILLED]:4d} of {c.total():4d}" for name, c in sorted(counts.items()))


def main() -> int:
    """Command line; returns 1 where a mutant survives or cannot be tried."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.splitlines()[0])
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--sample", type=int, metavar="N", help="N mutants by chance, in place of those of the tables")
    kind.add_argument(
        "--again", type=Path, nargs="?", const=STORED, metavar="FILE",
        help=f"those killed in outcomes of before (default {STORED.name} beside the tables)",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of the chance (default 0)")
    parser.add_argument(
        "--limit", type=float, default=LIMIT, metavar="SECONDS",
        help=f"CPU time for the tests of a mutant of --sample or --again (default {LIMIT:.0f})",
    )  # fmt: skip
    parser.add_argument("--only", metavar="TEXT", default="", help="mutants with this text in their row")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="mutants at a time (default 1)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the outcomes there")
    arguments = parser.parse_args()
    jobs = max(1, arguments.jobs)
    if arguments.sample is not None:
        if arguments.only:
            parser.error("--only cannot be combined with --sample, which draws from all files")
        if arguments.sample < 1:
            parser.error(f"--sample {arguments.sample} is not a number of mutants; it must be 1 or more")
        drawn = draw(arguments.sample, arguments.seed)
        rows = run(drawn, Attempts(arguments.limit).one_of, jobs, (), arguments.json)
    elif arguments.again is not None:
        again = [m for m in read(arguments.again) if arguments.only in f"{m} {m.killed_by}"]
        rows = run(again, Attempts(arguments.limit).one, jobs, (), arguments.json)
    else:
        mutants = [m for m in all_mutants() if arguments.only in f"{m} {' '.join(m.tests)}"]
        if not mutants:
            parser.error(f"no row has the text {arguments.only!r}")
        tests = tuple(dict.fromkeys(test for mutant in mutants for test in mutant.tests))
        rows = run(mutants, attempt_named, jobs, tests, arguments.json)
    killed = sum(row["outcome"] == KILLED for row in rows)
    if arguments.sample or arguments.again:
        print(summary(rows))
    print(f"{killed} of {len(rows)} mutants killed: {100.0 * killed / max(1, len(rows)):.1f} %")
    return 0 if killed == len(rows) else 1
