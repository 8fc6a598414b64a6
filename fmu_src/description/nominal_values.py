"""Nominal values of outputs, from a drive at build time in which all inputs move moderately."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

import mbs
from fmu_src.variables.variables import Variable
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance

SECONDS = 4.0
_INITIAL_SPEED = 15.0  # m/s, if the System has an initial pose
_AMPLITUDE = 0.3  # of an input, relative to the distance from its start value to the ends of its range
_HALF_WIDTH = 1.0  # of the range of an input without one
_LOWEST_FREQUENCY = 0.4  # Hz, of the first input
_FREQUENCY_RATIO = 1.3  # of an input to the one before it
# Words of wheels and sides, whose outputs share a nominal value: _FL and _RR, left and right.
_SIDE = re.compile(r"(?<![A-Za-z])(FL|FR|RL|RR|left|right)(?![A-Za-z])")


_ROUND_OFF = 1e-14
_MOST_STEPS = 4000


def with_nominal(
    table: Sequence[Variable], sizes_of_drive: Mapping[int, float], sizes_of_trials: Mapping[int, float]
) -> tuple[Variable, ...]:
    """Real outputs get a typical size: the power of ten below the largest value, for wheels and sides the same.

    `sizes_of_drive`, `sizes_of_trials`: largest values by the places of outputs, of a drive and, for outputs that it
    does not move, of trials.
    """
    sizes = {
        i: sizes_of_drive[i] if sizes_of_drive.get(i, 0.0) > _ROUND_OFF else size for i, size in sizes_of_trials.items()
    }
    group = [_SIDE.sub("*", v.name) for v in table]
    largest: dict[str, float] = {}
    for i, size in sizes.items():
        largest[group[i]] = max(largest.get(group[i], 0.0), size)
    return tuple(
        replace(v, nominal=10.0 ** math.floor(math.log10(largest[group[i]])))
        if largest.get(group[i], 0.0) > _ROUND_OFF and not v.whole
        else v
        for i, v in enumerate(table)
    )


def drive_sizes(systems: Sequence[mbs.System], table: Sequence[Variable]) -> dict[int, float]:
    """Largest absolute values of sensors after the steps of a drive of each System, up to one that is refused.

    Result: by their places in the table.
    """
    sensor_numbers = {i: v.index for i, v in enumerate(table) if v.source == "sensor"}
    inputs = [v for v in table if v.source == "input" and not v.whole]
    largest = np.zeros(max(sensor_numbers.values(), default=-1) + 1)
    for system in systems:
        kernel = Instance(LoadedSystem(system.kernel_bytes()))
        h = float(system.meta["experiment"]["step_s"])
        try:
            if system.meta["floating"]:
                kernel.set_pose(speed=_INITIAL_SPEED)
            kernel.initialise(0.0)
            for k in range(min(round(SECONDS / h), _MOST_STEPS)):
                for n, v in enumerate(inputs):
                    fraction = math.sin(math.tau * _LOWEST_FREQUENCY * _FREQUENCY_RATIO**n * k * h)
                    kernel.set_input(v.index, _input_value(v, fraction))
                kernel.step(h)  # only then: drag and traction begin suddenly and make points of a flexible frame jump
                largest = np.maximum(largest, np.abs(kernel.sensors()))
        except KernelError:
            continue
    return {i: float(largest[index]) for i, index in sensor_numbers.items()}


def _input_value(v: Variable, fraction: float) -> float:
    """Value of an input. `fraction`: of its amplitude, -1 to 1."""
    start = v.start or 0.0
    if v.tried is not None:
        return start + _AMPLITUDE * fraction * v.tried
    low, high = (start + s * _HALF_WIDTH if end is None else end for s, end in ((-1.0, v.min), (1.0, v.max)))
    return start + _AMPLITUDE * (fraction * (high - start) if fraction > 0.0 else -fraction * (low - start))
