"""Runs of a study in processes of this machine, each from an instance of the FMU to an outcome."""

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
from hosts.study.jobs import Job, perform_test
from hosts.study.worker_data import DONE, FAILED, INCOMPLETE, Outcome, Run, Work, seed_of

if TYPE_CHECKING:
    from hosts.driving.pilots.course_follower import CourseFollower

_MAX_MISSING = 3
_MAX_MESSAGES = 5
_MAX_MESSAGE_LENGTH = 300  # characters of a message


class Bench:
    """Makes runs of an FMU in sequence, in one instance if a reset reproduces results to the last bit."""

    def __init__(self, work: Work, path: Path) -> None:
        self._work, self._source = work, work.fmu.at(path)
        self._fmu = LoadedFmu(self._source)

    def close(self) -> None:
        """Free the instance."""
        self._fmu.close()

    def __call__(self, run: Run, tell: Callable[[Any], None]) -> Outcome:
        """Make a run of the study; see `run`."""
        work = self._work
        point, number = divmod(run.index, len(work.jobs))
        return self.run(work.jobs[number], run.values, seed_of(work.seed, point))

    def run(self, job: Job, values: Mapping[str, Value], seed: int) -> Outcome:
        """Make a run; an error becomes its outcome. `seed`: seed for functions of the user."""
        begin = clock.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of NumPy, about numbers that the outcome reports
                outcome = (
                    self._run_test(job, values) if job.manoeuvre is None else self._run_manoeuvre(job, values, seed)
                )
        except Exception as error:
            message = str(error) if isinstance(error, HostError) else f"{type(error).__name__}: {error}"
            outcome = Outcome(FAILED, message)
        if outcome.status == FAILED or not self._work.reuse:
            self.close()  # after a failure a reset may not be complete
        outcome.wall = clock.perf_counter() - begin
        return outcome

    def _run_manoeuvre(self, job: Job, values: Mapping[str, Value], seed: int) -> Outcome:
        assert job.manoeuvre is not None
        fmu, work = self._fmu.fresh(), self._work
        manoeuvre = with_start_values(with_names_of(job.manoeuvre, fmu.variables), values)
        driver: CourseFollower | None = None
        if manoeuvre.driver:
            driver = driver_of(fmu, manoeuvre)
        result = run(fmu, manoeuvre, job.step, driver)
        outcome = _outcome_of_result(result)
        if job.every:
            outcome.signals = sampled_signals(result, work.signals, job)
        if outcome.status == DONE:
            parameters = {**values, "seed": seed}
            measures = [m for measure in work.measures for m in measure.evaluate(result, parameters)]
            _set_measures(outcome, [(m.name, m) for m in measures])
        return outcome

    def _run_test(self, job: Job, values: Mapping[str, Value]) -> Outcome:
        record = perform_test(job, self._work.fmu.path.name, self._source, values)
        outcome = Outcome(simulated=sum(result.simulated for result in record.runs.values()))
        outcome.messages = distinct_messages(record.notes)
        pairs = [(measure_column(job, m), m) for m in record.measures if not job.measures or m.name in job.measures]
        if not self._work.columns:  # a trial, whose measures become the columns
            outcome.units = {measure_column(job, m): m.unit for m in record.measures}
        _set_measures(outcome, [(name, m) for name, m in pairs if not self._work.columns or name in self._work.columns])
        return outcome


def distinct_messages(messages: Sequence[str]) -> tuple[str, ...]:
    """The first distinct messages, shortened if too long."""
    result = dict.fromkeys(" ".join(message.split()) for message in messages)
    return tuple(
        m if len(m) <= _MAX_MESSAGE_LENGTH else f"{m[: _MAX_MESSAGE_LENGTH - 3]}..."
        for m in list(result)[:_MAX_MESSAGES]
    )


def with_start_values(manoeuvre: Manoeuvre, values: Mapping[str, Value]) -> Manoeuvre:
    """The manoeuvre with values of parameters added to its start values."""
    return replace(manoeuvre, start={**manoeuvre.start, **values})


def measure_column(job: Job, measure: Measure) -> str:
    """The column of a measure of a test."""
    return f"{job.label}.{measure.name}"


def sampled_signals(result: Result, names: Sequence[str], job: Job) -> NDArray[np.float64]:
    """Values of signals at the stored times, shape (samples, signals); NaN after an early end."""
    values = np.full((job.samples, len(names)), np.nan)
    rows = result.values[:: job.every, [result.names.index(n) for n in names]][: job.samples]
    values[: len(rows)] = rows
    return values


def _outcome_of_result(result: Result) -> Outcome:
    """The outcome of a run without measures; failed if a step was refused or an output is not finite."""
    input_notes = [": ".join(parts).replace("--step ", "step = ") for parts in result.missed]
    outcome = Outcome(simulated=result.simulated, messages=distinct_messages(input_notes + result.messages))
    if reason := result.not_finite():
        outcome.status, outcome.reason = FAILED, reason
    elif result.refusal:
        outcome.status, outcome.reason = FAILED, sentence_of(result.refusal)
    return outcome


def _set_measures(outcome: Outcome, measures: Sequence[tuple[str, Measure]]) -> None:
    outcome.measures = {name: float(m.value) for name, m in measures}
    outcome.missing = tuple(name for name, m in measures if m.is_missing)
    missing = [f"{name}: {m.note or 'it is not a number'}" for name, m in measures if m.is_missing]
    if missing:
        suffix = [f"and {len(missing) - _MAX_MISSING} more"] if len(missing) > _MAX_MISSING else []
        outcome.status, outcome.reason = INCOMPLETE, "; ".join(missing[:_MAX_MISSING] + suffix)


def experiment_of(work: Work, path: Path) -> Experiment[Run, Outcome]:
    """Runs of a study as an experiment with a `Bench` in each process. `path`: path of the FMU."""
    reads = [path, *(file for start in _start_values(work) for file in files_of(start))]
    experiment = Experiment("study", Bench(work, path.absolute()), Outcome, partial(_label, work), reads)
    return experiment if work.time_limit is None else replace(experiment, limit=work.time_limit, in_all=True)


def _label(work: Work, run: Run) -> str:
    return f"study: {work.jobs[run.index % len(work.jobs)].label}"


def _start_values(work: Work) -> list[Mapping[str, Value]]:
    return [job.manoeuvre.start for job in work.jobs if job.manoeuvre is not None] or [{}]


def report_start(work: Work, run: Run) -> None:
    """Report a start position of a run that is off its road."""
    report_starts({**start, **run.values} for start in _start_values(work))


def outcome_of(work: Work, result: Outcome | Lost) -> Outcome:
    """The outcome of a run; failed if its process crashed or exceeded the time limit."""
    if not isinstance(result, Lost):
        return result
    if result.late:
        setting = "" if work.time_limit is None else " (time_limit)"
        return Outcome(FAILED, f"The run {result.how}{setting}.", wall=work.time_limit or 0.0)
    return Outcome(FAILED, f"The process of the run {result.how}.")


class SingleProcess(Closable):
    """Makes runs in sequence in one process."""

    def __init__(self, work: Work, path: Path) -> None:
        self._work, self._pool = work, experiment_of(work, path).pool()

    def close(self) -> None:
        """End the process."""
        self._pool.close()

    def run(self, run: Run) -> Outcome:
        """Make a run."""
        report_start(self._work, run)
        return outcome_of(self._work, self._pool.run(run))
