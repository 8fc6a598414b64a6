"""What is done at each point of a study."""

from __future__ import annotations

from dataclasses import dataclass, field

from hosts.common.numbers import Value
from hosts.driving.manoeuvre import Manoeuvre


@dataclass(frozen=True)
class Job:
    """What is done at each point.

    Parameters
    ----------
    manoeuvre : Manoeuvre, optional
        With all start values but the parameters.
    test : str
        Of the catalogue, where there is no manoeuvre.
    measures : tuple of str
        Of the test; empty: all.
    step : float
        Communication step, s; NaN for a test that takes that of the FMU.
    every : int
        Steps between kept values of signals; 0: none are kept.
    samples : int
        Kept values.
    """

    label: str
    manoeuvre: Manoeuvre | None
    test: str = ""
    settings: dict[str, float] = field(default_factory=dict)
    measures: tuple[str, ...] = ()
    start: dict[str, Value] = field(default_factory=dict)
    step: float = float("nan")
    every: int = 0
    samples: int = 0
