"""Alias files, checked against the variables of an FMU."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from ali3.alias_file import SHIPPED, Content, Entry, alias_file, number, read_content
from ali3.errors import UserError
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.fmu.aliases.alias import Alias, Aliases
from hosts.fmu.aliases.checks import check_unit, declared, factor_of_unit, is_si
from hosts.fmu.aliases.derived_variable import Derived, parse_derived, sort_derived
from hosts.fmu.variables import Variable, Variables

_RECORDED = ("input", "output")


def find_aliases(name: str | Path, variables: Variables) -> Aliases:
    """The aliases of a file of the package, by its name, or of another file.

    `name`: such as ``chrono``, or a path; a file of this name takes precedence. Raises `HostError` as `read_aliases`.
    """
    try:
        path = alias_file(name)
    except UserError as error:
        raise HostError(str(error)) from None
    return read_aliases(path, variables)


def read_aliases(file: Path, variables: Variables | Collection[str]) -> Aliases:
    """Read an alias file.

    Parameters
    ----------
    file : Path
        TOML: ``"ALi3 name" = "name in the FMU"`` or ``"ALi3 name" = { name = "...", factor = 1.0, offset = 0.0 }``:
        value in the FMU = factor * ALi3 value + offset; with ``unit``, the unit of the FMU, this value is in SI units.
        ``"ALi3 name" = { from = "sideslip(chassis.vx, chassis.vy)" }`` computes it. See ``docs/other_names.md``.
    variables : Variables or collection of str
        Variables of the FMU; with names alone, units are not checked.

    Raises
    ------
    HostError
        A fault, with the file, the key and a remedy.
    """
    try:
        content = read_content(file)
    except UserError as error:
        raise HostError(str(error)) from None
    names = set(variables.names if isinstance(variables, Variables) else variables)
    fmu_variables = variables if isinstance(variables, Variables) else None
    constants = _constants(content, fmu_variables)
    missing: dict[str, str] = {}
    needed: set[str] = set()
    aliases = []
    for entry in content.entries.values():
        if "from" in entry.value:
            continue
        why = _reason_missing(entry, names)
        if why:
            missing[entry.ours] = why
        elif entry.value.get("factor") in content.needs and entry.value["factor"] not in constants:
            needed.add(entry.value["factor"])
        else:
            aliases.append(_alias(entry, constants, fmu_variables))
            if fmu_variables is not None and _is_hidden(fmu_variables[entry.value["name"]]):
                missing[entry.ours] = (
                    f"{entry.file} takes '{entry.ours}' from '{entry.value['name']}', which is a local variable of the "
                    "FMU and not an output"
                )
    aliases = [a for a in aliases if not _is_superfluous(a, content.entries[a.name], aliases, names)]
    names_by_fmu_name: dict[str, str] = {}
    for alias in aliases:
        first_name = names_by_fmu_name.setdefault(alias.fmu_name, alias.name)
        if first_name != alias.name:
            raise HostError(f"{file}: '{alias.fmu_name}' is named {first_name} and {alias.name}; give it one name.")
    derived = _derived_variables(content, constants, aliases, names, fmu_variables, missing)
    _check_needed(needed | {n for d in derived for n in d.names if n in content.needs and n not in names}, content)
    if content.entries and not aliases and not derived:
        example = next(iter(content.entries.values()))
        raise HostError(
            f"{file}: of its {len(content.entries)} names this FMU has none, such as "
            f"'{example.value.get('name', example.ours)}'; is it an FMU of that program?"
        )
    return Aliases(tuple(aliases), constants, derived, missing)


def _is_hidden(variable: Variable) -> bool:
    return variable.causality in ("local", "independent") and variable.variability != "constant"


def _constants(content: Content, variables: Variables | None) -> dict[str, float]:
    """Constants of the file, and the needed ones that are constants of the FMU."""
    constants = dict(content.constants)
    for name in content.needs:
        if name not in constants and variables is not None and name in variables.names:
            variable = variables[name]
            if variable.variability == "constant" and isinstance(variable.start, (int, float)):
                constants[name] = float(variable.start)
    return constants


def _check_needed(needed: Collection[str], content: Content) -> None:
    """Raise `HostError` if numbers of the car are needed that are not known."""
    if not needed:
        return
    numbers = ", ".join(f"'{name}' ({content.needs[name]})" for name in content.needs if name in needed)
    file = Path(content.file)
    remedy = (
        f'write a file with extends = "{file.stem}" and them in its table [constants], for --aliases'
        if file.parent == SHIPPED
        else "give them in its table [constants]"
    )
    raise HostError(f"{file.name} needs numbers of this car, {numbers}: {remedy}.")


def _reason_missing(entry: Entry, names: Collection[str]) -> str:
    """Why an optional variable is left out; empty if the FMU has it; `HostError` if a required one is missing."""
    fmu_name = entry.value["name"]
    if fmu_name in names:
        return ""
    if entry.partial:
        return f"{entry.file} takes '{entry.ours}' from '{fmu_name}', which the FMU does not have"
    raise HostError(f"{entry.where}: the FMU has no variable '{fmu_name}'{did_you_mean(fmu_name, names)}")


def _alias(entry: Entry, constants: dict[str, float], variables: Variables | None) -> Alias:
    value, where = entry.value, entry.where
    factor = value.get("factor", 1.0)
    by_constant = isinstance(factor, str)
    if isinstance(factor, str):
        if factor not in constants:
            raise HostError(f"{where}: factor is '{factor}'; it must be a number, or a constant of the file.")
        factor = constants[factor]
    try:
        factor = number(factor, f"{where}: factor")
        offset = number(value.get("offset", 0.0), f"{where}: offset")
    except UserError as error:
        raise HostError(str(error)) from None
    if factor == 0.0:
        raise HostError(f"{where}: factor is 0; it must be another number.")
    unit = value.get("unit")
    variable = None if variables is None else variables[value["name"]]
    if unit is not None:
        factor *= factor_of_unit(unit, variable, where)
    alias = Alias(entry.ours, value["name"], factor, offset)
    if variable is not None:
        check_unit(alias, variable, unit, by_constant, where)
    return alias


def _is_superfluous(alias: Alias, entry: Entry, aliases: list[Alias], names: Collection[str]) -> bool:
    """Whether the FMU has a variable of this ALi3 name, so that a file for many FMUs needs no alias."""
    if alias.name == alias.fmu_name or alias.name not in names or alias.name in {a.fmu_name for a in aliases}:
        return False
    if entry.partial:
        return True
    raise HostError(f"{entry.file}: the FMU has a variable '{alias.name}' itself; it needs no alias.")


def _derived_variables(
    content: Content,
    constants: dict[str, float],
    aliases: list[Alias],
    names: Collection[str],
    variables: Variables | None,
    missing: dict[str, str],
) -> tuple[Derived, ...]:
    """The derived variables that can be computed, each after those that it needs."""
    alias_names = {a.fmu_name: a.name for a in aliases}
    available = {alias_names.get(n, n) for n in names if variables is None or variables[n].causality in _RECORDED}
    requested = []
    for entry in content.entries.values():
        if "from" not in entry.value or entry.ours in available:
            continue
        parsed = parse_derived(entry.ours, entry.value["from"], constants, entry.where)
        arguments = tuple(alias_names.get(a, a) if isinstance(a, str) else a for a in parsed.arguments)
        requested.append(replace(parsed, arguments=arguments))
    computable, lacking = sort_derived(requested, available | set(content.needs))
    for derived_name, name in lacking.items():
        entry = content.entries[derived_name]
        if not entry.partial:
            raise HostError(
                f"{entry.where}: '{name}' is neither an input or output of the FMU nor another name or constant of the "
                f"file{did_you_mean(name, available)}"
            )
        why = missing.get(name, "which the FMU does not have")
        missing[derived_name] = f"{entry.file} computes '{derived_name}' from '{name}', {why}"
    for d in computable:
        where = content.entries[d.name].where
        for name in d.names:
            if (
                variables is not None
                and name in variables.names
                and name not in alias_names.values()
                and not is_si(variables[name])
            ):
                raise HostError(
                    f"{where}: '{name}' is in {declared(variables[name])} in the FMU, formulas take SI units; give it "
                    "a name of its own with that unit and use it here."
                )
    return tuple(computable)
