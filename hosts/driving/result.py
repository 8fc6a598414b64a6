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
    """Messages of the FMU at warning or above."""
    held: list[str] = field(default_factory=list)
    """Inputs that were constant over each step; the others were linear in time."""
    late: list[str] = field(default_factory=list)
    """Inputs of `held` that the manoeuvre changes within steps: the FMU takes no input derivatives, or a driver
    controls them."""
    jumps: dict[int, list[float]] = field(default_factory=dict)
    """By row number, the inputs before a jump at its time, if the rows alone do not show it."""
    starts: list[int] = field(default_factory=lambda: [0])
    """First row of each of several runs in sequence."""
    lost: list[str] = field(default_factory=list)
    """Inputs that are not linear between rows of several steps."""
    missed: list[tuple[str, str]] = field(default_factory=list)
    """Parts of the manoeuvre that the run could not follow: subject and text."""
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
        """The refused step with its reason, or the end of the process, as part of a sentence; empty if all steps were
        made.
        """
        if self.ended or not self.failed_steps:
            return self.ended[:1].lower() + self.ended[1:].rstrip(".")
        reason = f": {self.messages[-1].rstrip('.')}" if self.messages else ""
        return f"the FMU refused the step at {self.simulated:.5g} s{reason}"

    def not_finite(self) -> str:
        """A sentence on the first value that is not finite; empty if there is none."""
        wrong = ~np.isfinite(self.values)
        if not wrong.any():
            return ""
        row, column = np.argwhere(wrong)[0]
        return f"The output '{self.names[column]}' is {self.values[row, column]} at {self.time[row]:g} s."

    def remarks(self) -> list[str]:
        """Lines for the user: what the FMU logged, how its process ended, and the first value that is not finite."""
        messages = [f"FMU: {message}" for message in dict.fromkeys(self.messages)]
        return [*messages, *filter(None, (self.ended, self.not_finite()))]

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
