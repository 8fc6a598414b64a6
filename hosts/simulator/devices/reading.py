"""The state of a device at one instant, and the axes and buttons that can move an input."""

from __future__ import annotations

import re
from dataclasses import dataclass

from hosts.common.errors import HostError

WAYS = {"up": 1, "right": 2, "down": 4, "left": 8}
"""Bits of a hat, as SDL has them."""
_SOURCE = re.compile(r"(axis|button) (\d{1,3})|hat (\d{1,3}) (up|right|down|left)")


@dataclass(frozen=True)
class Reading:
    """Values of a device."""

    axes: tuple[float, ...] = ()
    """From -1 to 1."""
    known: tuple[bool, ...] = ()
    """Whether the device has told the value of this axis; else it reads 0."""
    buttons: tuple[bool, ...] = ()
    hats: tuple[int, ...] = ()
    """Bits of `WAYS`."""

    def counts(self) -> str:
        """A count with its noun, as text."""
        return f"axes: {len(self.axes)}, buttons: {len(self.buttons)}, hats: {len(self.hats)}, numbered from 0"

    def pressed(self) -> set[str]:
        """Sources that are pressed: buttons and ways of hats."""
        results = {f"button {k}" for k, down in enumerate(self.buttons) if down}
        for k, bits in enumerate(self.hats):
            results.update(f"hat {k} {direction}" for direction, bit in WAYS.items() if bits & bit)
        return results


@dataclass(frozen=True)
class Source:
    """An axis, a button or a way of a hat."""

    kind: str
    """``axis``, ``button`` or ``hat``."""
    number: int
    way: str = ""

    @classmethod
    def read(cls, text: object) -> Source:
        """From its words: ``axis 2``, ``button 7``, ``hat 0 up``. Raises `HostError`: it is no such word."""
        result = _SOURCE.fullmatch(text) if isinstance(text, str) else None
        if result is None:
            raise HostError(f"{text!r} is not a source; “axis 2”, “button 7” or “hat 0 up” would be.")
        if result[1]:
            return cls(result[1], int(result[2]))
        return cls("hat", int(result[3]), result[4])

    def __str__(self) -> str:
        return f"{self.kind} {self.number} {self.way}".strip()

    def is_in(self, reading: Reading) -> bool:
        """Whether a device has this source."""
        return self.number < len({"axis": reading.axes, "button": reading.buttons, "hat": reading.hats}[self.kind])

    def position(self, reading: Reading) -> float | None:
        """Where it is: an axis from -1 to 1, the others 0 or 1; None where the device does not say."""
        if not self.is_in(reading):
            return None
        if self.kind == "axis":
            return reading.axes[self.number] if reading.known[self.number] else None
        if self.kind == "button":
            return float(reading.buttons[self.number])
        return float(bool(reading.hats[self.number] & WAYS[self.way]))
