"""A few runs before a study: whether it works, whether instances can be reused, how long it will take."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.study.jobs import Job
from hosts.study.plan import Plan
from hosts.study.study_runs import OneProcess
from hosts.study.worker_data import FAILED, INCOMPLETE, Outcome, Work

_LONGEST = 2.0  # s of a run that is repeated for the test of reuse
_ROW = 60.0  # bytes of a row in a part beside its numbers
_COMPRESSED = 1.0  # stored over raw bytes of signals, at worst


@dataclass(frozen=True)
class Trial:
    """The result of the runs before a study."""

    seconds: float
    """Of a run, mean over the manoeuvres."""
    reuse: bool
    """Whether an instance gives the same bits after a reset."""
    columns: dict[str, str]
    """Measures of tests, with units."""
    notes: tuple[str, ...]


def try_out(plan: Plan) -> Trial:
    """Make runs of the first point, and of others where it fails, in a process of their own.

    Raises `HostError`: no run of a manoeuvre can be made, with the reason of the first.
    """
    work, notes = replace(plan.work, reuse=False), list[str]()
    columns: dict[str, str] = {}
    last = plan.points.count - 1
    points = list(dict.fromkeys((0, last // 2, last)))
    seconds, good = 0.0, []
    for number, job in enumerate(work.jobs):
        outcome, point = None, 0
        for point in points:
            # with no columns known, a test tells which it has
            trial_work = work if job.manoeuvre is not None else replace(work, columns=())
            outcome = _outcomes(trial_work, plan, number, [point])[0]
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
        good.append((number, job, point, outcome))
    reuse, reused = _reuse(plan, good)
    if reused is not None:
        seconds += (reused - good[0][3].wall) / len(work.jobs)
    elif any(job.manoeuvre is not None for job in work.jobs):
        notes.append("The FMU does not give the same bits after a reset: each run loads a new instance.")
    return Trial(max(seconds, 1e-6), reuse, columns, tuple(notes))


def _columns(units: Mapping[str, str], job: Job, where: str) -> dict[str, str]:
    """Of all measures of a test with their units those that the study asks for; a test tells them by a run only."""
    if not job.measures:
        return dict(units)
    for name in job.measures:
        if f"{job.label}.{name}" not in units:
            measures = [column.removeprefix(f"{job.label}.") for column in units]
            hint = did_you_mean(name, measures, f"it has {', '.join(measures)}")
            raise HostError(f"{where}.measures: the test {job.test} has no measure '{name}'{hint}")
    return {column: unit for column, unit in units.items() if column.removeprefix(f"{job.label}.") in job.measures}


def _outcomes(work: Work, plan: Plan, number: int, points: Sequence[int]) -> list[Outcome]:
    """Of the job of a number at some points, one after the other in one process."""
    with OneProcess(work, plan.fmu) as processes:
        return [processes.run(plan.runs_at([point * len(work.jobs) + number])[0]) for point in points]


def _reuse(plan: Plan, good: list[tuple[int, Job, int, Outcome]]) -> tuple[bool, float | None]:
    """Whether a run has the same bits in an instance that has made another run; and what it takes there."""
    driven = [run for run in good if run[1].manoeuvre is not None]
    if not driven:
        return False, None
    number, job, point, outcome = driven[0]
    assert job.manoeuvre is not None
    share = min(1.0, _LONGEST / max(outcome.wall, 1e-9))
    samples = max(1, math.floor(share * job.manoeuvre.stop_time / job.step)) + 1
    stop = (samples - 1) * job.step
    # every output at every step, so that nothing can differ unseen
    short = replace(job, manoeuvre=replace(job.manoeuvre, stop_time=stop), every=1, samples=samples)
    jobs = (*plan.work.jobs[:number], short, *plan.work.jobs[number + 1 :])
    work = replace(plan.work, jobs=jobs, reuse=True, measures=(), signals=plan.outputs)
    other_point = (point + plan.points.count // 2) % plan.points.count
    first, _, again = _outcomes(work, plan, number, (point, other_point, point))
    if first.status == FAILED or again.status == FAILED or first.signals is None or again.signals is None:
        return False, None
    same = first.signals.tobytes() == again.signals.tobytes()
    return same, again.wall / share if same else None


def with_columns(plan: Plan, columns: Mapping[str, str]) -> Plan:
    """The plan with the measures of tests."""
    names = tuple(dict.fromkeys((*plan.work.columns, *columns)))
    record: dict[str, Any] = {
        **plan.record,
        "measures": {**plan.record["measures"], **columns},
        "units": {**plan.record["units"], **columns},
    }
    return replace(plan, work=replace(plan.work, columns=names), record=record)


def bytes_of(plan: Plan) -> float:
    """What the results will need at most."""
    numbers = len(plan.work.parameters) + len(plan.work.columns) + 5
    signals = sum(8.0 * job.samples * len(plan.work.signals) for job in plan.work.jobs)
    return plan.runs * (8.0 * numbers + _ROW) + _COMPRESSED * plan.points.count * signals
