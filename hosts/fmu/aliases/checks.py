"""Checks of the units that an alias file states against those that the FMU declares."""

import math
from typing import Any

from ali3.message_text import brief
from ali3.unit_definition import UnitDefinition
from ali3.units import known_unit, same_quantity
from hosts.common.errors import HostError
from hosts.common.units import is_plain_one, unit_of
from hosts.fmu.aliases.alias import Alias
from hosts.fmu.variables import Variable

_TOLERANCE = 1e-3
"""Relative difference between factors that count as equal, such as 57.3 for degrees per radian."""


def declared(variable: Variable) -> str:
    """The unit that the FMU declares."""
    return variable.unit


def unit_definition(variable: Variable) -> UnitDefinition | None:
    """The definition of the unit of a real variable; None if the unit has no meaning or is unknown."""
    unit = variable.definition or known_unit(variable.unit or "")
    return None if unit is None or variable.kind != "Real" or is_plain_one(unit) else unit


def is_si(variable: Variable) -> bool:
    """Whether a variable is in SI units, or declares no known unit."""
    unit = unit_definition(variable)
    return unit is None or (math.isclose(unit.factor, 1.0, rel_tol=_TOLERANCE) and unit.offset == 0.0)


def factor_of_unit(unit: Any, variable: Variable | None, where: str) -> float:
    """The factor from SI units to a unit of an alias file.

    `variable`: variable of the FMU; its definition of a unit of this name takes precedence. Raises `HostError` if the
    unit is unknown, or the FMU declares another.
    """
    declared_unit = variable.definition if variable is not None and variable.unit == unit else None
    file_unit = declared_unit or (known_unit(unit) if isinstance(unit, str) else None)
    if file_unit is None:
        raise HostError(f"{where}: the unit {brief(unit)} is not known (such as m, km/h, deg or rpm); give a factor.")
    if file_unit.offset:
        raise HostError(f"{where}: the unit {brief(unit)} has another zero than the SI unit; give factor and offset.")
    if variable is not None:
        fmu_unit = unit_definition(variable)
        if fmu_unit is not None and not _are_equal(file_unit, fmu_unit):
            raise HostError(
                f"{where}: the file says that '{variable.name}' is in {unit}, the FMU declares {declared(variable)}; "
                "one of them is wrong."
            )
    return 1.0 / file_unit.factor


def check_unit(alias: Alias, variable: Variable, unit: str | None, by_constant: bool, where: str) -> None:
    """Refuse a factor that contradicts the unit that the FMU declares.

    Raises `HostError` with the unit, the factor and the expected factor.
    """
    unit_text, fmu_unit = unit_of(alias.name), unit_definition(variable)
    if unit_text is None or fmu_unit is None or by_constant:
        return
    ali3_unit = known_unit(unit_text)
    if ali3_unit is not None and not same_quantity(ali3_unit, fmu_unit):
        raise HostError(
            f"{where} is in {unit_text}, but the FMU declares '{variable.name}' in {declared(variable)}, another "
            "quantity."
        )
    if unit is not None or ali3_unit is None:
        return
    expected = [1.0 / fmu_unit.factor]
    if ali3_unit.exponents.get("rad") and not fmu_unit.exponents.get("rad") and "s" in fmu_unit.exponents:
        expected.append(1.0 / (2.0 * math.pi * fmu_unit.factor))  # revolutions
    if not any(math.isclose(abs(alias.factor), e, rel_tol=_TOLERANCE) for e in expected):
        raise HostError(
            f"{where} is in {unit_text} and '{variable.name}' in the FMU in {declared(variable)}: its factor must be "
            f"{expected[0]:.6g} (or negative), it is {alias.factor:.6g}."
        )


def _are_equal(one: UnitDefinition, other: UnitDefinition) -> bool:
    if not same_quantity(one, other):
        return False
    if math.isclose(one.factor, other.factor, rel_tol=_TOLERANCE):
        return True
    turns = 2.0 * math.pi  # revolutions per minute, with and without rad
    return "s" in one.exponents and any(
        math.isclose(one.factor, other.factor * f, rel_tol=_TOLERANCE) for f in (turns, 1.0 / turns)
    )
