"""Runs of an FMU as a function of one parameter, of which one yields the measure that is wanted."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from hosts.common.display_units import Shown, number_in, shown_in
from hosts.common.errors import HostError
from hosts.common.units import conversion
from hosts.measures.limits import column_of
from hosts.study.jobs import Job
from hosts.study.plan import Plan
from hosts.study.study_runs import OneProcess
from hosts.study.target_search import SearchResult, seek
from hosts.study.worker_data import Outcome
from hosts.study.worker_data import Run as StudyRun


@dataclass(frozen=True)
class Target:
    """The measure and the value that are sought."""

    measure: str
    """As the user names it."""
    value: float
    unit: str
    """Of `value`; empty: that of the measure."""
    by: str
    range: tuple[float, float] | None
    """In the unit of the FMU; None: that of the study file, else of the FMU."""


class TargetRuns:
    """Runs of an FMU as a function of one parameter."""

    def __init__(self, plan: Plan, target: Target) -> None:
        self.plan, self.target = plan, target
        (self.parameter,) = plan.points.parameters
        self.job, self.column = self._job()
        is_test = self.job.manoeuvre is None
        self.work = replace(plan.work, jobs=(self.job,), columns=() if is_test else plan.work.columns)
        self.processes: OneProcess
        self.unit, self.wanted, self.shown = "", target.value, Shown("", 1.0)
        if not is_test:
            self._take_unit(plan.record["units"][self.column])
        self._made: dict[float, Outcome] = {}
        self._count = 0

    def _job(self) -> tuple[Job, str]:
        """The manoeuvre that yields the measure, and its column."""
        name, jobs = self.target.measure, self.plan.work.jobs
        by_prefix = [job for job in jobs if job.manoeuvre is None and name.startswith(f"{job.label}.")]
        units = {c: self.plan.record["measures"][c] for c in self.plan.work.columns}
        fit = by_prefix or [job for job in jobs if (job.manoeuvre is not None) == (name in units)]
        if not fit:
            name, fit = column_of(name, units, "--target"), list(jobs)
        if len(fit) > 1:
            labels = " and ".join(job.label for job in fit)
            remedy = "give MANOEUVRE.MEASURE" if fit[0].manoeuvre is None else "leave one of them in the study file"
            raise HostError(f"--target {name}: it could be of {labels}; {remedy}.")
        job = fit[0]
        if job.manoeuvre is not None:
            return job, name
        short = name.removeprefix(f"{job.label}.")
        return replace(job, measures=(short,)), f"{job.label}.{short}"

    def _take_unit(self, unit: str) -> None:
        """Learn the unit of the measure: what is wanted in it, and how it is shown."""
        target_unit = self.target.unit
        factor = conversion(target_unit, unit, f"--target {self.target.measure}") if target_unit else 1.0
        self.unit, self.wanted = unit, factor * self.target.value
        self.shown = Shown(target_unit, 1.0 / factor) if target_unit else shown_in(unit, self.column)

    def found(self, start: float) -> SearchResult:
        """The search from a start value of the parameter."""
        low, high, log = self.parameter.low, self.parameter.high, self.parameter.log
        if self.job.manoeuvre is None:
            self._first(low)
        return seek(self.measure, self.wanted, low, high, log, start)

    def _first(self, low: float) -> None:
        """A run that tells which measures a test has; it is kept."""
        outcome = self._run(low)
        if not outcome.units:  # it failed, so that nobody knows them
            outcome = self._run(self.parameter.high)
        if not outcome.units:
            raise HostError(f"The runs at both ends of the range of {self.target.by} fail: {outcome.reason}")
        column_of(self.column, outcome.units, "--target")
        self._take_unit(outcome.units[self.column])

    def _run(self, x: float) -> Outcome:
        if x not in self._made:
            self._made[x] = self.processes.run(StudyRun(0, {self.target.by: x}))
        return self._made[x]

    def measure(self, x: float) -> tuple[float, str]:
        """See `seek`."""
        outcome = self._run(x)
        y = outcome.measures.get(self.column, math.nan)
        reason = "" if math.isfinite(y) else outcome.reason or "there is no such measure in the run"
        self._count += 1
        result = self.y_text(y) if math.isfinite(y) else f"fails: {reason}"
        print(f"run {self._count}: {self.target.by} = {self.x_text(x)}: {result}", flush=True)
        return y, reason

    def x_text(self, x: float) -> str:
        """A value of the parameter with its unit."""
        return number_in(x, self.parameter.unit, ".5g")

    def y_text(self, y: float) -> str:
        """A value of the measure with its unit."""
        return number_in(self.shown.factor * y, self.shown.unit, ".5g")
