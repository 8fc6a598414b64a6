"""Reference results of an FMU: its default experiment, and the same with each input in turn."""

import contextlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from fmu_src.variables.variables import Variable
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.simulation.refusal import refusal

_ROWS = 100  # about as many in a run
_PART = 0.2  # of the way of an input to the end of its range
Column = NDArray[np.float64]


@dataclass(frozen=True)
class ReferenceRun:
    """An experiment."""

    t: Column
    """Shape (n,): times, s."""
    columns: dict[str, Column]
    """Each of shape (n,): outputs by name."""
    corners: Column = field(default_factory=lambda: np.zeros(0))
    """Shape (m,): times between which inputs go straight, s; empty: no input is touched."""
    inputs: dict[str, Column] = field(default_factory=dict)
    """Each of shape (m,): their values there."""


def reference_runs(system: mbs.System, follower: mbs.System | None = None) -> tuple[ReferenceRun, ...]:
    """The default experiment without inputs and, if it runs, with each input in turn; about a hundred rows each.

    An input goes a fifth of the way to the end of its range and back, and is held over each step.

    `follower`: System that computes what one with ports leaves out (`mbs.compiler.ports`). Raises `SimulationError` if
    the default experiment does not run; the sentence names what of the scene sets it.
    """
    experiment = system.meta["experiment"]
    step = float(experiment["step_s"])
    steps = max(1, round(float(experiment["stop_time_s"]) / step))
    try:
        runs = [_run(system, follower, steps, step, np.zeros(0), {})]
    except mbs.SimulationError as error:
        raise mbs.SimulationError(
            f"The default experiment, {steps * step:g} s in steps of {step:g} s as `m.stop_time` and `m.step` of the "
            f"scene say, does not run: {error}",
            error.time,
            error.status,
            error.trajectory,
        ) from None
    corners, inputs = _in_turn(system.meta["inputs"], steps * step)
    if inputs:
        untrusted = (mbs.SimulationError, mbs.AccuracyWarning)  # then it is not a reference
        with warnings.catch_warnings(), contextlib.suppress(*untrusted):
            warnings.simplefilter("error", mbs.AccuracyWarning)
            runs.append(_run(system, follower, steps, step, corners, inputs))
    return tuple(runs)


def _in_turn(entries: Sequence[Mapping[str, Any]], stop: float) -> tuple[Column, dict[str, Column]]:
    """Corners and values: real inputs with a range move one after the other, in the order of the table."""
    moving = []
    for entry in entries:
        start, limits = float(entry["start"]), [entry["max"], entry["min"]]  # None: open
        limits = [start + entry["tried"]] if "tried" in entry else limits
        end_value = next((float(end) for end in limits if end is not None and abs(end) < 1e300 and end != start), None)
        if end_value is not None and not entry.get("whole"):
            moving.append((str(entry["name"]), start, start + _PART * (end_value - start)))
    corners = np.linspace(0.0, stop, 2 * len(moving) + 1)
    inputs = {name: np.full(len(corners), start) for name, start, _ in moving}
    for k, (name, _, peak) in enumerate(moving):
        inputs[name][2 * k + 1] = peak
    return corners, inputs


def _run(
    system: mbs.System,
    follower: mbs.System | None,
    steps: int,
    step: float,
    corners: Column,
    inputs: Mapping[str, Column],
) -> ReferenceRun:
    simulation = mbs.Simulation(system)
    instance = simulation.instance
    follower_instance = None if follower is None else Instance(LoadedSystem(follower.kernel_bytes()))
    sensors = system.meta["sensors"]
    left_out = np.array([not entry.get("computed", True) for entry in sensors])
    names, step_times = [e["name"] for e in system.meta["inputs"]], np.arange(steps) * step
    step_values = {names.index(name): np.interp(step_times, corners, values) for name, values in inputs.items()}
    times, rows, row_interval = [], [], max(1, steps // _ROWS)
    for k in range(steps + 1):
        if k % row_interval == 0:
            simulation.step(step, 0)  # makes none; warns if the energy balance of the earlier ones is wrong
            row = np.array(instance.sensors())
            if follower_instance is not None:
                follower_instance.follow(instance)
                row = np.where(left_out, np.array(follower_instance.sensors()), row)
            times.append(simulation.time)
            rows.append(row)
        if k < steps:
            for index, values in step_values.items():
                instance.set_input(index, values[k])
            try:
                instance.step(step)
            except KernelError as error:
                failure = f"The step from t = {simulation.time:g} s with h = {step:g} s failed"
                raise refusal(simulation, failure, error) from None
    columns = {entry["name"]: column for entry, column in zip(sensors, np.array(rows).T, strict=True)}
    return ReferenceRun(np.array(times), columns, corners, dict(inputs))


def with_other_names(run: ReferenceRun, named: Mapping[str, Variable]) -> ReferenceRun:
    """The run with the names and units of the FMU. `named`: its variables by their names in the System."""

    def renamed(columns: Mapping[str, Column]) -> dict[str, Column]:
        return {named[key].name: column * named[key].scale for key, column in columns.items()}

    return replace(run, columns=renamed(run.columns), inputs=renamed(run.inputs))
