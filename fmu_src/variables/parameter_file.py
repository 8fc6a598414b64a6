"""Parameter set (SSV) written beside an FMU: all its parameters with their defaults, to be edited."""

import math
from collections.abc import Sequence
from pathlib import Path

from ali3.message_text import range_text
from ali3.parameter_set import Entry, ParameterSet, parameter_text
from ali3.write_parameter_set import is_as_built, write_parameter_set
from fmu_src.variables.text_variables import TextVariable
from fmu_src.variables.units import parse_unit
from fmu_src.variables.variables import Variable


def parameter_set(name: str, table: Sequence[Variable], texts: Sequence[TextVariable] = ()) -> ParameterSet:
    """Parameter set with the start values of all parameters of a table of variables, and of text variables."""
    parameters = [v for v in table if v.causality == "parameter" and v.start is not None]
    units = {v.unit: parse_unit(v.unit, foreign=bool(v.ours)) for v in parameters if not v.whole}
    text_entries = [Entry(t.name, "String", t.start, None, parameter_text(t.description, "", "fixed")) for t in texts]
    return ParameterSet(name, [_entry(v) for v in parameters] + text_entries, dict(sorted(units.items())))


def write_beside(parameters: ParameterSet, file: Path) -> bool:
    """Write the file unless an existing one was edited since it was built. Returns whether it was written."""
    if file.exists() and not is_as_built(file):
        return False
    write_parameter_set(parameters, file, as_built=True)
    return True


def _entry(v: Variable) -> Entry:
    """Entry of a parameter, with its start value, unit and a text that states its range."""
    assert v.start is not None
    least = -math.inf if v.min is None else v.min
    most = math.inf if v.max is None else v.max
    bounds = range_text(least, most, "1" if v.whole else v.unit)
    text = parameter_text(v.description, bounds, v.variability)
    if v.whole:
        return Entry(v.name, "Integer", str(int(v.start)), None, text)
    return Entry(v.name, "Real", repr(float(v.start)), v.unit, text)
