"""What tyres of a car file share, whatever their formula."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mbs.vehicle.section import Section

FRICTION = 0.2, 3.0  # largest force over the load


class TyreSection(Section):
    """Tyres of an axle."""

    def open(self, folder: Path) -> None:
        """Read their file, if there is one; done once by the reader of the car.

        Raises `CarFileError`: it is missing, or not right.
        """

    @staticmethod
    def friction_faults(what: str, friction: float) -> Iterator[str]:
        """Whether the largest force over the load can be that of a tyre. `what`: begins the sentence."""
        if not FRICTION[0] <= friction <= FRICTION[1]:
            yield f"{what} friction of {friction:.3g}; it must be between {FRICTION[0]:g} and {FRICTION[1]:g}."
