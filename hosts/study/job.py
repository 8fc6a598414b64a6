"""What is done at each point of a study."""

from __future__ import annotations

from dataclasses import dataclass, field

from hosts.common.numbers import Value
from hosts.driving.manoeuvre import Manoeuvre


@dataclass(frozen=True)
class Job:
    """What is done at each point."""

    label: str
    manoeuvre: Manoeuvre | None
    """With all start values but the parameters."""
    test: str = ""
    """Of the catalogue, where there is no manoeuvre."""
    settings: dict[str, float] = field(default_factory=dict)
    measures: tuple[str, ...] = ()
    """Of the test; empty: all."""
    start: dict[str, Value] = field(default_factory=dict)
    step: float = float("nan")
    """Communication step, s; NaN for a test that takes that of the FMU."""
    every: int = 0
    """Steps between kept values of signals; 0: none are kept."""
    samples: int = 0
    """Kept values."""
