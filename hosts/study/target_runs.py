"""Runs of an FMU as a function of one parameter, for the search of a target value."""

import math
from dataclasses import dataclass, replace

from hosts.common.display_units import Shown, number_in, shown_in
from hosts.common.errors import HostError
from hosts.common.units import conversion
from hosts.measures.limits import column_of
from hosts.study.jobs import Job
from hosts.study.plan import Plan
from hosts.study.study_runs import SingleProcess
from hosts.study.target_search import SearchResult, TargetSearch
from hosts.study.worker_data import Outcome
from hosts.study.worker_data import Run as StudyRun


@dataclass(frozen=True)
class Target:
    """A target value of a measure, and the parameter that is sought."""

    measure: str
    """Name as the user writes it."""
    value: float
    unit: str
    """Unit of `value`; empty: unit of the measure."""
    by: str
    """Name of the parameter."""
    range: tuple[float, float] | None
    """Range of the parameter in the unit of the FMU; None: range of the study file, otherwise of the FMU."""


class TargetRuns:
    """Runs of an FMU as a function of one parameter."""

    def __init__(self, plan: Plan, target: Target) -> None:
        self.plan, self.target = plan, target
        (self.parameter,) = plan.points.parameters
        self.job, self.column = self._job_and_column()
        is_test = self.job.manoeuvre is None
        self.work = replace(plan.work, jobs=(self.job,), columns=() if is_test else plan.work.columns)
        self.processes: SingleProcess
        self.unit, self.target_value, self.display = "", target.value, Shown("", 1.0)
        if not is_test:
            self._set_unit(plan.record["units"][self.column])
        self._outcomes: dict[float, Outcome] = {}
        self._count = 0

    def _job_and_column(self) -> tuple[Job, str]:
        """The job that yields the measure, and its column. Raises `HostError` if there is none, or several."""
        name, jobs = self.target.measure, self.plan.work.jobs
        named = [job for job in jobs if job.manoeuvre is None and name.startswith(f"{job.label}.")]
        units = {c: self.plan.record["measures"][c] for c in self.plan.work.columns}
        candidates = named or [job for job in jobs if (job.manoeuvre is not None) == (name in units)]
        if not candidates:
            name, candidates = column_of(name, units, "--target"), list(jobs)
        if len(candidates) > 1:
            labels = " and ".join(job.label for job in candidates)
            remedy = (
                "give MANOEUVRE.MEASURE" if candidates[0].manoeuvre is None else "leave one of them in the study file"
            )
            raise HostError(f"--target {name}: it could be of {labels}; {remedy}.")
        job = candidates[0]
        if job.manoeuvre is not None:
            return job, name
        measure = name.removeprefix(f"{job.label}.")
        return replace(job, measures=(measure,)), f"{job.label}.{measure}"

    def _set_unit(self, unit: str) -> None:
        """Set the unit of the measure, and convert the target value to it."""
        target_unit = self.target.unit
        factor = conversion(target_unit, unit, f"--target {self.target.measure}") if target_unit else 1.0
        self.unit, self.target_value = unit, factor * self.target.value
        self.display = Shown(target_unit, 1.0 / factor) if target_unit else shown_in(unit, self.column)

    def search_from(self, start: float) -> SearchResult:
        """Search from a start value of the parameter."""
        low, high, log = self.parameter.low, self.parameter.high, self.parameter.log
        if self.job.manoeuvre is None:
            self._read_columns(low)
        return TargetSearch(self.measure, self.target_value, (low, high), log, start).search()

    def _read_columns(self, low: float) -> None:
        """Make the run at an end of the range, from which the measures of a test and their units are known."""
        outcome = self._outcome_at(low)
        if not outcome.units:  # it failed
            outcome = self._outcome_at(self.parameter.high)
        if not outcome.units:
            raise HostError(f"The runs at both ends of the range of {self.target.by} fail: {outcome.reason}")
        column_of(self.column, outcome.units, "--target")
        self._set_unit(outcome.units[self.column])

    def _outcome_at(self, x: float) -> Outcome:
        if x not in self._outcomes:
            self._outcomes[x] = self.processes.run(StudyRun(0, {self.target.by: x}))
        return self._outcomes[x]

    def measure(self, x: float) -> tuple[float, str]:
        """The measure at a value of the parameter, or NaN and the reason; see `TargetSearch`."""
        outcome = self._outcome_at(x)
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
        return number_in(self.display.factor * y, self.display.unit, ".5g")
