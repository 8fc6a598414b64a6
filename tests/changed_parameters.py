"""Each parameter of a System set to another value, in the kernel and in the FMU: the run must be that of a System which
is built with the value.

    found = changes(system, rebuilt, fmu=path, inputs={"steering": lambda t: 0.3 * sin(t)}, t_end=1.0)
    assert max(c.difference for c in found) < 1e-9
    assert not [c.name for c in found if c.effect == 0.0]

Runs are compared output by output: the largest difference over the larger of 1 and the largest value. What the solver
says about itself is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import mbs
from hosts.fmu import Fmu

Rows = dict[str, np.ndarray]
Inputs = Mapping[str, Callable[[float], float]]
SHARE = 0.2
"""Of the way to the farther end of its range that a parameter is moved."""


@dataclass(frozen=True)
class Change:
    """A parameter with another value.

    Attributes
    ----------
    name, value
        Of the parameter.
    difference : float
        Between the run of the kernel with the value and that of a System built with it.
    fmu : float or None
        Between the run of the FMU with the value and that of the kernel; None: there is no FMU.
    effect : float
        Between runs with this and with the old value: 0 says that the run does not show the parameter.
    """

    name: str
    value: float
    difference: float
    fmu: float | None
    effect: float


def other_value(entry: Mapping[str, float]) -> float:
    """A value beside that of the file, from an entry of `meta["parameters"]`."""
    value, low, high = entry["value"], entry["min"], entry["max"]
    end = high if high - value >= value - low else low
    return value + SHARE * (end - value)


def changes(
    system: mbs.System,
    rebuilt: Callable[[str, float], mbs.System],
    *,
    names: Sequence[str] | None = None,
    fmu: Path | None = None,
    values: Mapping[str, float] | None = None,
    inputs: Inputs | None = None,
    pose: mbs.Pose | None = None,
    t_end: float = 1.0,
    h: float = 0.005,
) -> list[Change]:
    """Change parameters, one at a time.

    Parameters
    ----------
    system : System
        The one that has the parameters.
    rebuilt : callable
        The System that is built with another value, given the name of a parameter and the value; its own parameter of
        that name is left alone, whether it has one or not.
    names : sequence of str, optional
        Of the parameters; by default all.
    fmu : Path, optional
        Of `system`, of FMI 2.0.
    values : mapping of str to float, optional
        For some parameters; those of the others are `other_value`.
    inputs : mapping of str to callable, optional
        Values over time, s; the others stay at their start.
    pose : Pose, optional
        Of a System that floats.
    t_end, h : float
        Of the runs, s.
    """
    plan = (dict(inputs or {}), pose, round(t_end / h), h)
    base = kernel_run(system, {}, *plan)
    found = []
    for entry in system.meta["parameters"]:
        name = entry["name"]
        if names is not None and name not in names:
            continue
        value = values[name] if values and name in values else other_value(entry)
        run = kernel_run(system, {name: value}, *plan)
        of_fmu = None if fmu is None else difference(fmu_run(fmu, {name: value}, *plan), run)
        other = kernel_run(rebuilt(name, value), {}, *plan)
        found.append(Change(name, value, difference(run, other), of_fmu, difference(run, base)))
    return found


def kernel_run(
    system: mbs.System,
    parameters: Mapping[str, float],
    inputs: Inputs,
    pose: mbs.Pose | None,
    steps: int,
    h: float,
) -> Rows:
    """Outputs after every step, the start first."""
    given = {name: at(0.0) for name, at in inputs.items()}
    simulation = mbs.Simulation(system, inputs=given, parameters=dict(parameters), pose=pose)
    rows = [list(simulation.sensors.values())]
    for k in range(steps):
        for name, at in inputs.items():
            simulation.set_input(name, at(k * h))
        simulation.step(h)
        rows.append(list(simulation.sensors.values()))
    return dict(zip(simulation.sensors, np.array(rows).T, strict=True))


def fmu_run(
    fmu: Path, parameters: Mapping[str, float], inputs: Inputs, pose: mbs.Pose | None, steps: int, h: float
) -> Rows:
    """The same of an FMU, through FMPy."""
    start = {name: at(0.0) for name, at in inputs.items()} | dict(parameters) | {"step_size": h}
    if pose is not None:
        start |= {f"initial.{name}": getattr(pose, name) for name in ("x", "y", "z", "yaw", "speed")}
    with Fmu(fmu) as instance:
        instance.initialise(start)
        outputs = [n for n in instance.names("output") if not n.startswith("solver.")]
        get, set_inputs = instance.getter(outputs), instance.setter(list(inputs))
        rows = [get()]
        for k in range(steps):
            set_inputs([at(k * h) for at in inputs.values()])
            instance.step(k * h, h)
            rows.append(get())
    return dict(zip(outputs, np.array(rows).T, strict=True))


def difference(one: Rows, other: Rows) -> float:
    """The largest over the outputs that both have, as a share of the larger of 1 and the output."""
    names = [n for n in one if n in other and not n.startswith("solver.")]
    assert names
    return max(float(np.abs(one[n] - other[n]).max()) / max(1.0, float(np.abs(other[n]).max())) for n in names)
