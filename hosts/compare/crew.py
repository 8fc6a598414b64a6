"""Processes that share the stretches of a replay, each with the FMU loaded once."""

from __future__ import annotations

import multiprocessing
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from hosts.common.numbers import Value
from hosts.compare.loaded_fmu import LoadedFmu
from hosts.compare.stretches import Stretch
from hosts.driving.result import Result
from hosts.fmu.aliases.alias import Aliases

_own: list[tuple[LoadedFmu, list[Stretch]]] = []  # of a process of the crew


class Crew:
    """Processes that drive stretches.

    Parameters
    ----------
    path : Path
        FMU.
    step : float
        Communication step, s.
    jobs : int
        Processes.
    """

    def __init__(self, path: Path, aliases: Aliases, stretches: Sequence[Stretch], step: float, jobs: int) -> None:
        self._count = len(stretches)
        self._pool = ProcessPoolExecutor(
            min(jobs, self._count),
            multiprocessing.get_context("spawn"),
            initializer=_begin,
            initargs=(path, aliases, list(stretches), step),
        )

    def drive(self, values: Mapping[str, Value] | None, can_reset: bool | None) -> list[Result]:
        """Drive all stretches; results in their order."""
        return list(self._pool.map(partial(_drive, values=dict(values or {}), can_reset=can_reset), range(self._count)))

    def close(self) -> None:
        """End the processes."""
        self._pool.shutdown(cancel_futures=True)


def _begin(path: Path, aliases: Aliases, stretches: list[Stretch], step: float) -> None:
    _own.append((LoadedFmu(path, aliases, step), stretches))


def _drive(number: int, values: Mapping[str, Value], can_reset: bool | None) -> Result:
    fmu, stretches = _own[0]
    fmu.can_reset = can_reset
    return fmu.drive(stretches[number], values)
