"""The flexible frame and its tables beside the car file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mbs.errors import ModelError

if TYPE_CHECKING:
    from mbs.vehicle.car import Car


def frame_faults(car: Car) -> Iterator[str]:
    """The first fault, since others follow from it.

    Parameters
    ----------
    car : Car
        Each number of it is in its range.
    """
    frame = car.chassis.frame
    if frame is None:
        return
    try:
        frame.check(car.folder)
    except ModelError as error:
        yield str(error)
