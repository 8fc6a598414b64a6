"""The result of a run: recorded signals, and notes on what could not be simulated as requested."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.angles import continuous
from hosts.common.errors import HostError
from hosts.common.numbers import Value


@dataclass(frozen=True)
class Result:
    """The recorded signals of a run."""

    names: list[str]
    """Inputs and outputs."""
    units: dict[str, str]
    """By name."""
    time: NDArray[np.float64]
    """Shape (n,): s."""
    values: NDArray[np.float64]
    """Shape (n, len(names)), in the units of the model description. The inputs of a row are those with which the step
    from there begins; of the last row, those with which the last step ended or a refused step would have begun."""
    wall: float
    """Wall time of the loop, s."""
    simulated: float
    """Simulated time, s."""
    failed_steps: int
    """Number of communication steps that the FMU refused: 0 or 1, because the run ends there."""
    messages: list[str]
    """What the FMU logged at warning or above."""
    held: list[str] = field(default_factory=list)
    """Inputs that were constant over each step; the others were linear in time."""
    late: list[str] = field(default_factory=list)
    """Inputs of `held` that the manoeuvre changes within steps: the FMU takes no input derivatives, or a driver
    controls them."""
    jumps: dict[int, list[float]] = field(default_factory=dict)
    """Inputs before a jump at the time of a row, by its number, where the rows do not show them."""
    starts: list[int] = field(default_factory=lambda: [0])
    """First row of each run, where several runs stand one after the other."""
    lost: list[str] = field(default_factory=list)
    """Inputs that are not linear between rows, where rows are farther apart than steps."""
    missed: list[tuple[str, str]] = field(default_factory=list)
    """What the run did not do of the manoeuvre: see `Manoeuvre.late_begin`, `missed_inputs` and `missed_end`."""
    notes: list[tuple[str, str]] = field(default_factory=list)
    """Other remarks on the manoeuvre: subject and text."""
    start: Mapping[str, Value] = field(default_factory=dict)
    """Start values and parameters that were set."""
    marks: list[dict[str, Any]] = field(default_factory=list)
    """Marks of the manoeuvre on the ground, see `hosts.driving.ground_marks`."""
    ended: str = ""
    """A sentence that says how the process of the FMU ended, if it ended before the run did; else empty."""

    @property
    def is_good(self) -> bool:
        """Whether the FMU made every step, and all values are numbers."""
        return not (self.failed_steps or self.ended or self.not_finite())

    @property
    def refusal(self) -> str:
        """When and why the FMU refused a step, or how its process ended, as the end of a sentence; empty where
        it made all steps.
        """
        if self.ended or not self.failed_steps:
            return self.ended[:1].lower() + self.ended[1:].rstrip(".")
        reason = f": {self.messages[-1].rstrip('.')}" if self.messages else ""
        return f"the FMU refused the step at {self.simulated:.5g} s{reason}"

    def not_finite(self) -> str:
        """The first value that is not a number, in a sentence; empty where all are."""
        wrong = ~np.isfinite(self.values)
        if not wrong.any():
            return ""
        row, column = np.argwhere(wrong)[0]
        return f"The output '{self.names[column]}' is {self.values[row, column]} at {self.time[row]:g} s."

    def __contains__(self, name: str) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self.names:
            raise HostError(f"The car does not provide {name}.")
        return np.asarray(self.values[:, self.names.index(name)])

    def continuous(self, name: str) -> NDArray[np.float64]:
        """A signal; an angle (rad) without jumps by whole turns, within each of several runs."""
        values = self[name]
        if self.units.get(name) != "rad":
            return values
        return np.concatenate([continuous(part) for part in np.split(values, self.starts[1:])])
