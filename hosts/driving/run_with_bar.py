"""A run that a person waits for and looks at, in a process that the FMU may take down."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from ali3.bars import bar as bar_of
from ali3.isolated import Isolated, Lost
from ali3.processes import store
from hosts.common.errors import FailedFmuError
from hosts.driving.co_simulation import columns_of, run
from hosts.driving.derived_columns import derive_columns
from hosts.driving.ground_marks import marked
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.recorded_rows import kept_rows
from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.own_process import PATIENCE, files_of_drives

_Task: TypeAlias = tuple[Manoeuvre, float, Pilot | None, int]


@dataclass(frozen=True)
class _Drive:
    """A run as work for a process."""

    source: FmuSource

    def __call__(self, task: _Task, tell: Callable[[float], None]) -> Result:
        manoeuvre, step, driver, every = task
        with self.source.opened() as fmu:
            result = run(fmu, manoeuvre, step, driver, tell, every=every, last=True, kept=store())
        return replace(result, values=result.values[:0])  # the rows are in the store


def run_with_bar(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None = None, every: int = 1
) -> Result:
    """`run` with a progress bar on the terminal, and with marks on the ground; its last step always has a row.

    `fmu`: is not loaded here; where its process ends, the rows until then are the result. Raises `FailedFmuError`:
    there are none.
    """
    steps, what = max(1, round(manoeuvre.stop_time / step)), f"{fmu.path.stem}, {manoeuvre.name}"
    begin = clock.perf_counter()
    work, reads = _Drive(FmuSource.of(fmu)), files_of_drives(fmu.path, [manoeuvre.start])
    process: Isolated[_Task, Result] = Isolated(work, Result, reads=reads)
    names = [name for part in columns_of(fmu, with_names_of(manoeuvre, fmu.variables)) for name in part]
    with closing(process), bar_of(total=steps, desc=what, unit="step") as bar:
        done = process.do(
            (manoeuvre, step, driver, every),
            lambda done: bar.update(int(done) - bar.n),
            PATIENCE,
            lambda place: kept_rows(place, len(names)),
        )
        if isinstance(done, Lost):
            done = _rest(names, fmu, manoeuvre, step * every, done, clock.perf_counter() - begin)
        else:
            rows = process.stored(lambda place: kept_rows(place, len(names)))
            assert rows is not None
            done = replace(done, values=rows[: len(done.time)])
            bar.update(steps - bar.n if not done.failed_steps else 0)
    if process.left:
        done.messages.append(f"{process.left} processes that it had started were ended with it.")
    derive_columns(done, fmu, every > 1)
    return marked(done, driver)


def _rest(
    names: list[str], fmu: SimulatedFmu, manoeuvre: Manoeuvre, interval: float, lost: Lost, wall: float
) -> Result:
    """What is there of a run whose process has ended."""
    rows = lost.kept
    if not len(rows):
        raise FailedFmuError(f"The process of the FMU {lost.how}; no row was recorded.")
    return Result(
        names,
        {name: fmu.variables[name].unit or "1" for name in names},
        interval * np.arange(len(rows), dtype=np.float64),
        rows,
        wall,
        interval * max(0, len(rows) - 1),
        1,
        [],
        start=dict(manoeuvre.start),
        ended=f"The process of the FMU {lost.how}; {len(rows)} rows were kept.",
    )
