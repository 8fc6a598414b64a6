"""Choice of a fixed step: it is halved until two runs show that the error is within the tolerance."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import Progress
from mbs.results.comparison import INSTANTS
from mbs.results.simulation_error import SimulationError
from mbs.settings.input_signals import Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.march import march
from mbs.simulation.prepared_system import distance
from mbs.simulation.stepped_system import SteppedSystem

Array = NDArray[np.float64]
MAX_STEPS = 3_000_000  # largest number of steps of a run


@dataclass(frozen=True)
class StepChoice:
    """Step, s, estimated error of its run relative to the length, its measured order, and the number of runs made."""

    h: float
    error: float
    order: float
    runs: int


def choose_step(
    start: Callable[[], SteppedSystem],
    t_end: float,
    tolerance: float,
    inputs: Mapping[str, Signal],
    bar: Progress,
) -> StepChoice:
    """Choose the largest of the steps duration / (50 2^k) with an error of the run within the tolerance.

    The error is the difference from the run with twice the step over 2^p - 1. The order p is measured with the run
    before, and is at most the order of the method.
    """
    simulation = start()
    system, method = simulation.system, simulation.settings.method
    h = (t_end - simulation.time) / INSTANTS
    runs: list[Array | None] = []
    differences: list[float] = []
    last_estimate: tuple[float, float] | None = None
    while True:
        positions = _positions(start, t_end, h, inputs)
        previous = runs[-1] if runs else None
        runs.append(positions)
        if positions is None or previous is None:
            differences.clear()
        else:
            differences.append(distance(system, positions, previous))
        if len(differences) >= 2:
            order = _measured_order(differences, METHOD_TABLE[method].order_of_changing_steps)
            error = differences[-1] / (2.0**order - 1.0)
            last_estimate = error, order
            if error <= tolerance:
                return StepChoice(h, error, order, len(runs))
        if (t_end - simulation.time) / h > MAX_STEPS / 2:
            break
        h *= 0.5
        bar.update(min(0.5, 0.05 * len(runs)))
    if last_estimate is None:
        _positions(start, t_end, h, inputs, raises=True)
        last_estimate = math.inf, 0.0
    return StepChoice(h, *last_estimate, len(runs))


def _measured_order(differences: list[float], method_order: int) -> float:
    if differences[-1] <= 0.0:
        return float(method_order)
    ratio = differences[-2] / differences[-1]
    return min(float(method_order), max(0.1, math.log2(ratio))) if ratio > 0.0 else 0.1


def _positions(
    start: Callable[[], SteppedSystem],
    t_end: float,
    h: float,
    inputs: Mapping[str, Signal],
    raises: bool = False,
) -> Array | None:
    """Coordinates (50, nq) at equal intervals of a run in steps of `h`, s; None if a step fails and not `raises`."""
    simulation = start()
    t0 = simulation.time
    positions = []
    for k in range(1, INSTANTS + 1):
        try:
            march(simulation, t0 + (t_end - t0) * k / INSTANTS, h, inputs, 1, False)
        except SimulationError:
            if raises:
                raise
            return None
        positions.append(simulation.state.q)
    return np.array(positions)
