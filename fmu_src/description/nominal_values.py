"""Typical sizes of outputs: a drive at build time, in which all inputs move moderately."""

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
_SPEED = 15.0  # m/s, where the pose has one
_SHARE = 0.3  # amplitude of an input over the distance from its start value to the ends of its range
_OPEN = 1.0  # half-width of the range of an input that has none
_FIRST = 0.4  # Hz, of the first input
_RATIO = 1.3  # of the frequencies of an input and the one before it
# Wheels and sides, which are one size: _FL and _RR, left and right.
_SIDE = re.compile(r"(?<![A-Za-z])(FL|FR|RL|RR|left|right)(?![A-Za-z])")


_ROUND_OFF = 1e-14
_MOST_STEPS = 4000


def with_nominal(
    table: Sequence[Variable], driven: Mapping[int, float], tried: Mapping[int, float]
) -> tuple[Variable, ...]:
    """Real outputs get a typical size: the power of ten below the largest value, for wheels and sides the same.

    `driven`, `tried`: largest values by the places of outputs: of a drive, and of trials for those that a drive does
    not move.
    """
    sizes = {i: driven[i] if driven.get(i, 0.0) > _ROUND_OFF else size for i, size in tried.items()}
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
                kernel.set_pose(speed=_SPEED)
            kernel.initialise(0.0)
            for k in range(min(round(SECONDS / h), _MOST_STEPS)):
                for n, v in enumerate(inputs):
                    kernel.set_input(v.index, _moved(v, math.sin(math.tau * _FIRST * _RATIO**n * k * h)))
                kernel.step(h)  # before it drag and traction are new to a flexible frame, whose points jump
                largest = np.maximum(largest, np.abs(kernel.sensors()))
        except KernelError:
            continue
    return {i: float(largest[index]) for i, index in sensor_numbers.items()}


def _moved(v: Variable, part: float) -> float:
    """An input at a part from -1 to 1 of its share of the range."""
    start = v.start or 0.0
    if v.tried is not None:
        return start + _SHARE * part * v.tried
    low, high = (start + s * _OPEN if end is None else end for s, end in ((-1.0, v.min), (1.0, v.max)))
    return start + _SHARE * (part * (high - start) if part > 0.0 else -part * (low - start))
