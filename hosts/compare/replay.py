"""Replays a log as inputs of an FMU, as often as parameters are tried."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from hosts.aliased_fmu import AliasedFmu
from hosts.aliases import Aliases
from hosts.co_simulation import Result, run
from hosts.compare.log import Signal
from hosts.fmu import Fmu
from hosts.manoeuvre import Manoeuvre
from hosts.numbers import Value


def inputs_of(
    name: str, inputs: Mapping[str, Signal], start: Mapping[str, Value], end: float, step: float
) -> Manoeuvre:
    """The manoeuvre that gives an FMU the measured inputs.

    Parameters
    ----------
    name : str
    inputs : mapping of str to Signal
    start : mapping of str to float, int, bool or str
        Start values.
    end : float
        s.
    step : float
        Communication step, s.

    Notes
    -----
    An FMU holds its inputs during a step: each has the measured value of the middle of the step, by linear
    interpolation, so that on the whole nothing is late. The table has a row a step.
    """
    steps = max(1, round(end / step))
    time: NDArray[np.float64] = step * np.arange(steps, dtype=np.float64)
    middle = time + 0.5 * step
    columns = {n: np.interp(middle, s.time, s.values) for n, s in inputs.items()}
    return Manoeuvre(name, time, columns, steps * step, dict(start))


class Replay:
    """An FMU that is driven again and again through the same inputs.

    Parameters
    ----------
    path : Path
        FMU.
    aliases : Aliases
        Our names for its variables.
    manoeuvre : Manoeuvre
    step : float
        Communication step, s.

    Attributes
    ----------
    runs : int
        That were made.
    """

    def __init__(self, path: Path, aliases: Aliases, manoeuvre: Manoeuvre, step: float) -> None:
        self._path, self._aliases = path, aliases
        self.manoeuvre, self.step = manoeuvre, step
        self._fmu: Fmu | None = None
        self._can_reset: bool | None = None
        self._first: tuple[Mapping[str, Value], NDArray[np.float64]] | None = None
        self.runs = 0

    def __enter__(self) -> Replay:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._close()

    def _close(self) -> None:
        if self._fmu is not None:
            self._fmu.__exit__(None, None, None)
            self._fmu = None

    def run(self, values: Mapping[str, Value] | None = None) -> Result:
        """Drive with other start values than those of the manoeuvre.

        Parameters
        ----------
        values : mapping of str to float, int, bool or str, optional
            By our names.

        Returns
        -------
        Result
            Under our names.
        """
        if self._fmu is not None and self._can_reset is False:
            self._close()
        if self._fmu is None:
            self._fmu = Fmu(self._path)
        elif self.runs:
            self._fmu.reset()
        manoeuvre = self.manoeuvre
        if values:
            manoeuvre = Manoeuvre(
                manoeuvre.name, manoeuvre.time, manoeuvre.inputs, manoeuvre.stop_time, {**manoeuvre.start, **values}
            )
        self.runs += 1
        return run(AliasedFmu(self._fmu, self._aliases), manoeuvre, self.step)

    def check_reset(self) -> bool:
        """Drive twice; an FMU whose second drive after a reset is another is loaded anew for each drive from now on.

        Returns
        -------
        bool
            Whether it repeats itself to the last bit, after a reset or loaded anew.
        """
        first = self.run().values
        if self._same(first, self.run().values):
            self._can_reset = True
            return True
        self._can_reset = False
        first = self.run().values
        return self._same(first, self.run().values)

    @staticmethod
    def _same(a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
        return a.shape == b.shape and bool(np.array_equal(a, b, equal_nan=True))
