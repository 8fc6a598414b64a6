"""Run in equal steps, in chunks, with inputs, a record and a progress bar."""

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
from mbs.simulation.omitted_sensors import omitted_of_run
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.recorded_trajectory import recorded_trajectory
from mbs.simulation.refusal import refusal
from mbs.simulation.stepped_system import SteppedSystem

Array = NDArray[np.float64]
CHUNK_SECONDS = 0.1  # wall time of one call of the kernel, between which progress is shown and Ctrl-C takes effect


def march(
    simulation: SteppedSystem,
    t_end: float,
    h: float,
    inputs: Mapping[str, Signal] | None,
    every: int,
    progress: bool | Callable[[float], None] | None,
    records_coordinates: bool = False,
    samples_per_pose: int = 1,
    watch: Callable[[Array], bool] | None = None,
) -> tuple[Trajectory, list[Array]]:
    """Run `simulation` in steps of `h`, s, to `t_end`, s; `inputs`, `every` and `progress` as in `simulate`.

    Parameters
    ----------
    records_coordinates : bool
        Whether to return the coordinates at the instants at which two runs are compared.
    samples_per_pose : int
        Poses are kept for one of this many samples at most.
    watch : callable, optional
        Receives the samples so far after each eighth of the run but the last, and returns whether the run ends there.

    Returns
    -------
    trajectory : Trajectory
    positions : list of ndarray, shape (nq,)
        Empty without `records_coordinates`.

    Raises
    ------
    SimulationError
        A step fails; its `trajectory` holds the samples until then.
    """
    t0, h = simulation.time, check_step(h)
    steps, every = count_steps(t0, t_end, h), check_every(every)
    check_progress(progress)
    meta, instance = prepared(simulation.system).meta, simulation.instance
    check_record(steps // every + 1, len(meta["sensors"]))
    simulation.step_tried = h
    checked_inputs = check_values(inputs, "The inputs")
    signals = InputSignals(checked_inputs, meta["inputs"])
    values = np.empty((steps // every + 1, len(meta["sensors"])))
    values[0] = list(instance.sensors())
    omitted = omitted_of_run(simulation, checked_inputs, h, every)
    compared = [int(k) for k in instants(len(values))] if records_coordinates else []
    has_flexible_bodies = simulation.bending.has_flexible_bodies
    observed_steps = {int(k) * every for k in instants(len(values))} if has_flexible_bodies else set()
    watched_steps = set()
    if watch is not None:
        watched_steps = {len(values) * k // MOST_PARTS * every for k in range(1, MOST_PARTS)}
    pauses = sorted(observed_steps | watched_steps)
    positions = [simulation.state.q] if records_coordinates else []
    record = PositionRecord(simulation.system, simulation.state.q, len(values), samples_per_pose)
    steps_done, kernel_time, chunk, report_before = 0, 0.0, every, simulation.report
    with progress_for(progress) as bar, attach_inputs(simulation, signals, t0, t0 + steps * h, h):
        while steps_done < steps:
            next_pauses = [k - steps_done for k in pauses if k > steps_done]
            n = min(chunk, steps - steps_done, *next_pauses[:1])
            row = steps_done // every + 1
            block = values[row : (steps_done + n) // every + 1]
            coordinates = record.rows(row, len(block))
            if records_coordinates and coordinates is None:
                coordinates = np.empty((len(block), simulation.system.nq))
            clock_start = time.perf_counter()
            try:
                instance.run(h, n, every=every, out=block, positions=coordinates)
            except KernelError as error:
                samples = round((simulation.time - t0) / h) // every + 1
                kernel_time += time.perf_counter() - clock_start
                record.store(row, coordinates)
                trajectory = trajectory_of(
                    simulation, t0, h * every, values[:samples], kernel_time, report_before, record, omitted
                )
                subject = f"The step from t = {simulation.time:g} s with h = {h:g} s failed"
                raise refusal(simulation, subject, error, trajectory, step_given=True) from error
            call_time = time.perf_counter() - clock_start
            kernel_time += call_time
            record.store(row, coordinates)
            steps_done += n
            positions += [
                coordinates[k - row].copy() for k in compared if coordinates is not None and row <= k < row + len(block)
            ]
            if steps_done in observed_steps:
                simulation.bending.observe(simulation.time, simulation.state.q)
            bar.update(steps_done / steps)
            if watch is not None and steps_done in watched_steps and watch(values[: steps_done // every + 1]):
                values = values[: steps_done // every + 1]
                break
            chunk = next_chunk(chunk, call_time, every)
    return trajectory_of(simulation, t0, h * every, values, kernel_time, report_before, record, omitted), positions


@contextmanager
def attach_inputs(
    simulation: SteppedSystem, signals: InputSignals, t0: float, t_end: float, h: float
) -> Iterator[None]:
    """Attach the inputs of a run to the kernel, which evaluates them at the stages of its method."""
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
    kernel_time: float,
    report_before: Report,
    record: PositionRecord,
    omitted: Callable[[int], OmittedSensors | None],
) -> Trajectory:
    """Trajectory of the samples `values` (n, ns), with the counters since `report_before`.

    `interval`: time between samples, s; `kernel_time`: wall time of the calls of the kernel, s; `omitted`: returns the
    omitted sensors for a number of samples.
    """
    report, settings = simulation.report, simulation.settings
    t = t0 + interval * np.arange(len(values), dtype=float)
    energy = accuracy.energy_text(report, simulation.system, settings.method)
    estimate = accuracy.accuracy_from_energy(
        report, report.steps - report_before.steps, report.halvings - report_before.halvings
    )
    notices = report.capped_text, energy
    return recorded_trajectory(
        simulation, t, values, settings, kernel_time, record, omitted(len(values)), notices, accuracy=estimate
    )


def next_chunk(chunk: int, call_time: float, every: int) -> int:
    """Steps of the next call, a multiple of `every`, for about CHUNK_SECONDS."""
    factor = min(8.0, CHUNK_SECONDS / max(call_time, 1e-9))
    return max(1, int(chunk * factor / every)) * every
