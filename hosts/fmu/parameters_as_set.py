"""The parameter set with all parameters of an FMU."""

from collections.abc import Mapping

from ali3.message_text import range_text
from ali3.parameter_set import Entry, ParameterSet, parameter_text
from hosts.common.numbers import Value
from hosts.fmu.variables import Variable, Variables

_WRITTEN_TYPES = ("Real", "Integer", "Boolean", "String", "Enumeration")


def parameter_set_of(variables: Variables, name: str, values: Mapping[str, Value]) -> ParameterSet:
    """All parameters as a set. `values`: replace start values of the FMU, by name."""
    entries, units = [], {}
    for v in variables.parameters:
        value = values.get(v.name, v.start)
        if value is None or v.kind not in _WRITTEN_TYPES:
            continue
        unit = v.unit if v.kind == "Real" and v.definition is not None else None
        if unit is not None and v.definition is not None:
            units[unit] = v.definition
        bounds = range_text(v.low, v.high, v.unit if v.kind == "Real" else "1")  # as `ali3 build` writes it
        text = parameter_text(v.description, bounds, v.variability)
        entries.append(Entry(v.name, v.kind, value_text(v, value), unit, text))
    return ParameterSet(name, entries, dict(sorted(units.items())))


def value_text(variable: Variable, value: Value) -> str:
    """A value as text of an SSV file; numbers are read back as the same double."""
    if variable.kind == "Enumeration":
        return next((name for name, number in variable.items.items() if number == value), str(value))
    if variable.kind in ("Boolean", "String"):
        return str(value).lower() if isinstance(value, bool) else str(value)
    return repr(value)
