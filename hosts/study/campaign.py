"""Runs a study: reads its file, makes its runs and writes its table."""

import json
import sys
import time as clock
from collections.abc import Generator
from contextlib import closing, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.cores import available_cores
from ali3.errors import FileError
from ali3.reading import is_file_or_folder, is_folder
from hosts.common.errors import HostError
from hosts.experiment.store import ResultStore
from hosts.fmu.built_fmu import car_digest, fmu_of_car
from hosts.measures.limits import limits_record
from hosts.study.folder import (
    begin_study,
    check_no_link,
    check_same,
    fmu_of_folder,
    free_space,
    read_record,
    update_limits,
)
from hosts.study.missing_runs import make_runs
from hosts.study.outcome_table import OutcomeTable, Row
from hosts.study.parts import part_files, sound_runs
from hosts.study.plan import Plan, make_plan
from hosts.study.study_file import StudyFile, read_study_file
from hosts.study.trial_runs import Trial, bytes_of, make_trial_runs, with_columns
from hosts.study.worker_data import FAILED, Counts, duration

_FREE_SPACE = 50e6  # bytes of the disk that the results must leave free


@dataclass(frozen=True)
class StudyOutcome:
    """What a call of `run_study` has completed."""

    folder: Path
    good: bool
    """Whether every run has a row, and at least one of the new runs has all its measures."""
    failed: int
    """Number of failed new runs."""


def run_study(
    file: Path, out: Path | None, scheduler: str | None, workers: int | None, dry: bool = False, again: bool = False
) -> StudyOutcome | None:
    """Check a study, make its missing runs and write their rows. Returns None after a dry run.

    `out`: folder of the results; None: by the name of the study; `scheduler`: address of a scheduler of Dask; None:
    `workers` processes of this machine; `dry`: only print the plan; `again`: make failed runs again. Raises `HostError`
    or `FileError`.
    """
    study, content = read_study_file(file)
    folder = out_folder(out, study, file)
    if folder.exists() and not is_folder(folder):
        raise HostError(f"{folder} is a file; the results of a study are a folder.")
    check_no_link(folder)
    earlier = _earlier_record(folder)
    plan = _plan(study, file, folder, earlier)
    for note in plan.notes:
        print(f"note: {note}", file=sys.stderr)
    if all(job.manoeuvre is not None for job in plan.work.jobs):
        plan = _with_limits(plan, study)  # measures of tests are known only after a run
    if earlier is not None:
        # Columns of tests are known from existing runs.
        plan = with_columns(plan, {n: u for n, u in earlier["measures"].items() if n not in plan.work.columns})
        check_same(folder, earlier, plan.record)
        plan = _with_limits(plan, study)
    with nullcontext() if dry else ResultStore[Row](folder, Row, "runs a study") as store:
        done = np.zeros(plan.runs, dtype=np.bool_)
        if earlier is not None and store is not None:
            done, notes = sound_runs(folder, earlier)
            for note in notes:
                print(f"note: {note}", file=sys.stderr)
            if not again and done.all():
                store.clear()  # after a kill between writing the table and clearing the journal
                update_limits(folder, earlier, plan.record["limits"], content)
                print(f"{plan.runs} of {plan.runs} runs are there: {folder}")
                return StudyOutcome(folder, True, 0)
        trial = make_trial_runs(plan)
        for note in trial.notes:
            print(f"note: {note}", file=sys.stderr)
        plan = _with_limits(with_columns(plan, trial.columns), study)
        plan = replace(plan, work=replace(plan.work, reuse=trial.reuse))
        _print_plan(plan, trial, folder, scheduler, workers)
        if store is None:
            return None
        return _make_missing_runs(plan, trial, folder, content, scheduler, workers, again, store, done)


def _earlier_record(folder: Path) -> dict[str, Any] | None:
    """The record of existing runs; None if there are none. Raises `HostError` if there are rows without a record."""
    record = read_record(folder)
    if record is None and part_files(folder):
        raise HostError(f"{folder} has rows of a study but not its study.json; give another --out.")
    return record


def _plan(study: StudyFile, file: Path, folder: Path, earlier: dict[str, Any] | None) -> Plan:
    """The checked plan, with the named FMU or that of the car; an unchanged car keeps the FMU of earlier runs."""
    if study.car is None:
        return make_plan(study, file, fmu_of_study(study, file))
    digest = car_digest(_car(study.car, file))
    is_unchanged = earlier is not None and earlier.get("car") == digest and (folder / earlier["fmu"]).exists()
    fmu = fmu_of_folder(folder, earlier) if earlier is not None and is_unchanged else fmu_of_study(study, file)
    plan = make_plan(study, file, fmu)
    return replace(plan, record={**plan.record, "car": digest})


def fmu_of_study(study: StudyFile, file: Path) -> Path:
    """The FMU that a study file names, or that of its car, which is built if necessary."""
    if study.fmu is not None:
        return file.parent / study.fmu
    assert study.car is not None
    return fmu_of_car(_car(study.car, file), lambda line: print(line, file=sys.stderr))


def _car(name: str, file: Path) -> str:
    """A car file beside the study file, otherwise a car of the package."""
    file_beside = file.parent / name
    return str(file_beside) if is_file_or_folder(file_beside) else name


def _with_limits(plan: Plan, study: StudyFile) -> Plan:
    limits = limits_record(study.limits, plan.record["measures"], plan.file) if study.limits else {}
    return replace(plan, record={**plan.record, "limits": limits})


def out_folder(out: Path | None, study: StudyFile, file: Path) -> Path:
    """Folder of the results. `out`: the requested one."""
    return out if out is not None else Path("out", study.name or file.stem)


def _print_plan(plan: Plan, trial: Trial, folder: Path, scheduler: str | None, workers: int | None) -> None:
    points, jobs = plan.points.count, plan.work.jobs
    count = 1 if scheduler is not None else workers or available_cores()
    print(f"study       {plan.name}: {points} points x {len(jobs)} = {plan.runs} runs, into {folder}")
    print(f"FMU         {plan.fmu}, {plan.record['model']}, {plan.work.guid}")
    print(f"manoeuvres  {', '.join(job.label for job in jobs)}")
    print(f"parameters  {some_of(plan.work.parameters, 8)}")
    print(f"measures    {some_of(plan.work.columns, 8)}")
    if plan.work.signals:
        print(f"signals     {some_of(plan.work.signals, 8)}")
    seconds = plan.runs * trial.seconds
    workers_text = "on one worker" if count == 1 else f"with {count} workers"
    print(
        f"estimate    {trial.seconds:.3g} s a run, {duration(seconds / count)} in all {workers_text}; "
        f"{_size(bytes_of(plan))} of results",
        flush=True,
    )


def _size(count: float) -> str:
    for unit in ("kB", "MB"):
        count /= 1e3
        if count < 1e3:
            return f"{max(count, 0.1):.3g} {unit}"
    return f"{count / 1e3:.3g} GB"


def _make_missing_runs(
    plan: Plan,
    trial: Trial,
    folder: Path,
    content: bytes,
    scheduler: str | None,
    workers: int | None,
    again: bool,
    store: ResultStore[Row],
    done: NDArray[np.bool_],
) -> StudyOutcome:
    record = read_record(folder)
    if record is None:
        _check_space(bytes_of(plan), folder)
        record = json.loads(json.dumps(plan.record))
        begin_study(folder, record, content, plan.fmu)
    else:
        check_same(folder, record, plan.record)
        record = update_limits(folder, record, plan.record["limits"], content)
    table = OutcomeTable(folder, record, done)
    store.attach_table(table)
    if again:
        failed = table.remove_rows(lambda part: part["status"].to_numpy() == FAILED)
        print(f"{failed} failed runs are repeated")
    count = int(np.count_nonzero(table.done))
    if count:
        print(f"{count} of {plan.runs} runs are there", flush=True)
        _check_space(bytes_of(plan) * (plan.runs - count) / plan.runs, folder)
    if count == plan.runs:
        return StudyOutcome(folder, True, 0)
    return _write_outcomes(
        folder, table, store, make_runs(plan, trial.seconds, table.done.copy(), scheduler, workers), scheduler
    )


def _check_space(needed: float, folder: Path) -> None:
    free = free_space(folder)
    if needed + _FREE_SPACE > free:
        raise HostError(
            f"The results may need {_size(needed)} in {folder}, where {_size(free)} are free, of which "
            f"{_size(_FREE_SPACE)} are left to others; make room, give another --out, or keep fewer signals."
        )


def _write_outcomes(
    folder: Path, table: OutcomeTable, store: ResultStore[Row], outcomes: Generator[Row], scheduler: str | None
) -> StudyOutcome:
    begin, is_lost, counts = clock.monotonic(), False, Counts()
    try:
        with closing(outcomes):
            try:
                for run, outcome in outcomes:
                    store.add(str(run.index), "", (run, outcome))
                    counts.add(outcome)
            except FileError:
                raise
            except BaseException:
                store.write()
                raise
        store.write()
    except KeyboardInterrupt:
        print(_resume_text(table.done), file=sys.stderr)
        raise
    except FileError as error:
        raise FileError(f"{error} {_resume_text(table.done)}") from None
    except HostError:
        raise
    except Exception:  # Dask raises exceptions of many types for killed processes
        if scheduler is None:
            raise
        is_lost = True
    seconds = clock.monotonic() - begin
    if is_lost and not table.done.all():
        print(f"The scheduler at {scheduler} has gone. {_resume_text(table.done)}", file=sys.stderr)
        return StudyOutcome(folder, False, counts.failed)
    rate = counts.made / seconds
    message = f"{counts.made} runs in {duration(seconds)}, {rate:.3g} runs/s, {counts.failed} failed"
    if counts.incomplete:
        message += f", {counts.incomplete} incomplete"
    for line in counts.frequent_messages():
        print(line)
    print(f"{message}; written: {folder}")
    is_incomplete = counts.made > 0 and counts.failed + counts.incomplete == counts.made
    if is_incomplete:
        print(
            "No run has yielded all its measures; the column reason says why. Of a test, measures = [...] beside it "
            "keeps only those that are wanted.",
            file=sys.stderr,
        )
    return StudyOutcome(folder, not is_incomplete, counts.failed)


def _resume_text(done: NDArray[np.bool_]) -> str:
    return f"{np.count_nonzero(done)} of {len(done)} runs are written and stay; the same command makes the others."
