"""Dependencies of initial outputs on variables, and sizes of outputs, measured by trial runs when an FMU is built.

An output depends on a variable if changing this variable alone, from random values, changes a bit of the output in the
initial state. Parameters are changed in groups (`parameter_groups`); an output that changes depends on all of the
group. Positions and velocities show their dependencies at any values. Forces have regimes, such as a kerb on which no
wheel stands: an output with forces is declared to depend on all parameters and on the pose of the start. After the
initialisation no input changes an output before the next step, as the slave passes values to the kernel when a step
begins (`step.c`).
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass

import mbs
from fmu_src.description.parameter_groups import parameter_groups
from fmu_src.variables.variables import Variable
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ElementType, SensorType
from mbs.kernel.header.sensor_reads import SENSOR_READS, SensorReads

_SEED = 20_261_120
_INITIAL_TRIALS = 6
_STEP_TRIALS = 9
_STEPS = 40
_POSE_RANGES = {
    "initial.x": 20.0,
    "initial.y": 20.0,
    "initial.z": 0.2,
    "initial.yaw": 1.0,
    "initial.speed": 20.0,
    "initial.lateral_speed": 1.0,
    "initial.yaw_rate": 0.5,
}
_OPEN_RANGE = 10.0
# Shares of the ranges, used in turn: a start may fail with values from the whole range.
_SHARES = (1.0, 0.1, 0.01)
# Types of sensors, see docs/system_file.md.
_WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.DIRECTION)
_SECOND_ORDER = 2  # of rates, which need accelerations
_ON_ROAD = (ElementType.TYRE, ElementType.MAGIC_TYRE, ElementType.CONTACT_POINTS)
_FEEDTHROUGH, _MOTION, _FORCE = "feedthrough", "motion", "force"


@dataclass(frozen=True)
class Dependencies:
    """Dependencies and sizes of outputs; outputs and variables are given by their indices in the table."""

    initial: dict[int, tuple[int, ...] | None]
    """Inputs and parameters on which an initial output depends, ascending; None: all, as after a settled start."""
    size: dict[int, float]
    """Largest absolute value of an output in all trials."""


def probe(systems: Sequence[mbs.System], table: Sequence[Variable]) -> Dependencies:
    """Measure dependencies and sizes over a System or all its fidelities; the result is the same at every call."""
    outputs = [i for i, v in enumerate(table) if v.causality == "output"]
    trials = _Trials(table, outputs)
    for system in systems:
        trials.system(system, Instance(LoadedSystem(system.kernel_bytes())))
    trials.close(systems)
    return Dependencies(
        {i: None if i in trials.settling else tuple(sorted(trials.initial[i])) for i in outputs},
        trials.size,
    )


class _Trials:
    """Trial starts and steps of Systems with random values, and the dependencies and sizes that they have shown."""

    def __init__(self, table: Sequence[Variable], outputs: Sequence[int]) -> None:
        self.table = table
        self.outputs = outputs
        self.sensed = [i for i in outputs if table[i].source == "sensor"]
        self.changed_over_step: dict[int, set[int]] = {i: set() for i in outputs}  # inputs that change it over a step
        self.initial: dict[int, set[int]] = {i: set() for i in outputs}
        self.settling: set[int] = set()
        self.size = dict.fromkeys(outputs, 0.0)
        self.starts_of_fidelities: list[list[list[float] | None]] = []
        self.share = 1.0
        self.inputs = [i for i, v in enumerate(table) if v.source == "input"]
        self.parameters = [i for i, v in enumerate(table) if v.source == "parameter"]
        self.settable = [i for i, v in enumerate(table) if v.source in ("input", "parameter", "pose")]

    def system(self, system: mbs.System, kernel: Instance) -> None:
        """Try one System: starts with single changes, then steps with changed inputs."""
        rng = random.Random(_SEED)
        groups = self._groups(system, kernel)
        compared = dict.fromkeys(map(tuple, groups), False)
        starts = [self._start(kernel, {})]
        for k in range(_INITIAL_TRIALS):
            self.share = _SHARES[k % len(_SHARES)]
            values = {i: self._random(i, rng) for i in self.settable}
            starts.append(self._start(kernel, values))
            changes = [{i: self._random(i, rng) for i in group} for group in groups]
            if starts[-1] is None:  # there is nothing to compare with
                continue
            for group, change in zip(groups, changes, strict=True):
                changed_start = self._start(kernel, values | change)
                compared[tuple(group)] |= changed_start is not None
                for i in group:
                    self._compare(self.initial, i, starts[-1], changed_start)
        unknown = {i for group, was_compared in compared.items() if not was_compared for i in group}
        for i in self.outputs:  # no start has shown whether they depend on these
            self.initial[i] |= unknown
        self.starts_of_fidelities.append(starts)
        fidelity = next((i for i, v in enumerate(self.table) if v.source == "fidelity"), None)
        if fidelity is not None:
            for first_start, other_start in zip(self.starts_of_fidelities[0], starts, strict=True):
                self._compare(self.initial, fidelity, first_start, other_start)
        h = float(system.meta["experiment"]["step_s"])
        for k in range(_STEP_TRIALS):
            self.share = _SHARES[k % len(_SHARES)]
            self._steps(kernel, h, rng)

    def _groups(self, system: mbs.System, kernel: Instance) -> list[list[int]]:
        """Variables changed together at a start: an input, a component of the pose, or a group of parameters."""
        rng = random.Random(_SEED)
        self.share = 1.0
        groups = parameter_groups(system, kernel, lambda p: self._random(self.parameters[p], rng), rng)
        single_variables = [[i] for i in self.settable if self.table[i].source != "parameter"]
        return single_variables + [[self.parameters[p] for p in group] for group in groups]

    def close(self, systems: Sequence[mbs.System]) -> None:
        """Add dependencies that trials may not have shown: those of forces and of a settled start."""
        kinds = {i: {_kind(system, self.table[i].index) for system in systems} for i in self.sensed}
        kind = {
            i: next(k for k in (_FORCE, _MOTION, _FEEDTHROUGH) if k in of_systems) for i, of_systems in kinds.items()
        }
        placed = {i for i, v in enumerate(self.table) if v.source in ("parameter", "pose")}
        forced = {k for i in self.sensed if kind[i] == _FORCE for k in self.initial[i]}
        on_road = {
            i for i in self.sensed if any(_reads_road_element(system, self.table[i].index) for system in systems)
        }
        for i in self.outputs:
            if i in on_road:  # constant on level ground, such as its normal, but not on a kerb that no wheel stands on
                self.initial[i] |= placed | forced
            if kind.get(i) == _FORCE and self.initial[i]:
                self.initial[i] |= placed
        if any(v.source == "settling" for v in self.table):
            driven = any(self.changed_over_step[i] for i in self.sensed if kind[i] != _FEEDTHROUGH)
            moving = {
                i for i in self.sensed if self.initial[i] or self.changed_over_step[i] or (driven and kind[i] == _FORCE)
            }
            moving = {i for i in moving if kind[i] != _FEEDTHROUGH}
            predicted = {i for i in self.outputs if self.table[i].source == "ahead"}
            self.settling = moving | {i for i in predicted if {self.table[i].index, self.table[i].other} & moving}

    def _steps(self, kernel: Instance, h: float, rng: random.Random) -> None:
        """Make some steps with random inputs, then compare one step with and without a change of each input."""
        values = {i: self._random(i, rng) for i in self.settable}
        if self._start(kernel, values) is None and self._start(kernel, {}) is None:
            return
        try:
            for _ in range(rng.randrange(_STEPS)):
                kernel.step(h)
                self._sizes(list(kernel.sensors()))
                if rng.random() < 0.2:
                    for i in self.inputs:
                        kernel.set_input(self.table[i].index, self._random(i, rng))
        except KernelError:
            pass  # the last accepted state remains
        state = kernel.save()
        base = self._sensors_after_step(kernel, h)
        for i in self.inputs:
            kernel.restore(state)
            kernel.set_input(self.table[i].index, self._random(i, rng))
            self._compare(self.changed_over_step, i, base, self._sensors_after_step(kernel, h))

    def _sensors_after_step(self, kernel: Instance, h: float) -> list[float] | None:
        """Sensors after one step; None if it fails."""
        try:
            kernel.step(h)
        except KernelError:
            return None
        return list(kernel.sensors())

    def _compare(
        self,
        reach: dict[int, set[int]],
        variable: int,
        sensors: list[float] | None,
        changed_sensors: list[float] | None,
    ) -> None:
        """Add a variable to the dependencies of all outputs that differ between two lists of sensors."""
        if sensors is None or changed_sensors is None:
            return
        for i in self.sensed:
            if sensors[self.table[i].index] != changed_sensors[self.table[i].index]:
                reach[i].add(variable)

    def _sizes(self, sensors: list[float]) -> None:
        for i in self.sensed:
            self.size[i] = max(self.size[i], abs(sensors[self.table[i].index]))

    def _random(self, i: int, rng: random.Random) -> float:
        """A random value of a variable within the present share of its range."""
        v = self.table[i]
        span = _POSE_RANGES.get(v.name, _OPEN_RANGE) if v.source == "pose" else _OPEN_RANGE
        centre = v.start or 0.0
        if v.tried is not None:
            return centre + self.share * rng.uniform(-v.tried, v.tried)
        low = v.min if v.min is not None else min(centre - span, v.max if v.max is not None else centre)
        high = v.max if v.max is not None else max(centre + span, low)
        if v.source == "pose":
            low = 0.0
        value = rng.uniform(low, high)
        return float(round(value)) if v.whole else centre + self.share * (value - centre)

    def _start(self, kernel: Instance, values: dict[int, float]) -> list[float] | None:
        """Sensors of the initial state with given values; None if the start fails."""
        kernel.reset()
        pose = [0.0] * len(_POSE_RANGES)
        try:
            for i, value in values.items():
                v = self.table[i]
                if v.source == "input":
                    kernel.set_input(v.index, value)
                elif v.source == "parameter":
                    kernel.set_parameter(v.index, value)
                else:
                    pose[v.index] = value
            if any(pose):
                kernel.set_pose(*pose)
            kernel.initialise(0.0)
        except KernelError:
            return None
        sensors = list(kernel.sensors())
        self._sizes(sensors)
        return sensors


def _kind(system: mbs.System, sensor: int) -> str:
    """Whether a sensor repeats inputs, reads positions and velocities, or forces and accelerations."""
    kind, offset = SensorType(system.arrays["sen_type"][sensor]), int(system.arrays["sen_int_ptr"][sensor])
    reads = SENSOR_READS[kind]
    if reads == SensorReads.INPUTS:
        return _FEEDTHROUGH
    is_second_rate = kind in _WITH_ORDER and int(system.arrays["sen_int"][offset]) == _SECOND_ORDER
    return _MOTION if reads in (SensorReads.MOTION, SensorReads.SOLVER) and not is_second_rate else _FORCE


def _reads_road_element(system: mbs.System, sensor: int) -> bool:
    """Whether a sensor reads an output of an element on a road."""
    if SensorType(system.arrays["sen_type"][sensor]) != SensorType.ELEMENT_OUTPUT:
        return False
    element = int(system.arrays["sen_int"][int(system.arrays["sen_int_ptr"][sensor])])
    return ElementType(system.arrays["el_type"][element]) in _ON_ROAD
