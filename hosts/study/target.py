"""Finds the value of a parameter at which a measure has a target value: ``ali3 study --target MEASURE=VALUE``."""

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
from hosts.study.study_runs import SingleProcess
from hosts.study.target_report import search_figure, text_lines, write_search_record
from hosts.study.target_runs import Target, TargetRuns

_VALUE = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d,;\s].*?|)\s*")


def target_of(text: str, by: str, range_text: str | None) -> Target:
    """Read the target of the options.

    `text`: ``MEASURE=VALUE``, the value with or without a unit; `by`: the parameter; `range_text`: ``LOW:HIGH``. Raises
    `HostError` if a text is not of this form.
    """
    name, _, value = (part.strip() for part in text.partition("="))
    match = _VALUE.fullmatch(value)
    if not name or match is None:
        raise HostError(f"--target {text}: it must be MEASURE=VALUE, such as 'understeer_gradient=1.3 deg/g'.")
    try:
        ends = None if range_text is None else tuple(parse_number(end) for end in range_text.split(":"))
        number = parse_number(match[1])
    except ValueError as error:
        between = "" if range_text is None else f" --between {range_text}"
        raise HostError(f"--target {text}{between}: {error}.") from None
    if ends is not None and not (len(ends) == 2 and ends[0] < ends[1]):
        raise HostError(f"--between {range_text}: it must be LOW:HIGH, the smaller number first.")
    return Target(name, number, match[2], by, None if ends is None else (ends[0], ends[1]))


def find_target(file: Path, target: Target, out: Path | None) -> bool:
    """Seek the value of a parameter, print and write the result. Returns whether the measure has the target value.

    `file`: a study file; its other parameters keep the values of the FMU; `out`: folder of the files. Raises
    `HostError` if there is no such parameter or measure, or the unit is one of another quantity.
    """
    study, _ = read_study_file(file)
    fmu = fmu_of_study(study, file)
    plan = _plan_of_parameter(study, file, fmu, target)
    search = TargetRuns(plan, target)
    folder = out if out is not None else out_folder(None, study, file) / "target"
    make_folder(folder)
    check_no_link(folder)
    with SingleProcess(search.work, fmu) as search.processes:
        result = search.search_from(_present_value(study, target.by, fmu))
    lines = text_lines(search, result)
    print("\n".join(lines))
    stem = re.sub(r"[^A-Za-z0-9]+", "_", f"{search.column} by {target.by}").strip("_")
    files = [
        drawing(search_figure(search, result), "").write(folder / f"{stem}.svg"),
        write_search_record(search, result, lines, folder / f"{stem}.json"),
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


def _plan_of_parameter(study: StudyFile, file: Path, fmu: Path, target: Target) -> Plan:
    """The plan of the study with one parameter; its range is that of the option, or of the file, or of the FMU."""
    entry = study.parameters.get(target.by, ParameterEntry())
    variables = Variables(described(fmu))
    is_named = target.by in variables.names or study.aliases is None  # else it may be a name of the alias file
    variable = variables.settable(target.by, "--by") if is_named else None
    if variable is not None and variable.kind != "Real":
        descriptions = {"Integer": "a whole number", "String": "a text", "Boolean": "true or false"}
        message = descriptions.get(variable.kind, f"of the kind {variable.kind}")
        raise HostError(f"--by {target.by}: it is {message}; only real numbers can be sought.")
    limits, unit, log = target.range, None, entry.log
    if limits is not None:
        log = log and limits[0] > 0.0
        if variable is not None:
            for limit in limits:
                variable.check(limit, "--between")
    elif entry.range is not None:
        limits, unit = (entry.range[0], entry.range[1]), entry.unit
    elif variable is not None and math.isfinite(variable.high - variable.low):
        limits = (variable.low, variable.high)
    no_range = f"--by {target.by}: neither the study file nor the FMU gives a range; add --between LOW:HIGH."
    if limits is None and variable is not None:
        raise HostError(no_range)
    if limits is not None and not limits[0] < limits[1]:
        raise HostError(f"--by {target.by}: its range is {limits[0]:g} alone; add --between LOW:HIGH.")
    changes = {
        "parameters": {target.by: ParameterEntry(range=list(limits or (0.0, 1.0)), count=2, log=log, unit=unit)},
        "sampling": SamplingEntry(),
        "start": {name: value for name, value in study.start.items() if name != target.by},
        "signals": None,
        "limits": {},
    }
    plan = make_plan(study.model_copy(update=changes), file, fmu)
    if limits is None:  # a name of the alias file, which the plan has checked
        raise HostError(no_range)
    return plan


def _present_value(study: StudyFile, by: str, fmu: Path) -> float:
    """The present value of the parameter; NaN if it is a name of the alias file."""
    variables = Variables(described(fmu))
    value = study.start.get(by, variables[by].start if by in variables.names else None)
    return float(value) if isinstance(value, (int, float)) else math.nan


def _parameter_set(plan: Plan, study: StudyFile, by: str, value: float, file: Path) -> list[str]:
    """Write the value of the search and the start values of the study as a parameter set, if it has entries.

    Returns the values that are not parameters, as ``NAME=VALUE``.
    """
    values: dict[str, Any] = {**study.start, by: value}
    values = plan.work.fmu.fmu_values(values)
    description = described(plan.fmu)
    parameter_set = parameter_set_of(Variables(description), description.modelName, values)
    entries = [entry for entry in parameter_set.entries if entry.name in values]
    units = {entry.unit: parameter_set.units[entry.unit] for entry in entries if entry.unit is not None}
    if entries:
        write_parameter_set(replace(parameter_set, entries=entries, units=units), file, as_built=False)
    return [f"{name}={value}" for name, value in values.items() if name not in {entry.name for entry in entries}]
