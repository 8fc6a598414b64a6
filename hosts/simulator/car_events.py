"""Settings, states and events that pass between the car's process and the main process."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.simulator.shared_values import MOMENT


@dataclass(frozen=True)
class CarSettings:
    """Settings of the start of a car."""

    fmu: Path
    """Of FMI 2.0, co-simulation."""
    start: Mapping[str, Value]
    """Parameters and start values."""
    step: float = 0.002
    """Communication step, s."""
    paced: bool = True
    """False: as fast as it goes."""
    record: Path | None = None
    interval: float | None = None
    """Between recorded outputs, s; by default see `hosts.recordings.recorded_columns`."""
    priority: bool = True
    """Whether to ask for real-time priority; what was got is an event."""
    world: str | None = None
    """What a recording calls the world."""
    seed: int | None = None


@dataclass(frozen=True)
class CarState:
    """The car after a step."""

    count: int
    """Steps computed; it never falls."""
    time: float
    """Simulated time, s; it falls at a rewind or reset."""
    epoch: int
    """One more at every jump: nothing may be interpolated across it."""
    running: bool
    refused: bool
    behind: bool
    """`running`, `refused`, `behind`: not paused; the FMU refused the last step; the car is late, or was within the
    last second."""
    speed: float
    """Simulated over wall seconds that are asked for."""
    wall: float
    """When this was written, by `time.perf_counter`, which all processes of a machine share, s."""
    cost: float
    worst: float
    lateness: float
    """`cost`, `worst`, `lateness`: work of the last step, largest of about the last second, and begin of the last step
    after its time, s."""
    missed: int
    """Deadlines missed so far."""
    saved: float
    """Simulated time that can be rewound, s."""
    values: NDArray[np.float64]
    """Shape (n,): one for each of `Car.names`, in the units of the model description."""

    @staticmethod
    def of(record: NDArray[np.float64]) -> CarState:
        """From the shared memory."""
        numbers = dict(zip(MOMENT, record.tolist(), strict=False))
        integers = {name: int(numbers[name]) for name in ("count", "epoch", "missed")}
        flags = {name: bool(numbers[name]) for name in ("running", "refused", "behind")}
        return CarState(**(numbers | integers | flags), values=record[len(MOMENT) :])


@dataclass(frozen=True)
class Event:
    """Something that is to be said."""

    time: float
    """Simulated time, s."""
    kind: str
    """``told``, ``refused``, ``capped``, ``behind``, ``reset``, ``rewind``, ``upright``, ``priority``, ``overflow``."""
    text: str
    """One or two sentences."""
