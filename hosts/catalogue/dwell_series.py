"""A series of runs with sine with dwell steering of growing amplitude, to one side."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.stop_conditions import SPUN
from hosts.measures.filters import phaseless_low_pass
from hosts.measures.sine_with_dwell import NOTHING, SineWithDwell, sine_with_dwell

FREQUENCY = 0.7
DWELL = 0.5
AFTER = 2.0
_LEAST_LAST = math.radians(270.0)
_MOST = math.radians(300.0)


@dataclass(frozen=True)
class DwellRun:
    """A run of the series: its amplitude, signals and measures."""

    amplitude: float
    """Asked for, rad."""
    run: SteeredRun
    """Its signals are filtered and zeroed."""
    measures: SineWithDwell

    @property
    def is_lost(self) -> bool:
        """Whether the car spun by more than a quarter turn, rolled over, or the FMU refused a step."""
        return not self.run.whole or self.measures.sideslip > SPUN


def amplitudes(a: float, first: float, increment: float, full_lock: float) -> list[float]:
    """Amplitudes of a series.

    `a`: angle at 0.3 g, rad; `first`, `increment`: in units of it; `full_lock`: largest angle the car can be steered
    by, rad. Result: in rad, rising; the last is the greater of 6.5 A and 270°, 300° where 6.5 A is above it, or full
    lock.
    """
    last = min(_MOST if 6.5 * a > _MOST else max(6.5 * a, _LEAST_LAST), full_lock)
    rising = a * (first + increment * np.arange(math.ceil(max(last / a - first, 0.0) / increment)))
    # an amplitude within 1 % of the last one would be driven twice
    return [float(x) for x in rising if x < 0.99 * last] + [last]


def table(amplitude: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and angles of a sine of 0.7 Hz that rests at its second peak for 0.5 s; then straight on."""
    period = 1.0 / FREQUENCY
    first = np.linspace(0.0, 0.75 * period, 301)
    second = np.linspace(0.75 * period, period, 101)
    time = np.concatenate([first, second + DWELL, [period + DWELL + AFTER]])
    angle = np.concatenate([np.sin(2.0 * math.pi * FREQUENCY * x) for x in (first, second)] + [np.zeros(1)])
    return time, amplitude * angle


def processed(run: SteeredRun) -> SteeredRun:
    """Signals filtered without phase (steering wheel 10 Hz, others 6 Hz, 12 poles) and zero before the steering."""
    if len(run.time) < 20:
        return run
    before = (run.time < -0.1) if (run.time < -0.1).any() else run.time <= 0.0

    def low_passed(values: NDArray[np.float64], frequency: float) -> NDArray[np.float64]:
        if np.isnan(values).any():
            return values
        filtered = phaseless_low_pass(values, run.interval, min(frequency, 0.4 / run.interval))
        return np.asarray(filtered - filtered[before].mean())

    return SteeredRun(
        run.result,
        run.begin,
        run.time,
        low_passed(run.steering, 10.0),
        low_passed(run.yaw_rate, 6.0),
        low_passed(run.acceleration, 6.0),
        run.sideslip,
        run.roll,
        run.speed,
        run.whole,
    )


def series(
    car: TestedCar,
    speed: float,
    side: float,
    amplitudes: list[float],
    progress: Callable[[float], None],
) -> list[DwellRun]:
    """Runs with rising amplitudes, until the car is lost.

    `speed`: at the beginning of the steering, coasting, m/s; `side`: 1: first to the left, -1: first to the right;
    `amplitudes`: amplitudes, rad.
    """
    runs: list[DwellRun] = []
    for k, amplitude in enumerate(amplitudes):
        name = f"{math.degrees(amplitude):.0f} deg {'left' if side > 0.0 else 'right'}"
        run = processed(steer(car, name, speed, *table(side * amplitude), Pedals.COAST))
        progress((k + 1) / len(amplitudes))
        count = len(run.time) >= 20
        slip = None if np.isnan(run.sideslip).any() else run.sideslip
        measures = sine_with_dwell(run.time, run.steering, run.yaw_rate, run.acceleration, slip) if count else NOTHING
        runs.append(DwellRun(amplitude, run, measures))
        if runs[-1].is_lost:
            break
    progress(1.0)
    return runs
