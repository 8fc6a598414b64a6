"""Measurement of the time of steps in the kernel, without their preparation."""

from collections.abc import Callable, Mapping

import numpy as np

from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.state import Pose
from mbs.simulation.stepping import Simulation
from mbs.system.system import System


def step_time(
    system: System,
    duration: float,
    h: float,
    repeats: int,
    clock: Callable[[], float],
    inputs: Mapping[str, Signal] | None = None,
    parameters: Mapping[str, float] | None = None,
    pose: Pose | None = None,
    warm_up: int = 1,
) -> float:
    """Least time among repeats of all steps of a run, s, without the start and the table of inputs.

    Parameters
    ----------
    duration, h : float
        Duration of the run and step, s.
    repeats : int
        Number of timed runs.
    clock : callable
        Clock in s: `time.perf_counter` for wall time, `time.process_time` for processor time.
    inputs, parameters, pose
        As `mbs.simulate` takes them; the inputs have their first values before the start is made consistent.
    warm_up : int
        Number of runs before the timed ones.
    """
    steps = round(duration / h)
    declared = system.meta["inputs"]
    signals = InputSignals(inputs or {}, declared)
    columns = signals.columns()
    start = signals.start_values(0.0, h)
    table = None
    if columns:
        table = np.tile([float(entry["start"]) for entry in declared], (steps, 1))
        table[:, columns] = signals.at(h * np.arange(1.0, steps + 1.0), 1e-6 * h)
    values = np.empty((1, len(system.meta["sensors"])))

    def time_run() -> float:
        simulation = Simulation(system, inputs=start, parameters=parameters, pose=pose)
        begin = clock()
        simulation.instance.run(h, steps, table, steps, values)
        return clock() - begin

    return min([time_run() for _ in range(warm_up + repeats)][warm_up:])
