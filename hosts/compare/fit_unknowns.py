"""The unknowns of a fit: parameters of the FMU, and delays, drift, bias and gain of sensors and clocks."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ali3.decimal_number import parse_number
from ali3.near_names import did_you_mean
from ali3.processes import command_name
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.variables import Variable
from hosts.measures.signal import Signal

NUISANCES = ("delay", "delays", "drift", "bias", "gain")
_STEP = "step_size"


@dataclass(frozen=True)
class Unknown:
    """An unknown of a fit."""

    name: str
    unit: str
    start: float
    low: float
    high: float
    scale: float
    """Typical size of a change."""
    signal: str = ""
    """Signal of a sensor; empty: of the FMU, or of all signals."""
    kind: str = "parameter"
    """``parameter``, or one of delay, drift, bias, gain."""


def nuisances(
    kinds: Sequence[str], outputs: Mapping[str, Signal], delays: Mapping[str, float], longest: float
) -> list[Unknown]:
    """The unknowns of sensors and clocks.

    `kinds`: kinds in `NUISANCES`; `delays`: first guesses by signal, s; for all signals under ""; `longest`: largest
    delay, s. Raises `HostError` if a kind is unknown, or two of them exclude each other.
    """
    for name in kinds:
        if name not in NUISANCES:
            raise HostError(f"--nuisance: '{name}' is not known; known are {', '.join(NUISANCES)}.")
    if "delay" in kinds and "delays" in kinds:
        raise HostError("--nuisance: 'delay' is one delay for all signals, 'delays' one for each; give one of them.")
    interval = min(s.interval for s in outputs.values())
    length = max(float(s.time[-1]) for s in outputs.values())
    results = []
    names = ("",) if "delay" in kinds else tuple(outputs) if "delays" in kinds else ()
    for n in names:
        guess, limit = delays.get(n, 0.0), longest + abs(delays.get(n, 0.0))
        results.append(Unknown(f"{n}.delay".lstrip("."), "s", guess, -limit, limit, interval, n, "delay"))
    if "drift" in kinds:
        results.append(Unknown("drift", "1", 0.0, -0.05, 0.05, interval / length, "", "drift"))
    for n, s in outputs.items():
        spread = max(float(np.std(s.values)), 1e-12)
        if "bias" in kinds:
            results.append(Unknown(f"{n}.bias", s.unit, 0.0, -np.inf, np.inf, 0.1 * spread, n, "bias"))
        if "gain" in kinds:
            results.append(Unknown(f"{n}.gain", "1", 1.0, 0.1, 10.0, 0.1, n, "gain"))
    return results


def fitted_parameters(
    texts: Sequence[str], variables: Mapping[str, Variable], set_values: Mapping[str, Value]
) -> list[Unknown]:
    """Parameters to be fitted.

    `texts`: ``NAME`` or ``NAME=LOW:HIGH``; `set_values`: values that the user sets, at which the search begins. Raises
    `HostError` if a name, kind or range is wrong.
    """
    results: list[Unknown] = []
    for text in texts:
        name, equals, limits = (part.strip() for part in text.partition("="))
        if name in [u.name for u in results]:
            raise HostError(f"--fit: '{name}' is given twice.")
        variable = variables.get(name)
        if variable is None:
            hint = did_you_mean(name, variables, f"{command_name('check')} FMU --show-parameters lists them")
            raise HostError(f"--fit: the FMU has no parameter '{name}'{hint}")
        if variable.kind != "Real" or variable.start is None:
            raise HostError(f"--fit: '{name}' is of the kind {variable.kind}; only real numbers can be fitted.")
        start = float(set_values.get(name, variable.start))
        low, high = _range(variable, limits) if equals else _default_range(variable, start)
        if not low <= start <= high:
            raise HostError(
                f"--fit: '{name}' begins at {variable.with_unit(start)}, which is not between {low:g} and {high:g}; "
                f"--set {name}=VALUE begins elsewhere."
            )
        results.append(Unknown(name, variable.unit, start, low, high, 0.25 * (high - low)))
    return results


def fit_step(step: float | None, variables: Mapping[str, Variable]) -> dict[str, Value]:
    """The parameter that sets the inner step of the FMU while it is fitted; empty if none was asked for.

    `step`: s.
    """
    if step is None:
        return {}
    variable = variables.get(_STEP)
    if variable is None:
        raise HostError(f"--fit-step: the FMU has no parameter '{_STEP}'; fit with its own step.")
    if not variable.low <= step <= variable.high:
        raise HostError(f"--fit-step is {step:g} s; the range of '{_STEP}' is {variable.range}.")
    return {_STEP: step}


def _range(variable: Variable, text: str) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    try:
        if not colon:
            raise ValueError(f"{text!r} is not of the form LOW:HIGH")
        limits = parse_number(low), parse_number(high)
    except ValueError as error:
        raise HostError(f"--fit: '{variable.name}': {error}.") from None
    if not limits[0] < limits[1]:
        raise HostError(f"--fit: '{variable.name}' from {limits[0]:g} to {limits[1]:g}; the first must be the smaller.")
    if limits[0] < variable.low or limits[1] > variable.high:
        raise HostError(
            f"--fit: '{variable.name}' from {limits[0]:g} to {limits[1]:g}; the range of the FMU is {variable.range}."
        )
    return limits


def _default_range(variable: Variable, start: float) -> tuple[float, float]:
    if start == 0.0:
        raise HostError(
            f"--fit: '{variable.name}' is 0 in the FMU, so that there is no default range; write "
            f"--fit {variable.name}=LOW:HIGH."
        )
    low, high = sorted((0.5 * start, 2.0 * start))
    low, high = max(low, variable.low), min(high, variable.high)
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise HostError(f"--fit: '{variable.name}' needs a range; write --fit {variable.name}=LOW:HIGH.")
    return low, high
