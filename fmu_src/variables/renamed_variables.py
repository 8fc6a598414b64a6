"""Variables under names and in units of another program."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ali3.alias_file import Content, Entry, number
from ali3.errors import UserError
from ali3.near_names import did_you_mean
from fmu_src.variables.units import DISPLAY_UNITS, parse_unit
from fmu_src.variables.variables import Variable, check_names

_SCALED = ("input", "sensor")


@dataclass(frozen=True)
class Renamed:
    """A table under other names."""

    table: tuple[Variable, ...]
    """In the same order."""
    left_out: Mapping[str, str]
    """Names of variables that keep them although the file has other ones, with the reason."""

    @property
    def named(self) -> dict[str, Variable]:
        """Variables that have another name, by our name."""
        return {v.ours: v for v in self.table if v.ours}


def renamed(table: Sequence[Variable], content: Content) -> Renamed:
    """The variables as an alias file calls them.

    `table`: with our names; `content`: of the file. Variables that it computes from several, or with an offset, keep
    our name. Raises `UserError`: the file names none of the variables, without ``partial`` one that does not exist, a
    name twice, or one that no variable of an FMU can have.
    """
    index = {v.name: k for k, v in enumerate(table)}
    values = {v.name: v for v in table if v.source == "constant"}
    # watches of answers compare triples of values with those of the System and of the wheel
    watched = {v.index for v in table if v.source == "ahead"} | {v.other for v in table if v.source == "ahead"}
    watched |= {k + j for at, v in enumerate(table) if v.role for k in (at, v.other) if k >= 0 for j in range(3)}
    variables, left_out = list(table), {}
    for ours, entry in content.entries.items():
        if ours not in index:
            if not entry.partial and "from" not in entry.value:
                hint = did_you_mean(ours, index)
                raise UserError(f"{entry.where}: this model has no such variable{hint} partial = true leaves it out.")
            continue
        k = index[ours]
        renamed_variable = _renamed_variable(table[k], entry, content, values)
        if isinstance(renamed_variable, Variable) and renamed_variable.scale != 1.0 and k in watched:
            renamed_variable = f"it is of a port, which works in {table[k].unit}"
        if isinstance(renamed_variable, str):
            left_out[ours] = renamed_variable
        else:
            variables[k] = renamed_variable
    result = Renamed(tuple(variables), left_out)
    if not result.named:
        raise UserError(f"{content.file}: this model has none of the variables that it names, such as 'speed'.")
    try:
        check_names(result.table)
    except ValueError as error:
        raise UserError(f"{content.file}: {error}") from None
    return result


def _renamed_variable(v: Variable, entry: Entry, content: Content, values: Mapping[str, Variable]) -> Variable | str:
    """The variable under its other name, or the reason why it has none."""
    value = entry.value
    if "from" in value:
        return "the other program has it only in another form, from which it is computed"
    if value.get("offset", 0.0) != 0.0:
        return f"'{value['name']}' has another zero"
    factor, unit = value.get("factor", 1.0), value.get("unit")
    if isinstance(factor, str):
        constant = values.get(factor)
        if constant is None and factor not in content.constants:
            if factor not in content.needs:
                raise UserError(f"{entry.where}: factor is '{factor}'; it must be a number, or a constant of the file.")
            return f"it needs '{factor}' ({content.needs[factor]}): give it in a file that extends this one"
        base = v.unit if constant is None or constant.start is None else constant.unit
        factor = content.constants.get(factor, constant.start if constant is not None else None)
    else:
        base = v.unit
    target_unit = base if unit is None else unit
    scale = number(factor, f"{entry.where}: factor") / _factor(target_unit, base, entry)
    if scale == 0.0:
        raise UserError(f"{entry.where}: factor is 0; it must be another number.")
    if scale != 1.0 and (v.source not in _SCALED or v.whole):
        return f"'{value['name']}' is in another unit, which only real inputs and outputs can have"
    limits = [None if end is None else scale * end for end in (v.min, v.max)]
    low, high = limits if scale > 0.0 else reversed(limits)
    return replace(
        v,
        name=value["name"],
        ours=v.name,
        scale=scale,
        unit=target_unit,
        start=None if v.start is None else scale * v.start,
        min=low,
        max=high,
        nominal=None if v.nominal is None else 10.0 ** math.floor(math.log10(abs(scale) * v.nominal)),
        display_unit=v.display_unit if v.display_unit in DISPLAY_UNITS.get(target_unit, {}) else None,
        description=f"{v.description} ({v.name} of ALi3)".lstrip(),
    )


def _factor(unit: str, base: str, entry: Entry) -> float:
    """The factor of a unit to the SI unit of its quantity."""
    try:
        target_unit, base_unit = parse_unit(unit, foreign=True), parse_unit(base)
    except ValueError as error:
        raise UserError(f"{entry.where}: {error}") from None
    if target_unit.exponents != base_unit.exponents and (base != "1" or "factor" not in entry.value):
        raise UserError(f"{entry.where} is in {base}, and {unit} is of another quantity.")
    return target_unit.factor
