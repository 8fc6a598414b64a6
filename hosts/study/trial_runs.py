"""Trial runs before a study: whether runs succeed, whether instances can be reused, and the time of a run."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.study.jobs import Job
from hosts.study.plan import Plan
from hosts.study.study_runs import SingleProcess
from hosts.study.worker_data import FAILED, INCOMPLETE, Outcome, Work

_MAX_RUN_TIME = 2.0  # s of computing for a run of the test of reuse
_ROW_BYTES = 60.0  # of a row in a part beside its numbers
_COMPRESSION = 1.0  # largest ratio of stored and raw bytes of signals


@dataclass(frozen=True)
class Trial:
    """The result of trial runs."""

    seconds: float
    """Computing time of a run, mean over the jobs."""
    reuse: bool
    """Whether an instance reproduces results to the last bit after a reset."""
    columns: dict[str, str]
    """Measures of tests, with units."""
    notes: tuple[str, ...]


def make_trial_runs(plan: Plan) -> Trial:
    """Make runs of the first point, and if they fail of the middle and the last one, in a separate process.

    Raises `HostError` if all runs of a job fail, with the reason of the last.
    """
    work, notes = replace(plan.work, reuse=False), list[str]()
    columns: dict[str, str] = {}
    last_point = plan.points.count - 1
    points = list(dict.fromkeys((0, last_point // 2, last_point)))
    seconds, completed = 0.0, []
    for number, job in enumerate(work.jobs):
        outcome, point = None, 0
        for point in points:
            # Without columns in the work, a test reports all its measures.
            trial_work = work if job.manoeuvre is not None else replace(work, columns=())
            outcome = _outcomes_at(trial_work, plan, number, [point])[0]
            if outcome.status != FAILED:
                break
            notes.append(f"Run {point * len(work.jobs) + number}, {job.label}, fails: {outcome.reason}")
        assert outcome is not None
        if outcome.status == FAILED:
            numbers = ", ".join(str(p * len(work.jobs) + number) for p in points)
            raise HostError(f"No run of {job.label} that was tried ({numbers}) reached its end: {outcome.reason}")
        if outcome.status == INCOMPLETE:
            notes.append(f"Run {point * len(work.jobs) + number}, {job.label}, is incomplete: {outcome.reason}")
        columns |= _columns(outcome.units, job, f"{plan.file}: manoeuvres[{number + 1}]")
        seconds += outcome.wall / len(work.jobs)
        completed.append((number, job, point, outcome))
    reuse, reset_seconds = _check_reuse(plan, completed)
    if reset_seconds is not None:
        seconds += (reset_seconds - completed[0][3].wall) / len(work.jobs)
    elif any(job.manoeuvre is not None for job in work.jobs):
        notes.append("The FMU does not give the same bits after a reset: each run loads a new instance.")
    return Trial(max(seconds, 1e-6), reuse, columns, tuple(notes))


def _columns(units: Mapping[str, str], job: Job, where: str) -> dict[str, str]:
    """Requested measures of a test with their units. `units`: units of all measures, known after a run."""
    if not job.measures:
        return dict(units)
    for name in job.measures:
        if f"{job.label}.{name}" not in units:
            measures = [column.removeprefix(f"{job.label}.") for column in units]
            hint = did_you_mean(name, measures, f"it has {', '.join(measures)}")
            raise HostError(f"{where}.measures: the test {job.test} has no measure '{name}'{hint}")
    return {column: unit for column, unit in units.items() if column.removeprefix(f"{job.label}.") in job.measures}


def _outcomes_at(work: Work, plan: Plan, number: int, points: Sequence[int]) -> list[Outcome]:
    """Outcomes of a job at points, in sequence in one process. `number`: index of the job."""
    with SingleProcess(work, plan.fmu) as processes:
        return [processes.run(plan.runs_at([point * len(work.jobs) + number])[0]) for point in points]


def _check_reuse(plan: Plan, completed: list[tuple[int, Job, int, Outcome]]) -> tuple[bool, float | None]:
    """Whether a reset instance reproduces a run to the last bit, and the time of that run, s; otherwise None."""
    manoeuvre_runs = [run for run in completed if run[1].manoeuvre is not None]
    if not manoeuvre_runs:
        return False, None
    number, job, point, outcome = manoeuvre_runs[0]
    assert job.manoeuvre is not None
    fraction = min(1.0, _MAX_RUN_TIME / max(outcome.wall, 1e-9))
    samples = max(1, math.floor(fraction * job.manoeuvre.stop_time / job.step)) + 1
    stop = (samples - 1) * job.step
    # All outputs at all steps are compared.
    short = replace(job, manoeuvre=replace(job.manoeuvre, stop_time=stop), every=1, samples=samples)
    jobs = (*plan.work.jobs[:number], short, *plan.work.jobs[number + 1 :])
    work = replace(plan.work, jobs=jobs, reuse=True, measures=(), signals=plan.outputs)
    other_point = (point + plan.points.count // 2) % plan.points.count
    first, _, again = _outcomes_at(work, plan, number, (point, other_point, point))
    if first.status == FAILED or again.status == FAILED or first.signals is None or again.signals is None:
        return False, None
    is_equal = first.signals.tobytes() == again.signals.tobytes()
    return is_equal, again.wall / fraction if is_equal else None


def with_columns(plan: Plan, columns: Mapping[str, str]) -> Plan:
    """The plan with the columns of measures of tests added."""
    names = tuple(dict.fromkeys((*plan.work.columns, *columns)))
    record: dict[str, Any] = {
        **plan.record,
        "measures": {**plan.record["measures"], **columns},
        "units": {**plan.record["units"], **columns},
    }
    return replace(plan, work=replace(plan.work, columns=names), record=record)


def bytes_of(plan: Plan) -> float:
    """Largest size of the results, bytes."""
    numbers = len(plan.work.parameters) + len(plan.work.columns) + 5
    signals = sum(8.0 * job.samples * len(plan.work.signals) for job in plan.work.jobs)
    return plan.runs * (8.0 * numbers + _ROW_BYTES) + _COMPRESSION * plan.points.count * signals
