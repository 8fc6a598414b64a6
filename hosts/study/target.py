"""Finds the value of a parameter at which a measure is what is wanted: ``ali3 study --target MEASURE=VALUE``."""

from __future__ import annotations

import math
import re
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot as plt

from ali3.chart_style import BLUE, RED, STYLE
from ali3.charts import drawing
from ali3.decimal_number import parse_number
from ali3.files import make_folder, write_json
from ali3.write_parameter_set import write_parameter_set
from hosts.common.display_units import Shown, number_in, shown_in, titled
from hosts.common.errors import HostError
from hosts.common.numbers import or_null
from hosts.common.units import conversion
from hosts.fmu.fmu import described
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.variables import Variable, Variables
from hosts.measures.limits import column_of
from hosts.study.analysis.data import without_round_off
from hosts.study.campaign import fmu_of_study, out_folder
from hosts.study.folder import check_no_link
from hosts.study.jobs import Job
from hosts.study.plan import Plan, make_plan
from hosts.study.study_file import ParameterEntry, SamplingEntry, StudyFile, read_study_file
from hosts.study.study_runs import OneProcess
from hosts.study.target_search import TOLERANCE, Run, SearchResult, seek
from hosts.study.worker_data import Outcome
from hosts.study.worker_data import Run as StudyRun

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_VALUE = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d,;\s].*?|)\s*")


@dataclass(frozen=True)
class Target:
    """What is asked for."""

    measure: str
    """As the user names it."""
    value: float
    unit: str
    """Of `value`; empty: that of the measure."""
    by: str
    range: tuple[float, float] | None
    """In the unit of the FMU; None: that of the study file, else of the FMU."""


def target_of(text: str, by: str, limits: str | None) -> Target:
    """What the options ask for.

    `text`: ``MEASURE=VALUE``, the value with a unit or without; `limits`: ``LOW:HIGH``. Raises `HostError`: it is not
    of this form.
    """
    name, _, value = (part.strip() for part in text.partition("="))
    found = _VALUE.fullmatch(value)
    if not name or found is None:
        raise HostError(f"--target {text}: it must be MEASURE=VALUE, such as 'understeer_gradient=1.3 deg/g'.")
    try:
        ends = None if limits is None else tuple(parse_number(end) for end in limits.split(":"))
        wanted = parse_number(found[1])
    except ValueError as error:
        between = "" if limits is None else f" --between {limits}"
        raise HostError(f"--target {text}{between}: {error}.") from None
    if ends is not None and not (len(ends) == 2 and ends[0] < ends[1]):
        raise HostError(f"--between {limits}: it must be LOW:HIGH, the smaller number first.")
    return Target(name, wanted, found[2], by, None if ends is None else (ends[0], ends[1]))


def find_target(file: Path, target: Target, out: Path | None) -> bool:
    """Seek the value, print and write what was found; whether the measure can be what is wanted.

    `file`: a study file: its FMU or car, its manoeuvres and ``[start]``; its other parameters stay as the FMU has them;
    `out`: folder of the files. Raises `HostError`: there is no such parameter or measure, or the unit is one of another
    quantity.
    """
    study, _ = read_study_file(file)
    fmu = fmu_of_study(study, file)
    plan = _plan(study, file, fmu, target)
    search = _Search(plan, target)
    folder = out if out is not None else out_folder(None, study, file) / "target"
    make_folder(folder)
    check_no_link(folder)
    with OneProcess(search.work, fmu) as search.processes:
        found = search.found(_start(study, target.by, fmu))
    lines = search.words(found)
    print("\n".join(lines))
    stem = re.sub(r"[^A-Za-z0-9]+", "_", f"{search.column} by {target.by}").strip("_")
    files = [
        drawing(_figure(search, found), "").write(folder / f"{stem}.svg"),
        _record(search, found, lines, folder / f"{stem}.json"),
    ]
    parameters = folder / f"{stem}.ssv"
    parameters.unlink(missing_ok=True)  # of an earlier search
    if found.met and found.best is not None:
        inputs = _parameter_set(plan, study, target.by, found.best.x, parameters)
        files += [parameters] if parameters.exists() else []
        if inputs:
            print(f"Inputs, which no parameter set holds; give them by --set: {', '.join(inputs)}.")
    print(f"written: {', '.join(map(str, files))}")
    return found.met


def _plan(study: StudyFile, file: Path, fmu: Path, target: Target) -> Plan:
    """The study with this parameter alone, whose range is that of the option, else of the file, else of the FMU."""
    entry = study.parameters.get(target.by, ParameterEntry())
    variables = Variables(described(fmu))
    is_named = target.by in variables.names or study.aliases is None  # else it may be a name of the aliases
    known = variables.settable(target.by, "--by") if is_named else None
    if known is not None and known.kind != "Real":
        what = {"Integer": "a whole number", "String": "a text", "Boolean": "true or false"}
        words = what.get(known.kind, f"of the kind {known.kind}")
        raise HostError(f"--by {target.by}: it is {words}; only real numbers can be sought.")
    ends, unit, log = target.range, None, entry.log
    if ends is not None:
        log = log and ends[0] > 0.0
        if known is not None:
            for end in ends:
                known.check(end, "--between")
    elif entry.range is not None:
        ends, unit = (entry.range[0], entry.range[1]), entry.unit
    elif known is not None and math.isfinite(known.high - known.low):
        ends = (known.low, known.high)
    no_range = f"--by {target.by}: neither the study file nor the FMU gives a range; add --between LOW:HIGH."
    if ends is None and known is not None:
        raise HostError(no_range)
    if ends is not None and not ends[0] < ends[1]:
        raise HostError(f"--by {target.by}: its range is {ends[0]:g} alone; add --between LOW:HIGH.")
    changes = {
        "parameters": {target.by: ParameterEntry(range=list(ends or (0.0, 1.0)), count=2, log=log, unit=unit)},
        "sampling": SamplingEntry(),
        "start": {name: value for name, value in study.start.items() if name != target.by},
        "signals": None,
        "limits": {},
    }
    plan = make_plan(study.model_copy(update=changes), file, fmu)
    if ends is None:  # a name of the aliases; the plan knows whether there is such a parameter
        raise HostError(no_range)
    return plan


def _start(study: StudyFile, by: str, fmu: Path) -> float:
    """The present value of the parameter; NaN where the FMU knows it by another name."""
    variables = Variables(described(fmu))
    value = study.start.get(by, variables[by].start if by in variables.names else None)
    return float(value) if isinstance(value, (int, float)) else math.nan


class _Search:
    """Runs of an FMU as a function of one parameter, and what is said of them."""

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
        named = [job for job in jobs if job.manoeuvre is None and name.startswith(f"{job.label}.")]
        own = {c: self.plan.record["measures"][c] for c in self.plan.work.columns}
        fit = named or [job for job in jobs if (job.manoeuvre is not None) == (name in own)]
        if not fit:
            name, fit = column_of(name, own, "--target"), list(jobs)
        if len(fit) > 1:
            labels = " and ".join(job.label for job in fit)
            whole = "give MANOEUVRE.MEASURE" if fit[0].manoeuvre is None else "leave one of them in the study file"
            raise HostError(f"--target {name}: it could be of {labels}; {whole}.")
        job = fit[0]
        if job.manoeuvre is not None:
            return job, name
        short = name.removeprefix(f"{job.label}.")
        return replace(job, measures=(short,)), f"{job.label}.{short}"

    def _take_unit(self, unit: str) -> None:
        """Learn the unit of the measure: what is wanted in it, and how it is shown."""
        given = self.target.unit
        factor = conversion(given, unit, f"--target {self.target.measure}") if given else 1.0
        self.unit, self.wanted = unit, factor * self.target.value
        self.shown = Shown(given, 1.0 / factor) if given else shown_in(unit, self.column)

    def found(self, start: float) -> SearchResult:
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
        said = self.y_words(y) if math.isfinite(y) else f"fails: {reason}"
        print(f"run {self._count}: {self.target.by} = {self.x_words(x)}: {said}", flush=True)
        return y, reason

    def x_words(self, x: float) -> str:
        return number_in(x, self.parameter.unit, ".5g")

    def y_words(self, y: float) -> str:
        return number_in(self.shown.factor * y, self.shown.unit, ".5g")

    def words(self, found: SearchResult) -> list[str]:
        """What was found, in sentences."""
        by, name, failed = self.target.by, self.column, [r for r in found.runs if r.reason]
        lines = []
        if found.best is None:
            lines.append(f"No run yields {name}: {failed[0].reason.rstrip('.')}. Give another --between.")
        elif found.met:
            lines.append(f"{by} = {self.x_words(found.best.x)} gives {name} = {self.y_words(found.best.y)}.")
            lines.append(f"Wanted: {self.y_words(self.wanted)}, to within {TOLERANCE:g} of it.")
        else:
            lines += self._not_met(found, found.best)
        if found.best is not None and math.isfinite(found.slope) and not self._is_flat(found):
            slope, one, other = self.shown.factor * found.slope, *map(self.x_words, found.between)
            change = number_in(0.01 * found.best.x * slope, self.shown.unit, ".5g")
            lines.append(f"Sensitivity: 1 % more of {by} changes it by {change} (from runs at {one} and {other}).")
        if found.met and found.rises and found.falls:
            lines.append(f"It is not monotone over {by} in these runs: another value may give the same.")
        if failed and found.best is not None:
            count = "1 run" if len(failed) == 1 else f"{len(failed)} runs"
            lines.append(f"{count} failed, the first at {self.x_words(failed[0].x)}: {failed[0].reason}")
        lines.append(f"{len(found.runs)} runs of {self.job.label}.")
        return lines

    def _not_met(self, found: SearchResult, best: Run) -> list[str]:
        ys = [run.y for run in found.runs if not run.reason]
        low, high = self.y_words(min(ys)), self.y_words(max(ys))
        ends = " to ".join(self.x_words(x) for x in (self.parameter.low, self.parameter.high))
        lines = [
            f"{self.column} = {self.y_words(self.wanted)} is not met with {self.target.by} from {ends}.",
            f"The nearest is {self.y_words(best.y)}, at {self.x_words(best.x)}; the runs lie between {low} and {high}.",
        ]
        changes = (False, False) if self._is_flat(found) else (found.rises, found.falls)
        form = {(True, True): "is not monotone", (True, False): "only rises", (False, True): "only falls"}.get(
            changes, "does not change"
        )
        if found.crossed:
            one, other = self._around(found)
            lines.append(
                f"Between {self.x_words(one.x)} and {self.x_words(other.x)} the measure goes from "
                f"{self.y_words(one.y)} to {self.y_words(other.y)}: it jumps there, runs fail, or the range is too "
                f"wide to resolve it; try --between={one.x:.6g}:{other.x:.6g}."
            )
            return lines
        known = self._variable()
        at_end = best.x in (self.parameter.low, self.parameter.high)
        wider = at_end and form != "does not change" and (known is None or known.low < best.x < known.high)
        allowed = f" (the FMU allows {known.range})" if known is not None and known.range else ""
        remedy = f"a wider range, --between{allowed}" if wider else "another parameter (--by)"
        lines.append(
            f"In {len(ys)} runs from end to end the measure {form} with it and does not reach what is wanted; "
            f"try {remedy}."
        )
        return lines

    def _is_flat(self, found: SearchResult) -> bool:
        """Whether the measure differs by rounding alone."""
        ys = np.array([run.y for run in found.runs if not run.reason])
        return len(ys) > 1 and not np.ptp(without_round_off(ys, self.unit))

    def _around(self, found: SearchResult) -> tuple[Run, Run]:
        """The nearest two runs on different sides of what is wanted."""
        known = sorted((run for run in found.runs if not run.reason), key=lambda run: run.x)
        sides = [(a, b) for a, b in pairwise(known) if (a.y - self.wanted) * (b.y - self.wanted) <= 0.0]
        return min(sides, key=lambda pair: pair[1].x - pair[0].x)

    def _variable(self) -> Variable | None:
        variables = Variables(described(self.plan.fmu))
        return variables[self.target.by] if self.target.by in variables.names else None


def _record(search: _Search, found: SearchResult, lines: list[str], file: Path) -> Path:
    """All of the search in the units of the measure and of the FMU."""
    record = {
        "measure": search.column,
        "unit": search.unit,
        "wanted": search.wanted,
        "parameter": search.target.by,
        "parameter_unit": search.parameter.unit,
        "range": [search.parameter.low, search.parameter.high],
        "met": found.met,
        "tolerance": found.tolerance,
        "value": None if found.best is None else found.best.x,
        "reached": None if found.best is None else found.best.y,
        "sensitivity": or_null(found.slope),
        "runs": [{**asdict(run), "y": or_null(run.y)} for run in found.runs],
        "words": lines,
    }
    write_json(file, record)
    return file


def _parameter_set(plan: Plan, study: StudyFile, by: str, value: float, file: Path) -> list[str]:
    """What the search has found and what the study sets, as a parameter set of these entries alone.

    Without entries there is no file. Returned is what is not a parameter.
    """
    values: dict[str, Any] = {**study.start, by: value}
    values = plan.work.fmu.theirs(values)
    description = described(plan.fmu)
    whole = parameter_set_of(Variables(description), description.modelName, values)
    entries = [entry for entry in whole.entries if entry.name in values]
    units = {entry.unit: whole.units[entry.unit] for entry in entries if entry.unit is not None}
    if entries:
        write_parameter_set(replace(whole, entries=entries, units=units), file, as_built=False)
    return [f"{name}={value}" for name, value in values.items() if name not in {entry.name for entry in entries}]


def _figure(search: _Search, found: SearchResult) -> Figure:
    """The measure over the parameter in all runs."""
    factor, unit = search.shown.factor, search.shown.unit
    known = sorted((run for run in found.runs if not run.reason), key=lambda run: run.x)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(8.0, 4.5), layout="constrained")
        axes.plot([r.x for r in known], [factor * r.y for r in known], "o-", color=BLUE, label="runs", linewidth=1.0)
        wanted = search.y_words(search.wanted)
        axes.axhline(factor * search.wanted, color="#555555", linestyle="--", label=f"wanted: {wanted}")
        if found.best is not None:
            words = "found" if found.met else "nearest"
            label = f"{words}: {search.x_words(found.best.x)}"
            axes.plot(found.best.x, factor * found.best.y, "D", color=RED, markersize=9, label=label)
        for k, run in enumerate(r for r in found.runs if r.reason):
            label = "failed run" if k == 0 else "_"
            axes.plot(run.x, 0.02, "|", color=RED, transform=axes.get_xaxis_transform(), label=label, markersize=10)
        if search.parameter.log:
            axes.set_xscale("log")
        axes.set_xlabel(titled(search.target.by, search.parameter.unit))
        axes.set_ylabel(titled(search.column, unit))
        axes.set_title(f"{search.column} by {search.target.by}, {len(found.runs)} runs")
        axes.legend()
    return figure
