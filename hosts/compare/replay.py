"""Replays a log as inputs of an FMU, as often as parameters are tried."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.compare.follower import demanded
from hosts.compare.log import Signal
from hosts.compare.stretches import Stretch, joined
from hosts.driving.co_simulation import Result, run
from hosts.driving.derived_columns import derive_columns
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.fmu.aliased_fmu import AliasedFmu
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import Fmu


def inputs_of(
    name: str,
    inputs: Mapping[str, Signal],
    start: Mapping[str, Value],
    end: float,
    step: float,
    held: bool = False,
    whole: Collection[str] = (),
    followed: Mapping[str, float] | None = None,
) -> Manoeuvre:
    """The manoeuvre that gives an FMU the measured inputs, with a row a step.

    Parameters
    ----------
    start : mapping of str to float, int, bool or str
        Start values.
    end : float
        s.
    step : float
        Communication step, s.
    held : bool
        Whether the FMU holds its inputs during a step. Each then has the measured value of the middle of the step, so
        that on the whole nothing is late; else that of the beginning.
    whole : collection of str
        Inputs that are whole numbers, which keep the value of a sample up to the next.
    followed : mapping of str to float, optional
        Inputs that the car follows, by the frequency of its follower in Hz: the measured signal is what follows.
    """
    steps = max(1, round(end / step))
    time: NDArray[np.float64] = step * np.arange(steps + 1, dtype=np.float64)
    at = time + 0.5 * step if held else time
    columns = {
        n: _kept(s, time) if n in whole else np.interp(at, s.time, s.values).astype(np.float64)
        for n, s in inputs.items()
    }
    for n, frequency in (followed or {}).items():
        columns[n] = demanded(inputs[n], frequency, at)
    return Manoeuvre(name, time, columns, steps * step, dict(start))


def _kept(signal: Signal, time: NDArray[np.float64]) -> NDArray[np.float64]:
    rows = np.searchsorted(signal.time, time + 1e-9, side="right") - 1
    return np.asarray(np.round(signal.values[np.maximum(rows, 0)]))


_GAINS = 0.8, 0.5, 0.1  # pedal per m/s, per m and per m/s2: the speed is to be as measured, not comfortable


def _holder(speed: Signal, pedal: float) -> SpeedHolder:
    return SpeedHolder(lambda t: float(np.interp(t, speed.time, speed.values)), *_GAINS, pedal=pedal)


class Replay:
    """An FMU that is driven again and again through the same inputs.

    Parameters
    ----------
    path : Path
        FMU.
    aliases : Aliases
        Our names for its variables.
    step : float
        Communication step, s.
    stretches : sequence of Stretch
        That are driven one after the other, each from its start.

    Attributes
    ----------
    runs : int
        That were made.
    said : dict of str to int
        What the FMU logged at warning or above, and in how many runs.
    """

    def __init__(
        self,
        path: Path,
        aliases: Aliases,
        stretches: Sequence[Stretch],
        step: float,
    ) -> None:
        self._path, self._aliases = path, aliases
        self.stretches, self.step = list(stretches), step
        self.said: dict[str, int] = {}
        self._fmu: Fmu | None = None
        self._can_reset: bool | None = None
        self._driven = False
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
        """Drive all stretches with other start values than those of their manoeuvres.

        Parameters
        ----------
        values : mapping of str to float, int, bool or str, optional
            By our names.

        Returns
        -------
        Result
            Under our names; several stretches as `joined` puts them.
        """
        results = [self.drive(stretch, values) for stretch in self.stretches]
        self.runs += 1
        for message in dict.fromkeys(m for result in results for m in result.messages):
            self.said[message] = self.said.get(message, 0) + 1
        return results[0] if len(results) == 1 else joined(results, self.stretches)

    def drive(self, stretch: Stretch, values: Mapping[str, Value] | None = None) -> Result:
        """Drive one stretch.

        Parameters
        ----------
        values : mapping of str to float, int, bool or str, optional
            Start values by our names.
        """
        if self._fmu is not None and self._can_reset is False:
            self._close()
        if self._fmu is None:
            self._fmu = Fmu(self._path)
        elif self._driven:
            self._fmu.reset()
        self._driven = True
        manoeuvre = stretch.manoeuvre
        if values:
            manoeuvre = replace(manoeuvre, start={**manoeuvre.start, **values})
        fmu = AliasedFmu(self._fmu, self._aliases)
        # A pilot has a memory: each run has its own.
        driver = None if stretch.speed is None else _holder(stretch.speed, stretch.pedal)
        self._fmu.messages.clear()
        result = run(fmu, manoeuvre, self.step, driver)
        derive_columns(result, self._aliases)
        return result

    def check_reset(self) -> bool:
        """Drive twice; an FMU whose second drive after a reset is another is loaded again for each drive from now on.

        Returns
        -------
        bool
            Whether it repeats itself to the last bit, after a reset or loaded again.
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
