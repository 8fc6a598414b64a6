"""Finds the value of a parameter at which a measure has a wanted value: ``ali3 study --target MEASURE=VALUE``."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from ali3.charts import drawing
from ali3.decimal_number import parse_number
from ali3.files import make_folder
from ali3.write_parameter_set import write_parameter_set
from hosts.common.errors import HostError
from hosts.fmu.fmu import described
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.variables import Variables
from hosts.study.campaign import fmu_of_study, out_folder
from hosts.study.folder import check_no_link
from hosts.study.plan import Plan, make_plan
from hosts.study.study_file import ParameterEntry, SamplingEntry, StudyFile, read_study_file
from hosts.study.study_runs import OneProcess
from hosts.study.target_report import search_figure, text_lines, write_record
from hosts.study.target_runs import Target, TargetRuns

_VALUE = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d,;\s].*?|)\s*")


def target_of(text: str, by: str, limits: str | None) -> Target:
    """The target that the options request.

    `text`: ``MEASURE=VALUE``, the value with a unit or without; `limits`: ``LOW:HIGH``. Raises `HostError`: it is not
    of this form.
    """
    name, _, value = (part.strip() for part in text.partition("="))
    result = _VALUE.fullmatch(value)
    if not name or result is None:
        raise HostError(f"--target {text}: it must be MEASURE=VALUE, such as 'understeer_gradient=1.3 deg/g'.")
    try:
        ends = None if limits is None else tuple(parse_number(end) for end in limits.split(":"))
        target = parse_number(result[1])
    except ValueError as error:
        between = "" if limits is None else f" --between {limits}"
        raise HostError(f"--target {text}{between}: {error}.") from None
    if ends is not None and not (len(ends) == 2 and ends[0] < ends[1]):
        raise HostError(f"--between {limits}: it must be LOW:HIGH, the smaller number first.")
    return Target(name, target, result[2], by, None if ends is None else (ends[0], ends[1]))


def find_target(file: Path, target: Target, out: Path | None) -> bool:
    """Seek the value, print and write what was found; whether the measure can be what is wanted.

    `file`: a study file: its FMU or car, its manoeuvres and ``[start]``; its other parameters stay as the FMU has them;
    `out`: folder of the files. Raises `HostError`: there is no such parameter or measure, or the unit is one of another
    quantity.
    """
    study, _ = read_study_file(file)
    fmu = fmu_of_study(study, file)
    plan = _plan(study, file, fmu, target)
    search = TargetRuns(plan, target)
    folder = out if out is not None else out_folder(None, study, file) / "target"
    make_folder(folder)
    check_no_link(folder)
    with OneProcess(search.work, fmu) as search.processes:
        result = search.found(_start(study, target.by, fmu))
    lines = text_lines(search, result)
    print("\n".join(lines))
    stem = re.sub(r"[^A-Za-z0-9]+", "_", f"{search.column} by {target.by}").strip("_")
    files = [
        drawing(search_figure(search, result), "").write(folder / f"{stem}.svg"),
        write_record(search, result, lines, folder / f"{stem}.json"),
    ]
    parameters = folder / f"{stem}.ssv"
    parameters.unlink(missing_ok=True)  # of an earlier search
    if result.met and result.best is not None:
        inputs = _parameter_set(plan, study, target.by, result.best.x, parameters)
        files += [parameters] if parameters.exists() else []
        if inputs:
            print(f"Inputs, which no parameter set holds; give them by --set: {', '.join(inputs)}.")
    print(f"written: {', '.join(map(str, files))}")
    return result.met


def _plan(study: StudyFile, file: Path, fmu: Path, target: Target) -> Plan:
    """The study with this parameter alone, whose range is that of the option, else of the file, else of the FMU."""
    entry = study.parameters.get(target.by, ParameterEntry())
    variables = Variables(described(fmu))
    is_named = target.by in variables.names or study.aliases is None  # else it may be a name of the aliases
    variable = variables.settable(target.by, "--by") if is_named else None
    if variable is not None and variable.kind != "Real":
        descriptions = {"Integer": "a whole number", "String": "a text", "Boolean": "true or false"}
        message = descriptions.get(variable.kind, f"of the kind {variable.kind}")
        raise HostError(f"--by {target.by}: it is {message}; only real numbers can be sought.")
    ends, unit, log = target.range, None, entry.log
    if ends is not None:
        log = log and ends[0] > 0.0
        if variable is not None:
            for end in ends:
                variable.check(end, "--between")
    elif entry.range is not None:
        ends, unit = (entry.range[0], entry.range[1]), entry.unit
    elif variable is not None and math.isfinite(variable.high - variable.low):
        ends = (variable.low, variable.high)
    no_range = f"--by {target.by}: neither the study file nor the FMU gives a range; add --between LOW:HIGH."
    if ends is None and variable is not None:
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


def _parameter_set(plan: Plan, study: StudyFile, by: str, value: float, file: Path) -> list[str]:
    """What the search has found and what the study sets, as a parameter set of these entries alone.

    Without entries there is no file. Returned is what is not a parameter.
    """
    values: dict[str, Any] = {**study.start, by: value}
    values = plan.work.fmu.theirs(values)
    description = described(plan.fmu)
    parameter_set = parameter_set_of(Variables(description), description.modelName, values)
    entries = [entry for entry in parameter_set.entries if entry.name in values]
    units = {entry.unit: parameter_set.units[entry.unit] for entry in entries if entry.unit is not None}
    if entries:
        write_parameter_set(replace(parameter_set, entries=entries, units=units), file, as_built=False)
    return [f"{name}={value}" for name, value in values.items() if name not in {entry.name for entry in entries}]
