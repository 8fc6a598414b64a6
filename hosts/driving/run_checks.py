"""Checks before a run: the step, and columns that the FMU has no input for."""

import math
from collections.abc import Callable

import numpy as np

from hosts.common.errors import HostError
from hosts.common.numbers import LARGEST_NUMBER
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.input_ranges import beyond_range
from hosts.fmu.variables import default_step

_LARGEST_RECORD = 4e9  # bytes


def communication_step(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float | None, interval: float | None = None
) -> float:
    """The communication step of a run, s: the requested `step`, else that of the manoeuvre or of the FMU.

    `interval`: time between recorded rows, s; by default the step. Raises `HostError` if the step or the stop time is
    not positive, or if the step is longer than the manoeuvre, or if the record would not fit into the memory.
    """
    if step is None:
        step = manoeuvre.step
    if step is None:
        step = default_step(fmu.description)
    stop = manoeuvre.stop_time
    if not 0.0 < stop < math.inf:
        raise HostError(f"The stop time is {stop:g} s; it must be positive and finite.")
    if not 0.0 < step <= stop:
        raise HostError(f"The step is {step:g} s; it must be positive and not longer than {stop:g} s.")
    columns = len(fmu.names("input")) + len(fmu.names("output")) + 1
    between = step if interval is None else max(step, interval)
    rows, most = stop / between, _LARGEST_RECORD / (8.0 * columns) - 1.0
    if rows > most:
        name = "steps" if between == step else "intervals"
        usual = default_step(fmu.description)
        remedy = (
            f"{name} of at least {_rounded(stop / most, math.ceil):g} s"
            if stop / most <= usual  # the FMU takes longer steps with a loss of accuracy, or not at all
            else f"a stop time of at most {_rounded(max(between, usual) * most, math.floor):g} s"
        )
        raise HostError(
            f"{stop:g} s in {name} of {between:g} s are {rows:.3g} rows of {columns} values: "
            f"{8e-9 * columns * (rows + 1.0):.3g} GB where at most {1e-9 * _LARGEST_RECORD:g} GB can be recorded; take "
            f"{remedy}."
        )
    return step


def _rounded(value: float, towards: Callable[[float], int]) -> float:
    """A positive number with two digits, rounded up or down by `towards`."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return towards(value / digit) * digit


def steps_of(interval: float, step: float, subject: str) -> int:
    """Number of communication steps in an interval.

    `interval`, `step`: s; `subject`: the interval, for messages. Raises `HostError`: it is not a whole multiple of
    the step.
    """
    steps = round(interval / step) if math.isfinite(interval) else 0
    if steps < 1 or abs(steps * step - interval) > 1e-6 * interval:
        near = step * max(1, steps)
        raise HostError(
            f"{subject} is {interval:g} s, which is not a multiple of the step of {step:g} s; take {near:g} s."
        )
    return steps


def check_columns(fmu: SimulatedFmu, manoeuvre: Manoeuvre) -> None:
    """Refuse a table with a column that is neither an input nor a tunable parameter of the FMU, not of its kind, or
    beyond its range, and a table that begins after the end of the run.

    Raises `HostError` with the column, and what it would have to be.
    """
    inputs, tunable = fmu.names("input"), fmu.tunable
    if manoeuvre.inputs and len(manoeuvre.time) and manoeuvre.time[0] > manoeuvre.stop_time > 0.0:
        raise HostError(
            f"The table of the manoeuvre '{manoeuvre.name}' begins at {manoeuvre.time[0]:g} s, and the run ends at "
            f"{manoeuvre.stop_time:g} s; subtract the first time from all its times."
        )
    for name, values in manoeuvre.inputs.items():
        text, variable = f"The manoeuvre '{manoeuvre.name}' has a column '{name}'", fmu.variables.get(name)
        if variable is not None and variable.causality == "parameter" and name not in tunable:
            raise HostError(
                f"{text}, a {variable.variability} parameter of {fmu.path.name}: it can be set before the start only, "
                "by --set, --parameters or in [start]."
            )
        if name not in inputs and name not in tunable:
            raise HostError(
                f"{text}, which is not an input of {fmu.path.name}; its inputs are: {', '.join(inputs) or 'none'}"
                f"{f'; a tunable parameter, such as {tunable[0]}, can be a column too' if tunable else ''}. "
                "An alias file (--aliases) gives inputs that have other names."
            )
        if fmu.variables[name].type == "Integer" and (values != np.round(values)).any():
            odd = float(values[values != np.round(values)][0])
            raise HostError(f"{text} with the value {odd:g}; '{name}' is a whole number.")
        worst = float(values[np.argmax(np.abs(values))])
        if abs(worst) > LARGEST_NUMBER:
            fmu.table[name].check(worst, f"The manoeuvre '{manoeuvre.name}'")
            raise HostError(f"{text} with the value {worst:g}; it must be within {LARGEST_NUMBER:g}.")
        if beyond := beyond_range(fmu.table[name], values):
            raise HostError(f"{text} that {beyond}")
        if name in tunable:
            for value in values.tolist():
                fmu.table[name].check(value, f"The manoeuvre '{manoeuvre.name}'")
