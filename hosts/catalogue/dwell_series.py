"""A series of runs to one side with sine with dwell steering of increasing amplitude."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.stop_conditions import SPUN
from hosts.measures.filters import phaseless_low_pass
from hosts.measures.sine_with_dwell import SineWithDwell, measure_sine_with_dwell

FREQUENCY = 0.7  # Hz
DWELL = 0.5  # s
AFTER = 2.0  # s, straight ahead
_MIN_LAST_AMPLITUDE = math.radians(270.0)
_MAX_AMPLITUDE = math.radians(300.0)
_MIN_SAMPLES = 20  # of a run that is filtered and measured


@dataclass(frozen=True)
class DwellRun:
    """A run of the series: its amplitude, signals and measures."""

    amplitude: float
    """Requested amplitude, rad."""
    run: SteeredRun
    """The run with filtered signals, minus their means before the steering."""
    measures: SineWithDwell

    @property
    def is_lost(self) -> bool:
        """Whether the sideslip exceeded 90°, the car rolled over, or the FMU refused a step."""
        return not self.run.whole or self.measures.sideslip > SPUN


def series_amplitudes(a: float, first: float, increment: float, full_lock: float) -> list[float]:
    """Increasing amplitudes of a series, rad.

    `a`: angle A at 0.3 g, rad; `first`, `increment`: first amplitude and increment, divided by A; `full_lock`: largest
    angle of the steering wheel, rad. The last amplitude is the greater of 6.5 A and 270°, but at most 300° and full
    lock.
    """
    last = min(_MAX_AMPLITUDE if 6.5 * a > _MAX_AMPLITUDE else max(6.5 * a, _MIN_LAST_AMPLITUDE), full_lock)
    multiples = a * (first + increment * np.arange(math.ceil(max(last / a - first, 0.0) / increment)))
    # An amplitude within 1 % of the last one is left out.
    return [float(x) for x in multiples if x < 0.99 * last] + [last]


def sine_with_dwell_table(amplitude: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times, s, and angles of a sine of 0.7 Hz with a dwell of 0.5 s at its second peak, then straight ahead."""
    period = 1.0 / FREQUENCY
    first = np.linspace(0.0, 0.75 * period, 301)
    second = np.linspace(0.75 * period, period, 101)
    time = np.concatenate([first, second + DWELL, [period + DWELL + AFTER]])
    angle = np.concatenate([np.sin(2.0 * math.pi * FREQUENCY * x) for x in (first, second)] + [np.zeros(1)])
    return time, amplitude * angle


def filtered_run(run: SteeredRun) -> SteeredRun:
    """Filter a run with 12 poles without phase (steering wheel 10 Hz, others 6 Hz), and subtract means before it."""
    if len(run.time) < _MIN_SAMPLES:
        return run
    is_before = (run.time < -0.1) if (run.time < -0.1).any() else run.time <= 0.0

    def low_passed(values: NDArray[np.float64], frequency: float) -> NDArray[np.float64]:
        if np.isnan(values).any():
            return values
        filtered = phaseless_low_pass(values, run.interval, min(frequency, 0.4 / run.interval))
        return np.asarray(filtered - filtered[is_before].mean())

    return replace(
        run,
        steering=low_passed(run.steering, 10.0),
        yaw_rate=low_passed(run.yaw_rate, 6.0),
        acceleration=low_passed(run.acceleration, 6.0),
    )


def drive_series(
    car: TestedCar,
    speed: float,
    side: float,
    amplitudes: list[float],
    progress: Callable[[float], None],
) -> list[DwellRun]:
    """Drive runs with increasing amplitudes until the car is lost.

    `speed`: speed at the beginning of steer, coasting, m/s; `side`: 1: first to the left, -1: first to the right;
    `amplitudes`: amplitudes, rad.
    """
    runs: list[DwellRun] = []
    for k, amplitude in enumerate(amplitudes):
        name = f"{math.degrees(amplitude):.0f} deg {'left' if side > 0.0 else 'right'}"
        run = filtered_run(steer(car, name, speed, *sine_with_dwell_table(side * amplitude), Pedals.COAST))
        progress((k + 1) / len(amplitudes))
        measures = SineWithDwell()
        if len(run.time) >= _MIN_SAMPLES:
            slip = None if np.isnan(run.sideslip).any() else run.sideslip
            measures = measure_sine_with_dwell(run.time, run.steering, run.yaw_rate, run.acceleration, slip)
        runs.append(DwellRun(amplitude, run, measures))
        if runs[-1].is_lost:
            break
    progress(1.0)
    return runs
