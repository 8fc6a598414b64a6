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
    """For co-simulation."""
    start: Mapping[str, Value]
    """Parameters and start values."""
    step: float = 0.002
    """Communication step, s."""
    paced: bool = True
    """Whether steps are made in real time, otherwise as fast as possible."""
    record: Path | None = None
    interval: float | None = None
    """Between recorded outputs, s; default: see `hosts.recordings.recording`."""
    priority: bool = True
    """Whether to request real-time priority; an event reports the result."""
    world: str | None = None
    """Name of the world in a recording."""
    seed: int | None = None


@dataclass(frozen=True)
class CarState:
    """The car after a step."""

    count: int
    """Steps computed so far, also before a rewind or reset."""
    time: float
    """Simulated time, s; it decreases at a rewind or reset."""
    epoch: int
    """Number of rewinds and new starts so far; values must not be interpolated across them."""
    running: bool
    """Whether the car is not paused."""
    refused: bool
    """Whether the FMU refused the last step."""
    behind: bool
    """Whether the car is late or was late within the last second."""
    speed: float
    """Requested ratio of simulated to wall time."""
    wall: float
    """Time of writing, by `time.perf_counter`, which all processes of a machine share, s."""
    cost: float
    """Wall time of the last step, s."""
    worst: float
    """Largest wall time of a step of about the last second, s."""
    lateness: float
    """Delay of the start of the last step, s."""
    missed: int
    """Deadlines missed so far."""
    saved: float
    """Simulated time that can be rewound, s."""
    values: NDArray[np.float64]
    """Values of `Car.names`, shape (n,), in the units of the model description."""

    @staticmethod
    def of(record: NDArray[np.float64]) -> CarState:
        """The state of a record of the shared memory."""
        numbers = dict(zip(MOMENT, record.tolist(), strict=False))
        integers = {name: int(numbers[name]) for name in ("count", "epoch", "missed")}
        flags = {name: bool(numbers[name]) for name in ("running", "refused", "behind")}
        return CarState(**(numbers | integers | flags), values=record[len(MOMENT) :])


@dataclass(frozen=True)
class Event:
    """An event of a drive with a message for the user."""

    time: float
    """Simulated time, s."""
    kind: str
    """``told``, ``refused``, ``capped``, ``behind``, ``reset``, ``rewind``, ``upright``, ``priority``, ``overflow``."""
    text: str
    """One or two sentences."""
