"""What a run recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value


@dataclass(frozen=True)
class Result:
    """What a run recorded.

    Parameters
    ----------
    names : list of str
        Inputs and outputs.
    units : dict of str to str
        By name.
    time : ndarray of shape (n,)
        s.
    values : ndarray of shape (n, len(names))
        In the units of the model description. Inputs are those with which the next step begins; in the last row those
        with which the last step ended, or with which one that was refused would have begun.
    wall : float
        Time spent in the loop, s.
    simulated : float
        s.
    failed_steps : int
        Communication steps the FMU refused; the run ends with the first.
    messages : list of str
        What the FMU logged at warning or above.
    held : list of str
        Inputs that kept their value over each step; the others went straight.
    late : list of str
        Those of them that were to move between the steps: the FMU takes no input derivatives, or a driver acts on them.
    jumps : dict of int to list of float
        By the number of a row: inputs before a jump at its time, where the row alone does not tell them.
    starts : list of int
        Rows at which runs begin that were put one after the other.
    lost : list of str
        Inputs that moved between the rows otherwise than the rows tell, where not every step has one.
    missed : list of (str, str)
        What `missed_jumps` and `missed_end` say of the manoeuvre.
    start : mapping of str to float, int, bool or str
        What was set before the start.
    marks : list of dict
        What the manoeuvre has on the ground, see `hosts.driving.ground_marks`.
    """

    names: list[str]
    units: dict[str, str]
    time: NDArray[np.float64]
    values: NDArray[np.float64]
    wall: float
    simulated: float
    failed_steps: int
    messages: list[str]
    held: list[str] = field(default_factory=list)
    late: list[str] = field(default_factory=list)
    jumps: dict[int, list[float]] = field(default_factory=dict)
    starts: list[int] = field(default_factory=lambda: [0])
    lost: list[str] = field(default_factory=list)
    missed: list[tuple[str, str]] = field(default_factory=list)
    start: Mapping[str, Value] = field(default_factory=dict)
    marks: list[dict[str, Any]] = field(default_factory=list)

    def __contains__(self, name: str) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return np.asarray(self.values[:, self.names.index(name)])
