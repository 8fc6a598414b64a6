"""Variables of an FMU of FMI 2.0 or 3.0 with type, unit, range and start value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fmpy.model_description import ModelDescription, ScalarVariable

from ali3.decimal_number import parse_number
from ali3.message_text import brief, range_text
from ali3.near_names import MOST, did_you_mean
from ali3.processes import command_name
from ali3.unit_definition import BASE_UNITS, KINDS, UnitDefinition
from ali3.units import number_with_unit, typeset
from hosts.common.errors import HostError
from hosts.common.numbers import Value, is_finite

_DEFAULT_STEP = 0.01  # s
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
_ROLES = {
    "output": "an output",
    "local": "a local variable",
    "independent": "the independent variable",
    "calculatedParameter": "a calculated parameter",
    "structuralParameter": "a structural parameter",
}


@dataclass(frozen=True)
class Variable:
    """A variable of an FMU."""

    name: str
    description: str
    causality: str
    variability: str
    kind: str
    """``Real``, ``Integer``, ``Boolean``, ``String``, ``Enumeration``, or another type of FMI."""
    unit: str
    """"1" without a unit."""
    start: Value | None
    low: float
    """Lower end of the range; -inf if open."""
    high: float
    """Upper end of the range; inf if open."""
    definition: UnitDefinition | None
    """Definition of the unit, if the FMU has one."""
    displays: dict[str, tuple[float, float]]
    """Factor and offset of display units: displayed = factor * value + offset."""
    items: dict[str, int]
    """Values of an enumeration by name."""

    def text(self, value: Value | None) -> str:
        """A value as text for messages."""
        if value is None:
            return "not set"
        if isinstance(value, bool):
            return str(value).lower()
        return repr(value) if isinstance(value, str) else f"{value:.10g}"

    def with_unit(self, value: Value | None) -> str:
        """A value with its unit as text."""
        unit = typeset(self.unit) if self.kind == "Real" else ""
        return f"{self.text(value)} {unit}".rstrip()

    @property
    def may_be_set(self) -> bool:
        """Whether it is a parameter or an input, and not a constant."""
        return self.causality in ("parameter", "input") and self.variability != "constant"

    @property
    def range(self) -> str:
        """The range as text; empty if both ends are open."""
        if self.items:
            return ", ".join(f"{number} {name}" for name, number in self.items.items())
        return range_text(self.low, self.high, typeset(self.unit) or "1" if self.kind == "Real" else "1")

    def read(self, text: str, source: str, with_unit: bool = False) -> Value:
        """The checked value of a text.

        `source`: source of the text, for messages; `with_unit`: whether a unit may follow the number, as on the command
        line but not in files. Raises `HostError` if it is not a value of this variable.
        """
        if self.kind == "String":
            return text
        word = text.strip()
        if self.kind == "Boolean":
            if word.lower() not in _BOOLEANS:
                raise HostError(f"{source}: '{self.name}' is {word!r}; it must be true or false.")
            return _BOOLEANS[word.lower()]
        if word in self.items:
            return self.items[word]
        try:
            number = number_with_unit(word, self.unit) if with_unit and self.kind == "Real" else parse_number(word)
            return self.check(number, source)
        except ValueError as error:
            raise HostError(f"{source}: '{self.name}': {error}.") from None

    def check(self, value: Value, source: str) -> Value:
        """The value, converted to the type of the variable.

        Raises `HostError` if it has another type or is out of the range.
        """
        is_truth_of_a_number = isinstance(value, bool) and self.kind != "Boolean"
        if self.kind == "String" or isinstance(value, str) or is_truth_of_a_number:
            if self.kind != "String" or not isinstance(value, str):
                value_text = self.text(value) if is_finite(value) or isinstance(value, (bool, str)) else brief(value)
                raise HostError(f"{source}: '{self.name}' is {value_text}; it must be {kind_text(self.kind)}.")
            return value
        if not isinstance(value, bool) and not is_finite(value):
            raise HostError(f"{source}: '{self.name}' is {brief(value)}; only finite numbers can be used.")
        if not self.low <= value <= self.high or (self.items and value not in self.items.values()):
            raise HostError(f"{source}: '{self.name}' is {self.with_unit(value)}; its range is {self.range}.")
        if self.kind == "Boolean":
            if value not in (0, 1):
                raise HostError(f"{source}: '{self.name}' is {value:g}; it must be true or false.")
            return bool(value)
        if self.kind == "Real":
            return float(value)
        if value != int(value):
            raise HostError(f"{source}: '{self.name}' is {value:g}; it must be a whole number.")
        return int(value)

    def from_display(self, value: float, unit: str, source: str) -> float:
        """A value converted from a display unit of the FMU to the unit of the variable.

        Raises `HostError` if the variable has no such display unit.
        """
        if unit not in self.displays:
            raise HostError(
                f"{source}: '{self.name}' is given in '{unit}', which the file does not define among its Units; "
                f"the unit of the FMU is {self.unit}."
            )
        factor, offset = self.displays[unit]
        return (value - offset) / factor


class Variables:
    """Variables of an FMU by name."""

    def __init__(self, description: ModelDescription) -> None:
        units = {u.name: u for u in description.unitDefinitions}
        self._variables = {v.name: _variable(v, units) for v in description.modelVariables}
        self.names = list(self._variables)

    def __getitem__(self, name: str) -> Variable:
        return self._variables[name]

    @property
    def parameters(self) -> list[Variable]:
        """Parameters in the order of the FMU."""
        return [v for v in self._variables.values() if v.causality == "parameter"]

    def constants(self, settings: Mapping[str, Value]) -> dict[str, float]:
        """Finite numbers of constants and parameters. `settings`: values that were set, in place of start values."""
        fixed = [v for v in self._variables.values() if v.variability == "constant" or v.causality == "parameter"]
        values = {v.name: settings.get(v.name, v.start) for v in fixed}
        return {name: float(value) for name, value in values.items() if value is not None and is_finite(value)}

    def settable(self, name: str, source: str) -> Variable:
        """A variable that may be set before the start. `source`: source of the name, for messages.

        Raises `HostError` if the variable does not exist, or may not be set.
        """
        variable = self._variables.get(name)
        if variable is None and (elements := [n for n in self.names if n.startswith(f"{name}[")]):
            raise HostError(
                f"{source}: '{name}' is an array of the FMU; set its elements, '{elements[0]}' to '{elements[-1]}'."
            )
        if variable is None:
            raise HostError(f"{source}: the FMU has no parameter or input {brief(name)}{self._near(name)}")
        if variable.variability == "constant":
            raise HostError(
                f"{source}: '{name}' is a constant, {variable.with_unit(variable.start)}; it cannot be set."
            )
        if variable.causality not in ("parameter", "input"):
            role = _ROLES.get(variable.causality, variable.causality)
            raise HostError(f"{source}: '{name}' is {role} of the FMU; it cannot be set.")
        return variable

    def _near(self, name: str) -> str:
        settable = [n for n, v in self._variables.items() if v.may_be_set]
        names_hint, command_hint = (
            f"it has: {', '.join(settable) or 'none'}",
            f"{command_name('check')} FMU --show-parameters lists them",
        )
        return did_you_mean(name, settable, names_hint if len(settable) <= 2 * MOST else command_hint)


def _variable(v: ScalarVariable, units: dict[str | None, Any]) -> Variable:
    declared = v.declaredType

    def attribute(name: str) -> Any:
        value = getattr(v, name)
        return getattr(declared, name) if value is None and declared is not None else value

    kind = KINDS.get(v.type, v.type)
    unit = attribute("unit")
    entry = units.get(unit)
    base = entry.baseUnit if entry is not None else None
    definition = UnitDefinition.of({k: getattr(base, k) for k in (*BASE_UNITS, "factor", "offset")}) if base else None
    if unit is None:
        definition = UnitDefinition({})
    low, high = attribute("min"), attribute("max")
    return Variable(
        v.name,
        v.description or "",
        str(v.causality or "local"),
        str(v.variability or "continuous"),
        kind,
        unit or "1",
        _start(v.start, kind),
        -math.inf if low is None else float(low),
        math.inf if high is None else float(high),
        definition,
        {d.name: (float(d.factor), float(d.offset)) for d in entry.displayUnits} if entry is not None else {},
        {i.name: int(i.value) for i in declared.items} if kind == "Enumeration" and declared is not None else {},
    )


def _start(text: Any, kind: str) -> Value | None:
    if text is None:
        return None
    if kind == "String":
        return str(text)
    if kind == "Boolean":
        return str(text).strip().lower() in ("true", "1")
    return float(text) if kind == "Real" else int(text)


def check_co_simulation(path: Path, description: ModelDescription) -> None:
    """Raises `HostError` if the FMU is not for co-simulation of FMI 2.0 or 3.0."""
    if description.coSimulation is None or description.fmiVersion[0] not in "23":
        kind = "" if description.coSimulation is not None else " for model exchange"
        raise HostError(
            f"{path} is an FMU of FMI {description.fmiVersion}{kind}; what is driven here is co-simulation of FMI 2.0 "
            "and 3.0."
        )


def default_step(description: ModelDescription) -> float:
    """The default communication step of an FMU, s; without one 0.01, or a near multiple of its fixed step."""
    experiment, co_simulation = description.defaultExperiment, description.coSimulation
    if experiment is not None and experiment.stepSize:
        return float(experiment.stepSize)
    fixed_step = float(co_simulation.fixedInternalStepSize or 0.0) if co_simulation is not None else 0.0
    return fixed_step * max(1, round(_DEFAULT_STEP / fixed_step)) if 0.0 < fixed_step < math.inf else _DEFAULT_STEP


def kind_text(kind: str) -> str:
    """A type with its indefinite article."""
    return f"an {kind}" if kind[0] in "AEIO" else f"a {kind}"
