"""What a run recorded."""

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
    """What a run recorded."""

    names: list[str]
    """Inputs and outputs."""
    units: dict[str, str]
    """By name."""
    time: NDArray[np.float64]
    """Shape (n,): s."""
    values: NDArray[np.float64]
    """Shape (n, len(names)): in the units of the model description. Inputs are those with which the next step begins;
    in the last row those with which the last step ended, or with which one that was refused would have begun."""
    wall: float
    """Time spent in the loop, s."""
    simulated: float
    """s."""
    failed_steps: int
    """Communication steps the FMU refused; the run ends with the first."""
    messages: list[str]
    """What the FMU logged at warning or above."""
    held: list[str] = field(default_factory=list)
    """Inputs that kept their value over each step; the others went straight."""
    late: list[str] = field(default_factory=list)
    """Those of them that were to move between the steps: the FMU takes no input derivatives, or a driver acts on
    them."""
    jumps: dict[int, list[float]] = field(default_factory=dict)
    """By the number of a row: inputs before a jump at its time, where the row alone does not tell them."""
    starts: list[int] = field(default_factory=lambda: [0])
    """Rows at which runs begin that were put one after the other."""
    lost: list[str] = field(default_factory=list)
    """Inputs that moved between the rows otherwise than the rows tell, where not every step has one."""
    missed: list[tuple[str, str]] = field(default_factory=list)
    """What `Manoeuvre.late_begin`, `missed_inputs` and `missed_end` say of the manoeuvre."""
    notes: list[tuple[str, str]] = field(default_factory=list)
    """What else is said of the manoeuvre: what and how much."""
    start: Mapping[str, Value] = field(default_factory=dict)
    """What was set before the start."""
    marks: list[dict[str, Any]] = field(default_factory=list)
    """What the manoeuvre has on the ground, see `hosts.driving.ground_marks`."""

    ended: str = ""
    """Where the process of the FMU has ended before the run: a sentence that says how."""

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
        row, place = np.argwhere(wrong)[0]
        return f"The output '{self.names[place]}' is {self.values[row, place]} at {self.time[row]:g} s."

    def __contains__(self, name: str) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self.names:
            raise HostError(f"The car does not provide {name}.")
        return np.asarray(self.values[:, self.names.index(name)])

    def continuous(self, name: str) -> NDArray[np.float64]:
        """A signal; of runs that were put one after the other each, an angle (rad) without jumps by whole turns."""
        values = self[name]
        if self.units.get(name) != "rad":
            return values
        return np.concatenate([continuous(part) for part in np.split(values, self.starts[1:])])
