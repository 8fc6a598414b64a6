"""The parameter set that lies beside an FMU: all its parameters with their defaults, for a person to edit."""

import math
from collections.abc import Sequence
from pathlib import Path

from ali3.message_text import range_text
from ali3.parameter_set import Entry, ParameterSet, parameter_text
from ali3.unit_definition import UnitDefinition
from ali3.write_parameter_set import is_as_built, write_parameter_set
from fmu_src.variables.text_variables import TextVariable
from fmu_src.variables.units import parse_unit
from fmu_src.variables.variables import Variable


def parameter_set(name: str, table: Sequence[Variable], texts: Sequence[TextVariable] = ()) -> ParameterSet:
    """All parameters of a table of variables."""
    chosen = [v for v in table if v.causality == "parameter" and v.start is not None]
    units = {v.unit: parse_unit(v.unit, foreign=bool(v.ours)) for v in chosen if not v.whole}
    definitions = {n: UnitDefinition(u.exponents, u.factor) for n, u in sorted(units.items())}
    written = [Entry(t.name, "String", t.start, None, parameter_text(t.description, "", "fixed")) for t in texts]
    return ParameterSet(name, [_entry(v) for v in chosen] + written, definitions)


def write_beside(parameters: ParameterSet, file: Path) -> bool:
    """Write the file unless a person has changed the one that is there. Returns whether it was written."""
    if file.exists() and not is_as_built(file):
        return False
    write_parameter_set(parameters, file, as_built=True)
    return True


def _entry(v: Variable) -> Entry:
    assert v.start is not None
    bounds = range_text(
        -math.inf if v.min is None else v.min, math.inf if v.max is None else v.max, "1" if v.whole else v.unit
    )
    text = parameter_text(v.description, bounds, v.variability)
    if v.whole:
        return Entry(v.name, "Integer", str(int(v.start)), None, text)
    return Entry(v.name, "Real", repr(float(v.start)), v.unit, text)
