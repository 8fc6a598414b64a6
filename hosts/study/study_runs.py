"""Runs of a study: from an instance of the FMU to a row, in processes of this machine."""

import time as clock
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ali3.isolated_processes import Lost
from ali3.message_text import sentence_of
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.road import report_starts
from hosts.driving.co_simulation import run
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.result import Result
from hosts.experiment.experiment import Experiment
from hosts.fmu.fmu_source import LoadedFmu
from hosts.fmu.own_process import files_of
from hosts.measures.measure import Measure
from hosts.study.jobs import Job, performed
from hosts.study.worker_data import DONE, FAILED, INCOMPLETE, Outcome, Run, Work, seed_of

if TYPE_CHECKING:
    from hosts.driving.driver import Driver

_MOST_NOTES = 3
_MOST_MESSAGES = 5
_LONGEST = 300  # characters of a message


class Bench:
    """An FMU on which runs are made one after the other, in one instance where that gives the same bits."""

    def __init__(self, work: Work, path: Path) -> None:
        self._work, self._source = work, work.fmu.at(path)
        self._fmu = LoadedFmu(self._source)

    def close(self) -> None:
        """Free the instance."""
        self._fmu.close()

    def __call__(self, run: Run, tell: Callable[[Any], None]) -> Outcome:
        """See `run`; as work for a process."""
        work = self._work
        point, number = divmod(run.index, len(work.jobs))
        return self.run(work.jobs[number], run.values, seed_of(work.seed, point))

    def run(self, job: Job, values: Mapping[str, Value], seed: int) -> Outcome:
        """Make a run; whatever goes wrong in it is its outcome. `seed`: for functions of the user's."""
        begin = clock.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of NumPy, about numbers that the outcome tells of
                outcome = self._test(job, values) if job.manoeuvre is None else self._drive(job, values, seed)
        except Exception as error:
            message = str(error) if isinstance(error, HostError) else f"{type(error).__name__}: {error}"
            outcome = Outcome(FAILED, message)
        if outcome.status == FAILED or not self._work.reuse:
            self.close()  # what has failed may have left more than a reset clears
        outcome.wall = clock.perf_counter() - begin
        return outcome

    def _drive(self, job: Job, values: Mapping[str, Value], seed: int) -> Outcome:
        assert job.manoeuvre is not None
        fmu, work = self._fmu.fresh(), self._work
        manoeuvre = started(with_names_of(job.manoeuvre, fmu.variables), values)
        driver: Driver | None = None
        if manoeuvre.driver:
            driver = driver_of(fmu, manoeuvre)
        result = run(fmu, manoeuvre, job.step, driver)
        outcome = _of_result(result)
        if job.every:
            outcome.signals = sampled(result, work.signals, job)
        if outcome.status == DONE:
            parameters = {**values, "seed": seed}
            measures = [m for measure in work.measures for m in measure.evaluate(result, parameters)]
            _take(outcome, [(m.name, m) for m in measures])
        return outcome

    def _test(self, job: Job, values: Mapping[str, Value]) -> Outcome:
        record = performed(job, self._work.fmu.path.name, self._source, values)
        outcome = Outcome(simulated=sum(result.simulated for result in record.runs.values()))
        outcome.messages = said(record.notes)
        pairs = [(column(job, m), m) for m in record.measures if not job.measures or m.name in job.measures]
        if not self._work.columns:  # a trial: what it measures becomes the columns
            outcome.units = {column(job, m): m.unit for m in record.measures}
        _take(outcome, [(name, m) for name, m in pairs if not self._work.columns or name in self._work.columns])
        return outcome


def said(messages: Sequence[str]) -> tuple[str, ...]:
    """The first different sentences, each once and not too long."""
    result = dict.fromkeys(" ".join(message.split()) for message in messages)
    return tuple(m if len(m) <= _LONGEST else f"{m[: _LONGEST - 3]}..." for m in list(result)[:_MOST_MESSAGES])


def started(manoeuvre: Manoeuvre, values: Mapping[str, Value]) -> Manoeuvre:
    """The manoeuvre with values of parameters over its start values."""
    return replace(manoeuvre, start={**manoeuvre.start, **values})


def column(job: Job, measure: Measure) -> str:
    """The column of a measure of a test."""
    return f"{job.label}.{measure.name}"


def sampled(result: Result, names: Sequence[str], job: Job) -> NDArray[np.float64]:
    """Values of signals at the times that are kept, of shape (samples, signals); NaN after an early end."""
    values = np.full((job.samples, len(names)), np.nan)
    rows = result.values[:: job.every, [result.names.index(n) for n in names]][: job.samples]
    values[: len(rows)] = rows
    return values


def _of_result(result: Result) -> Outcome:
    """Whether the run reached its end with numbers."""
    missed = [": ".join(parts).replace("--step ", "step = ") for parts in result.missed]
    end = Outcome(simulated=result.simulated, messages=said(missed + result.messages))
    if reason := result.not_finite():
        end.status, end.reason = FAILED, reason
    elif result.refusal:
        end.status, end.reason = FAILED, sentence_of(result.refusal)
    return end


def _take(outcome: Outcome, measures: Sequence[tuple[str, Measure]]) -> None:
    outcome.measures = {name: float(m.value) for name, m in measures}
    outcome.missing = tuple(name for name, m in measures if m.is_missing)
    missing = [f"{name}: {m.note or 'it is not a number'}" for name, m in measures if m.is_missing]
    if missing:
        suffix = [f"and {len(missing) - _MOST_NOTES} more"] if len(missing) > _MOST_NOTES else []
        outcome.status, outcome.reason = INCOMPLETE, "; ".join(missing[:_MOST_NOTES] + suffix)


def experiment_of(work: Work, path: Path) -> Experiment[Run, Outcome]:
    """Runs of a study as an experiment, with a `Bench` in each process. `path`: of the FMU."""
    reads = [path, *(file for start in _starts(work) for file in files_of(start))]
    experiment = Experiment("study", Bench(work, path.absolute()), Outcome, partial(_label, work), reads)
    return experiment if work.time_limit is None else replace(experiment, limit=work.time_limit, in_all=True)


def _label(work: Work, run: Run) -> str:
    return f"study: {work.jobs[run.index % len(work.jobs)].label}"


def _starts(work: Work) -> list[Mapping[str, Value]]:
    return [job.manoeuvre.start for job in work.jobs if job.manoeuvre is not None] or [{}]


def report_start(work: Work, run: Run) -> None:
    """Tell of a start of a run that is beside its road."""
    report_starts({**start, **run.values} for start in _starts(work))


def outcome_of(work: Work, result: Outcome | Lost) -> Outcome:
    """The outcome of a run; that it crashed or took too long is one."""
    if not isinstance(result, Lost):
        return result
    if result.late:
        which = "" if work.time_limit is None else " (time_limit)"
        return Outcome(FAILED, f"The run {result.how}{which}.", wall=work.time_limit or 0.0)
    return Outcome(FAILED, f"The process of the run {result.how}.")


class OneProcess(Closable):
    """Makes runs one after the other, each time in the same process."""

    def __init__(self, work: Work, path: Path) -> None:
        self._work, self._pool = work, experiment_of(work, path).pool()

    def close(self) -> None:
        """End the process."""
        self._pool.close()

    def run(self, run: Run) -> Outcome:
        """Make a run."""
        report_start(self._work, run)
        return outcome_of(self._work, self._pool.run(run))
