"""What steps of limited iterations leave in a fall from 1 m at speed, and how it goes away."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.shared.command import pyplot
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu

FALL: Mapping[str, Value] = {"initial.z": 1.0, "initial.speed": 25.0, "road.kerb_x": 60.0, "road.kerb_height": 0.08}
"""Falls 1 m at 25 m/s, then drives over the kerb at full lock."""
TURN, DURATION = 1.5, 4.0  # s: from when the wheel is turned
_READ = (
    "solver.capped_residual",
    "chassis.x",
    "chassis.y",
    "chassis.z",
    "solver.energy_balance",
    "solver.capped_steps",
)


@dataclass(frozen=True)
class Fall:
    """A run."""

    limit: int
    time: NDArray[np.float64]
    residual: NDArray[np.float64]
    """`time`, `residual`: s and mm: what the step that ends there left, 0 if it converged."""
    place: NDArray[np.float64]
    """Shape (n, 3): of the chassis, m."""
    balance: float
    """`solver.energy_balance` at the end."""
    capped: int
    """Steps."""


def fall(fmu: Path, fidelity: int | None, step: float, limit: int) -> Fall:
    """One run.

    `fidelity`: none where the FMU has no choice; `step`: in s; `limit`: of the iterations of a step; 0: none.
    """
    rows = []
    with Fmu(fmu) as car:
        chosen: dict[str, Value] = {} if fidelity is None else {"fidelity": fidelity}
        car.initialise({**FALL, **chosen, "step_size": step, "solver.step_iterations": limit})
        turn, read = car.setter(["steering", "throttle"]), car.getter(_READ)
        turn([0.0, 0.5])
        for k in range(round(DURATION / step)):
            if k == round(TURN / step):
                turn([1.0, 1.0])
            car.step(k * step, step)
            rows.append(read())
    table = np.array(rows)
    time = step * np.arange(1, len(rows) + 1)
    return Fall(limit, time, 1e3 * table[:, 0], table[:, 1:4], float(table[-1, 4]), int(table[-1, 5]))


def chart(falls: Mapping[int, Sequence[Fall]]) -> Any:
    """Residuals and distances from the first run of each fidelity, which has no limit."""
    plt = pyplot()
    figure, panels = plt.subplots(2, len(falls), figsize=(10.0, 6.0), sharex=True, sharey="row", squeeze=False)
    for column, (fidelity, runs) in enumerate(falls.items()):
        for run in runs[1:]:
            left = np.where(run.residual > 0.0, run.residual, np.nan)
            panels[0][column].plot(run.time, left, ".", ms=3, label=f"limit {run.limit}: {run.capped} steps")
            apart = 1e3 * np.linalg.norm(run.place - runs[0].place, axis=1)
            panels[1][column].plot(run.time, np.where(apart > 0.0, apart, np.nan), lw=1, label=f"limit {run.limit}")
        panels[0][column].set(title=f"fidelity {fidelity}", yscale="log")
        panels[1][column].set(yscale="log", xlabel="time, s")
        for row in range(2):
            panels[row][column].grid(alpha=0.3)
            panels[row][column].legend(fontsize=8)
    panels[0][0].set_ylabel("left by a step, mm")
    panels[1][0].set_ylabel("chassis off, mm")
    figure.tight_layout()
    return figure
