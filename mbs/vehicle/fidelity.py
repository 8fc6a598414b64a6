"""Levels of detail of the chassis model."""

from __future__ import annotations

from enum import IntEnum

from mbs.common.errors import ModelError


class Fidelity(IntEnum):
    """Model of the chassis; inputs, parameters and outputs of the car are the same with each.

    The numbers are identifiers without an order; those from 100 on are for comparison.
    """

    description: str
    """What the model contains."""

    def __new__(cls, number: int, description: str) -> Fidelity:
        """Make a member of a number with its description."""
        member = int.__new__(cls, number)
        member._value_ = number
        member.description = description
        return member

    RIGID = 0, "rigid, stresses of an FMU when they are read"
    QUASI_STATIC = 1, "rigid, quasi-static stresses by inertia relief"
    LOAD_PATHS = 2, "flexible, static modes of the load paths"
    DYNAMIC = 3, "flexible, static, inertia and 5 dynamic modes"
    MANY_MODES = 4, "flexible, static, inertia and 40 dynamic modes"
    TABLE = 10, "rigid, suspensions by tables that are made of their links"
    PAPER = 100, "flexible, 60 static and 5 dynamic modes as in the paper, without inertia modes"

    @property
    def rigid(self) -> bool:
        """Whether the chassis is one rigid body without ports."""
        return self in (Fidelity.RIGID, Fidelity.TABLE)

    @classmethod
    def of(cls, value: int | str) -> Fidelity:
        """The member with a number or a name.

        Parameters
        ----------
        value : int or str
            A member, its number, or its name in any case.
        """
        if isinstance(value, str):
            fidelity = cls.__members__.get(value.upper())
        else:
            fidelity = next((member for member in cls if member == value and not isinstance(value, bool)), None)
        if fidelity is None:
            names = ", ".join(f"{member.value} {member.name.lower()}" for member in cls)
            raise ModelError(f"The fidelity of the car is {value!r}; it must be one of: {names}.")
        return fidelity


OFFERED = (Fidelity.RIGID, Fidelity.QUASI_STATIC, Fidelity.LOAD_PATHS, Fidelity.DYNAMIC)
"""Levels between which an FMU chooses by its parameter `fidelity`."""
