"""``ali3 check FMU --reference CSV|DIR``: an FMU against tables of reference results."""

import fnmatch
import math
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from typing import TypeVar

from ali3.errors import UserError
from hosts.check.reference_comparison import Comparison, compare
from hosts.check.reference_table import Reference, ReferenceOptions, read_reference
from hosts.check.verdict_files import Case
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import digest
from hosts.driving.runs_with_progress import runs_with_bar
from hosts.experiment.store import ResultStore, report_resumed, run_key
from hosts.fmu.fmu import Fmu
from hosts.fmu.own_process import files_of

OUT = Path("out", "reference")

T = TypeVar("T")


def check_references(
    path: Path,
    tables: Path,
    cases: list[Case],
    bounds: Sequence[tuple[str, float]],
    options: ReferenceOptions,
    jobs: int,
    out: Path,
    again: bool = False,
) -> int:
    """Run an FMU with the inputs of its references, and print the deviations of its outputs.

    The result of each of several tables is stored until all are done, so that the same call resumes a stopped one.

    Parameters
    ----------
    tables : Path
        A table with a column time, or a folder of tables. Columns that are inputs or tunable parameters of the FMU
        drive it, see `hosts.driving.manoeuvre_table.read_table`; those that are outputs are compared, `solver.*` only
        if a bound names them.
    cases : list of Case
        Receives the run and the signals of each table, also before an error.
    bounds : sequence of (str, float)
        See `deviations`; each must fit an output of one of the tables.
    options : ReferenceOptions
        Options for the runs.
    jobs : int
        Tables compared at the same time.
    out : Path
        Folder of the stored results.
    again : bool
        Whether tables with a stored result are compared again.

    Returns
    -------
    int
        Exit code: 0 if all are within their bounds and no step was refused.

    Raises
    ------
    HostError
        There is no table, or a bound names no output of a table. Of errors of single tables the first is raised after
        all are done: a table has no output of the FMU, its times are not communication points, or the FMU does not
        start with its values.
    """
    files = sorted(tables.glob("*.csv")) if tables.is_dir() else [tables]
    if not files:
        raise HostError(f"There is no table (.csv) in the folder {tables}.")
    _check_shares(bounds)
    errors = list[UserError]()

    def add_error(file: Path, error: UserError) -> None:
        cases.append(Case(file.stem, "comparison", "error", str(error)))
        errors.append(error)
        if len(files) > 1:
            print(f"BAD   {file.name}: {error}")

    with ExitStack() as stack:
        fmu = stack.enter_context(Fmu(path))
        store = None
        if tables.is_dir():
            store = stack.enter_context(ResultStore[Comparison](out, Comparison, "checks an FMU", again))
        references = []
        for file in files:
            try:
                references.append(read_reference(fmu, file, options))
            except UserError as error:
                add_error(file, error)
        comparisons = _comparisons(fmu, references, store, bounds, options.manoeuvre is None, jobs)
        stack.enter_context(closing(comparisons))
        for reference, outcome in zip(references, in_order(comparisons), strict=True):
            if isinstance(outcome, HostError):
                add_error(reference.file, outcome)
            else:
                print("\n".join(outcome.lines), flush=True)
                cases += outcome.cases
        if store is not None:
            store.clear()
    if errors:
        raise errors[0]
    names = [case.name for case in cases if case.name != "run" and case.verdict in ("good", "bad")]
    for pattern, _ in bounds:
        if not fnmatch.filter(names, pattern):
            raise HostError(f"--bound {pattern}: {tables} has no such output of {path.name}.")
    return int(any(case.verdict == "bad" for case in cases))


def _check_shares(bounds: Sequence[tuple[str, float]]) -> None:
    for pattern, share in bounds:
        if not 0.0 <= share < math.inf:
            raise HostError(f"--bound {pattern} is {share:g}; it must be a share of the range, 0 or more.")


def _comparisons(
    fmu: Fmu,
    references: Sequence[Reference],
    store: ResultStore[Comparison] | None,
    bounds: Sequence[tuple[str, float]],
    by_table: bool,
    jobs: int,
) -> Generator[tuple[int, Comparison | HostError]]:
    """Number and comparison of each table: first the stored ones, then the others as they are done."""
    keys = [_key(fmu, reference, bounds) for reference in references]
    names = [reference.file.name for reference in references]
    stored = [None if store is None else store.find(*name_and_key) for name_and_key in zip(names, keys, strict=True)]
    present = [(number, outcome) for number, outcome in enumerate(stored) if outcome is not None]
    report_resumed(len(present), len(keys), "tables")
    yield from present
    pending = [number for number, outcome in enumerate(stored) if outcome is None]
    with closing(runs_with_bar(fmu, [references[number].drive for number in pending], jobs)) as results:
        for index, result in results:
            number = pending[index]
            if isinstance(result, HostError):
                yield number, result
                continue
            comparison = compare(fmu, references[number], result, bounds, by_table)
            if store is not None:
                store.add(names[number], keys[number], comparison)
            yield number, comparison


def _key(fmu: Fmu, reference: Reference, bounds: Sequence[tuple[str, float]]) -> str:
    drive = reference.drive
    files = [reference.file, *files_of(drive.manoeuvre.start)]
    return run_key(fmu.path, digest(drive.manoeuvre), drive.step, bounds, files=files)


def in_order(results: Iterable[tuple[int, T]]) -> Iterator[T]:
    """Results sorted by their numbers. `results`: pairs of number and result, in any order."""
    waiting, next_number = dict[int, T](), 0
    for number, result in results:
        waiting[number] = result
        while next_number in waiting:
            yield waiting.pop(next_number)
            next_number += 1
