"""The state of a device at one instant, and the axes and buttons that can move an input."""

from __future__ import annotations

import re
from dataclasses import dataclass

from hosts.common.errors import HostError

DIRECTIONS = {"up": 1, "right": 2, "down": 4, "left": 8}
"""Bits of the directions of a hat in SDL."""
_SOURCE = re.compile(r"(axis|button) (\d{1,3})|hat (\d{1,3}) (up|right|down|left)")


@dataclass(frozen=True)
class Reading:
    """Values of a device."""

    axes: tuple[float, ...] = ()
    """From -1 to 1."""
    known: tuple[bool, ...] = ()
    """Whether the value of each axis is known; an unknown one reads 0."""
    buttons: tuple[bool, ...] = ()
    hats: tuple[int, ...] = ()
    """Bits of `DIRECTIONS`."""

    def counts(self) -> str:
        """The numbers of axes, buttons and hats, as text."""
        return f"axes: {len(self.axes)}, buttons: {len(self.buttons)}, hats: {len(self.hats)}, numbered from 0"

    def pressed(self) -> set[str]:
        """Pressed sources: buttons and directions of hats."""
        results = {f"button {k}" for k, down in enumerate(self.buttons) if down}
        for k, bits in enumerate(self.hats):
            results.update(f"hat {k} {direction}" for direction, bit in DIRECTIONS.items() if bits & bit)
        return results


@dataclass(frozen=True)
class Source:
    """An axis, a button or a direction of a hat."""

    kind: str
    """``axis``, ``button`` or ``hat``."""
    number: int
    direction: str = ""

    @classmethod
    def read(cls, text: object) -> Source:
        """The source of a text: ``axis 2``, ``button 7``, ``hat 0 up``. Raises `HostError` if the text is not valid."""
        match = _SOURCE.fullmatch(text) if isinstance(text, str) else None
        if match is None:
            raise HostError(f"{text!r} is not a source; “axis 2”, “button 7” or “hat 0 up” would be.")
        if match[1]:
            return cls(match[1], int(match[2]))
        return cls("hat", int(match[3]), match[4])

    def __str__(self) -> str:
        return f"{self.kind} {self.number} {self.direction}".strip()

    def is_in(self, reading: Reading) -> bool:
        """Whether a device has this source."""
        return self.number < len({"axis": reading.axes, "button": reading.buttons, "hat": reading.hats}[self.kind])

    def position(self, reading: Reading) -> float | None:
        """The value of an axis, from -1 to 1, or of another source, 0 or 1; None if it is not known."""
        if not self.is_in(reading):
            return None
        if self.kind == "axis":
            return reading.axes[self.number] if reading.known[self.number] else None
        if self.kind == "button":
            return float(reading.buttons[self.number])
        return float(bool(reading.hats[self.number] & DIRECTIONS[self.direction]))
