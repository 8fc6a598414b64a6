"""Cost of each step of an FMU in random driving: processor time of its thread, iterations, residual of capped steps."""

import gc
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.random_driver import RandomDriver, Target, random_start
from hosts.fmu.fmu import Fmu, StepRefusedError

RUN = 20.0  # s, after which the car starts again
ROLLED = 1.2  # roll angle from which a car is overturned, rad
OVERTURNED_TIME = 3.0  # s, after which an overturned car starts again
_READ = ("chassis.roll", "solver.iterations", "solver.halvings", "solver.capped_steps", "solver.capped_residual")


@dataclass
class Costs:
    """Cost of each step, shape (n,)."""

    us: NDArray[np.float64]
    """Processor time of the thread, microseconds."""
    iterations: NDArray[np.int64]
    """Iterations in the step."""
    halvings: NDArray[np.int64]
    """Halvings of the step."""
    capped: NDArray[np.int64]
    """Parts of the step whose iterations were limited."""
    residual: NDArray[np.float64]
    """Remaining residual of a capped step, m."""
    refused: list[str]


def drive(
    fmu: Path,
    start: Mapping[str, Value],
    seconds: float,
    targets: Sequence[Target],
    step: float,
    seed: int,
    progress: Callable[[float], None],
) -> Costs:
    """Drive an FMU with random inputs and measure each step.

    Parameters
    ----------
    start : mapping
        Start values; the driver adds the pose.
    targets : sequence of Target
        Targets of the driver.
    step : float
        Communication and inner step, s.
    progress : callable
        Called with the completed fraction of the drive.
    """
    with Fmu(fmu) as car:
        return _Drive(car, dict(start) | {"step_size": step}, step, seed, targets).go(round(seconds / step), progress)


class _Drive:
    def __init__(self, car: Fmu, start: dict[str, Value], step: float, seed: int, targets: Sequence[Target]) -> None:
        self.car, self.values, self.h, self.seed, self.targets = car, start, step, seed, targets
        self.inputs = car.names("input")
        self.driver = RandomDriver(seed, self.inputs, targets)
        self.read, self.set = car.getter((*OBSERVED, *_READ)), car.setter(self.inputs)
        self.held = dict(zip(self.inputs, car.start_values(self.inputs).tolist(), strict=True))
        self.starts = self.steps = 0
        self.overturned_time = 0.0
        self.outputs: list[float] = []

    def begin(self) -> None:
        """Start again; starts that the FMU refuses, as inside a ramp, are skipped."""
        for _ in range(50):
            self.starts += 1
            try:
                if self.starts > 1:
                    self.car.reset()
                chance = 1000 * self.seed + self.starts
                self.car.initialise(self.values | random_start(chance, self.targets))
                break
            except HostError:
                if self.starts >= 50:
                    raise
        self.steps, self.overturned_time, self.outputs = 0, 0.0, self.read()

    def go(self, n: int, progress: Callable[[float], None]) -> Costs:
        counts = [np.zeros(n, dtype=np.int64) for _ in range(3)]
        us, residual = np.zeros(n), np.zeros(n)
        refused: list[str] = []
        self.begin()
        collecting = gc.isenabled()
        gc.disable()
        try:
            for k in range(n):
                if k % 500 == 0:
                    progress(k / n)
                us[k], refusal = self.step(k)
                if refusal:
                    refused.append(refusal)
                else:
                    roll, iterations, halvings, capped, residual[k] = self.outputs[len(OBSERVED) :]
                    previous_counts = self.last
                    counts[0][k], counts[1][k], counts[2][k] = (
                        iterations,
                        halvings - previous_counts[0],
                        capped - previous_counts[1],
                    )
                    self.last = halvings, capped
                    self.overturned_time = self.overturned_time + self.h if abs(roll) > ROLLED else 0.0
                if refusal or self.overturned_time > OVERTURNED_TIME or self.steps * self.h >= RUN:
                    self.begin()
                    self.driver.restart(k * self.h)
        finally:
            if collecting:
                gc.enable()
        return Costs(us, *counts, residual, refused)

    last = (0.0, 0.0)  # halvings and capped steps since the start, before the present step

    def step(self, k: int) -> tuple[float, str]:
        """Make a step; its processor time, us, and the reason if it was refused."""
        if self.steps == 0:
            self.last = 0.0, 0.0
        self.held |= self.driver.act(k * self.h, dict(zip(OBSERVED, self.outputs, strict=False)))
        row = [self.held[name] for name in self.inputs]
        self.set(row)
        refusal = ""
        begin = time.thread_time_ns()
        try:
            self.car.step(self.steps * self.h, self.h)
        except StepRefusedError as error:
            refusal = str(error)
        spent = 1e-3 * (time.thread_time_ns() - begin)
        self.steps += 1
        if not refusal:
            self.outputs = self.read()
        return spent, refusal


def summary(costs: Costs, step: float) -> dict[str, object]:
    """Row of a drive. `step`: s."""
    us = costs.us
    return {
        "steps": len(us),
        "mean_us": float(us.mean()),
        "p99_9_us": float(np.percentile(us, 99.9)),
        "worst_us": float(us.max()),
        "quarter_us": 0.25e6 * step,
        "iterations": float(costs.iterations.mean()),
        "most_iterations": int(costs.iterations.max()),
        "halvings": int(costs.halvings.sum()),
        "capped": int(costs.capped.sum()),
        "residual_mm": 1e3 * float(costs.residual.max()),
        "refused": len(costs.refused),
    }
