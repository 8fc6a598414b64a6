"""The loop of a run: steps in chunks, with inputs, a record and a progress bar."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import progress_for
from mbs.kernel.binding import KernelError
from mbs.kernel.header.limits import MOST_PARTS
from mbs.results import accuracy
from mbs.results.comparison import instants
from mbs.results.omitted_sensors import OmittedSensors
from mbs.results.run_report import Report
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.arguments import (
    check_every,
    check_progress,
    check_record,
    check_step,
    check_values,
    count_steps,
)
from mbs.simulation.omitted_sensor_run import omitted_of_run
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.recorded_trajectory import recorded
from mbs.simulation.refusal import refusal
from mbs.simulation.stepped_system import SteppedSystem

Array = NDArray[np.float64]
CHUNK_SECONDS = 0.1  # wall time of one call into the kernel, so that progress moves and Ctrl-C is heard


def march(
    simulation: SteppedSystem,
    t_end: float,
    h: float,
    inputs: Mapping[str, Signal] | None,
    every: int,
    progress: bool | Callable[[float], None] | None,
    look: bool = False,
    wanted: int = 1,
    watch: Callable[[Array], bool] | None = None,
) -> tuple[Trajectory, list[Array]]:
    """The steps of `Simulation.run`; poses are kept of one of `wanted` samples at most. `watch` is given the samples so
    far after each eighth of them; where it says so the run ends there.

    Returns
    -------
    positions : list of ndarray, shape (nq,)
        With `look` the coordinates at the instants where two runs are compared.
    """
    t0, h = simulation.time, check_step(h)
    steps, every = count_steps(t0, t_end, h), check_every(every)
    check_progress(progress)
    meta, instance = prepared(simulation.system)[1], simulation.instance
    check_record(steps // every + 1, len(meta["sensors"]))
    simulation.step_tried = h
    checked_inputs = check_values(inputs, "The inputs")
    signals = InputSignals(checked_inputs, meta["inputs"])
    values = np.empty((steps // every + 1, len(meta["sensors"])))
    values[0] = list(instance.sensors())
    left_out = omitted_of_run(simulation, checked_inputs, h, every)
    compared = [int(k) for k in instants(len(values))] if look else []
    looks = [int(k) * every for k in instants(len(values))] if simulation.bending.watches else []
    if watch is not None:
        looks = sorted({*looks, *(len(values) * k // MOST_PARTS * every for k in range(1, MOST_PARTS))})
    positions = [simulation.state.q] if look else []
    record = PositionRecord(simulation.system, simulation.state.q, len(values), wanted)
    steps_done, wall, chunk, before = 0, 0.0, every, simulation.report
    with progress_for(progress) as bar, attached(simulation, signals, t0, t0 + steps * h, h):
        while steps_done < steps:
            ahead = [k - steps_done for k in looks if k > steps_done]
            n = min(chunk, steps - steps_done, *ahead[:1])
            row = steps_done // every + 1
            block = values[row : (steps_done + n) // every + 1]
            coordinates = record.rows(row, len(block))
            if look and coordinates is None:
                coordinates = np.empty((len(block), simulation.system.nq))
            begin = time.perf_counter()
            try:
                instance.run(h, n, None, every, block, coordinates)
            except KernelError as error:
                good = round((simulation.time - t0) / h) // every + 1
                wall += time.perf_counter() - begin
                record.take(row, coordinates)
                recorded = trajectory_of(simulation, t0, h * every, values[:good], wall, before, record, left_out)
                what = f"The step from t = {simulation.time:g} s with h = {h:g} s failed"
                raise refusal(simulation, what, error, recorded, step_given=True) from error
            spent = time.perf_counter() - begin
            wall += spent
            record.take(row, coordinates)
            steps_done += n
            positions += [
                coordinates[k - row].copy() for k in compared if coordinates is not None and row <= k < row + len(block)
            ]
            if ahead and n == ahead[0] and simulation.bending.watches:
                simulation.bending.look(simulation.time, simulation.state.q)
            bar.update(steps_done / steps)
            if watch is not None and ahead and n == ahead[0] and watch(values[: steps_done // every + 1]):
                values = values[: steps_done // every + 1]
                break
            chunk = next_chunk(chunk, spent, every)
    return trajectory_of(simulation, t0, h * every, values, wall, before, record, left_out), positions


@contextmanager
def attached(simulation: SteppedSystem, signals: InputSignals, t0: float, t_end: float, h: float) -> Iterator[None]:
    """Inputs of a run: the kernel asks for them at the times at which its method evaluates them."""
    signals.attach_to_steps(simulation.instance, t0, t_end, h)
    try:
        yield
    finally:
        simulation.instance.set_input_function(None)


def trajectory_of(
    simulation: SteppedSystem,
    t0: float,
    interval: float,
    values: Array,
    wall: float,
    before: Report,
    record: PositionRecord,
    left_out: Callable[[int], OmittedSensors | None],
) -> Trajectory:
    """What was recorded, with the counters since `before`; `left_out` makes of the number of samples what was not."""
    report, settings = simulation.report, simulation.settings
    t = t0 + interval * np.arange(len(values), dtype=float)
    energy = accuracy.energy_text(report, simulation.system, settings.method)
    estimate = accuracy.free_part(report, report.steps - before.steps, report.halvings - before.halvings)
    notices = report.capped_text, energy
    return recorded(simulation, t, values, settings, wall, record, left_out(len(values)), notices, accuracy=estimate)


def next_chunk(chunk: int, spent: float, every: int) -> int:
    """Steps of the next call, a multiple of `every`, for about CHUNK_SECONDS."""
    factor = min(8.0, CHUNK_SECONDS / max(spent, 1e-9))
    return max(1, int(chunk * factor / every)) * every
