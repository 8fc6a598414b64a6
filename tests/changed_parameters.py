"""Each parameter of a System set to another value, in the kernel and in the FMU: the run must be that of a System which
is built with the value.

    found = changes(system, rebuilt, fmu=path, inputs={"steering": lambda t: 0.3 * sin(t)}, t_end=1.0)
    assert max(c.difference for c in found) < SAME
    assert not [c.name for c in found if c.effect == 0.0]

Runs are compared output by output: the largest difference over the larger of 1 and the largest value. What the solver
says about itself is left out.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import mbs
from hosts.fmu.fmu import Fmu

Rows = dict[str, np.ndarray]
Inputs = Mapping[str, Callable[[float], float]]
SAME = 1e-9
"""Difference of two runs of the same model."""
TOGETHER = 8
"""Parameters that are changed in one run; where it differs each by itself."""
SHARE = 0.2
"""Of the way to the farther end of its range that a parameter is moved."""


@dataclass(frozen=True)
class Change:
    """A parameter with another value."""

    name: str
    value: float
    """`name`, `value`: of the parameter."""
    difference: float
    """Between the run of the kernel with the value, and others changed with it, and that of a System built so."""
    fmu: float | None
    """Between that run of the FMU and that of the kernel; None: there is no FMU."""
    effect: float
    """Between runs with this and with the old value: 0 says that the run does not show the parameter."""


def other_value(entry: Mapping[str, float]) -> float:
    """A value beside that of the file, from an entry of `meta["parameters"]`."""
    value, low, high = entry["value"], entry["min"], entry["max"]
    end = high if high - value >= value - low else low
    return value + SHARE * (end - value)


def changes(
    system: mbs.System,
    rebuilt: Callable[[Mapping[str, float]], mbs.System],
    *,
    names: Sequence[str] | None = None,
    fmu: Path | None = None,
    values: Mapping[str, float] | None = None,
    inputs: Inputs | None = None,
    pose: mbs.Pose | None = None,
    t_end: float = 1.0,
    h: float = 0.005,
    same: float = SAME,
) -> list[Change]:
    """Change parameters: a few at a time, and those of a run that differs again, until one is left.

    Parameters
    ----------
    system : System
        The one that has the parameters.
    rebuilt : callable
        The System that is built with other values, given by the names of parameters; its own parameters of those names
        are left alone, whether it has them or not.
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
    same : float
        Difference from a rebuilt System up to which a group is not divided.
    """
    plan = (dict(inputs or {}), pose, round(t_end / h), h)
    base = kernel_run(system, {}, *plan)
    chosen = {p["name"]: other_value(p) for p in system.meta["parameters"]} | dict(values or {})
    compared = [name for name in chosen if names is None or name in names]
    differences: dict[str, tuple[float, float | None]] = {}

    def compare(group: Sequence[str]) -> bool:
        """Whether all runs with the values of a group are the same."""
        values = {name: chosen[name] for name in group}
        run = kernel_run(system, values, *plan)
        of_rebuilt = difference(run, kernel_run(rebuilt(values), {}, *plan))
        of_fmu = None if fmu is None else difference(fmu_run(fmu, values, *plan), run)
        well = of_rebuilt <= same and not of_fmu
        if well or len(group) == 1 or all([compare(group[::2]), compare(group[1::2])]):
            differences.update(dict.fromkeys(group, (of_rebuilt, of_fmu)))
        return well

    for k in range(groups := -(-len(compared) // TOGETHER)):
        compare(compared[k::groups])
    effects = {name: difference(kernel_run(system, {name: chosen[name]}, *plan), base) for name in compared}
    return [Change(name, chosen[name], *differences[name], effects[name]) for name in compared]


def kernel_run(
    system: mbs.System,
    parameters: Mapping[str, float],
    inputs: Inputs,
    pose: mbs.Pose | None,
    steps: int,
    h: float,
) -> Rows:
    """Outputs after every step, the start first."""
    start_inputs = {name: at(0.0) for name, at in inputs.items()}
    simulation = mbs.Simulation(system, inputs=start_inputs, parameters=dict(parameters), pose=pose)
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
