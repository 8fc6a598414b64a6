"""A car that is tested: an FMU, our names for its variables, and what is set in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from hosts.aliases import Aliases
from hosts.co_simulation import Result
from hosts.manoeuvre import Manoeuvre
from hosts.numbers import Value


class Pilot(Protocol):
    """Who drives: from what the car senses to its inputs."""

    def act(self, time: float, senses: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step; `senses` are all outputs by our names."""
        ...


@dataclass(frozen=True)
class TestedCar:
    """A car.

    Parameters
    ----------
    label : str
        In the report.
    path : Path
        FMU.
    aliases : Aliases
        Our names for its variables.
    start : mapping of str to float, int, bool or str
        Start values by our names.
    step : float, optional
        Communication step, s; by default that of the FMU.
    """

    __test__ = False  # no test of pytest's

    label: str
    path: Path
    aliases: Aliases = field(default_factory=Aliases)
    start: Mapping[str, Value] = field(default_factory=dict)
    step: float | None = None

    def drive(
        self,
        manoeuvre: Manoeuvre,
        pilot: Pilot | None = None,
        until: Callable[[float, Mapping[str, float]], bool] | None = None,
    ) -> Result:
        """Drive a new instance of the FMU.

        Parameters
        ----------
        manoeuvre : Manoeuvre
            Inputs over time, start values, stop time; by our names, in our units.
        pilot : Pilot, optional
            Overrules the inputs it acts on.
        until : callable, optional
            Of the time and the outputs; the run ends with the first step after which it is true.

        Returns
        -------
        Result
            Under our names. `failed_steps` is 1 where the FMU refused a step; the record ends before it.
        """
        raise NotImplementedError
