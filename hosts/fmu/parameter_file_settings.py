"""Settings of an FMU from a parameter set, converted into the units of the FMU."""

from pathlib import Path

from ali3.parameter_set import Entry, ParameterSet
from ali3.read_parameter_set import read_parameter_set
from ali3.unit_definition import UnitDefinition
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.setting import Setting
from hosts.fmu.variables import Variable, Variables, kind_text


def settings_of_file(file: Path, variables: Variables, source: str) -> list[Setting]:
    """Settings of an SSV file, in the units of the FMU. `source`: how messages call the file.

    Raises `HostError` if a name, value, type or unit is wrong, `ParameterSetError` if it is not a parameter set.
    """
    parameters = read_parameter_set(file)
    return [_setting_of_entry(entry, parameters, variables, source) for entry in parameters.entries]


def _setting_of_entry(entry: Entry, parameters: ParameterSet, variables: Variables, source: str) -> Setting:
    variable = variables.settable(entry.name, source)
    value = _value_of_entry(variable, entry.kind, entry.value, source)
    own_unit = entry.unit == variable.unit and entry.unit not in parameters.units
    if entry.unit is None or variable.kind != "Real" or own_unit:
        return Setting(variable, variable.check(value, source), source)
    assert isinstance(value, float)
    definition = parameters.units.get(entry.unit)
    converted = (
        variable.from_display(value, entry.unit, source)
        if definition is None
        else _convert(variable, value, entry.unit, definition, source)
    )
    original = "" if converted == value else f"{value:g} {entry.unit}"
    return Setting(
        variable, variable.check(converted, f"{source}, {original}" if original else source), source, original
    )


def _value_of_entry(variable: Variable, kind: str, text: str, source: str) -> Value:
    """The value of an entry, whose type must fit the variable; the range of a real value is not checked."""
    fits = {"Real": ("Real", "Integer"), "Integer": ("Integer", "Real"), "Enumeration": ("Enumeration", "Integer")}
    if kind not in fits.get(variable.kind, (variable.kind,)):
        raise HostError(f"{source}: '{variable.name}' is given as {kind}; in the FMU it is {kind_text(variable.kind)}.")
    if variable.kind == "Real":
        return float(text)
    if kind == "Real":
        return variable.check(float(text), source)
    return variable.read(text, source)


def _convert(variable: Variable, value: float, name: str, unit: UnitDefinition, source: str) -> float:
    fmu_unit = variable.definition
    if fmu_unit is None:
        raise HostError(
            f"{source}: '{variable.name}' is given in {name}; the FMU does not define its unit "
            f"{variable.unit}, so that it cannot be converted."
        )
    if fmu_unit.exponents != unit.exponents:
        raise HostError(
            f"{source}: '{variable.name}' is given in {name} ({_base_unit_text(unit)}); its unit is {variable.unit} "
            f"({_base_unit_text(fmu_unit)})."
        )
    return unit.convert(value, fmu_unit)


def _base_unit_text(unit: UnitDefinition) -> str:
    """The text of a unit in base units, for messages."""
    text = ".".join(f"{base}{'' if power == 1 else power}" for base, power in unit.exponents.items()) or "1"
    return text if unit.factor == 1.0 else f"{unit.factor:g} {text}"
