"""Guides from measured accelerations, as in the paper: signals, double integration, the kerb test.

The authors of the paper drove the kerb test with signals of accelerometers on the prototype, which are not published.
Here the signals are from a simulation: specific forces at the four accelerometers of the car, 100 Hz, with noise,
offset and drift.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator, PPoly

from ali3.low_pass import low_pass
from benchmarks.car.fidelity_runs import FREQUENCY, MOMENTS
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table
from mbs import Settings, Trajectory, compile, simulate
from mbs.model.model import Model
from mbs.model.records import DrivingFunction
from mbs.scenes import kerb_test, prototype_car

Array = NDArray[np.float64]
GRAVITY = 9.81  # m/s2
RATE = 0.01  # s between samples
FINE_STEP = 0.002  # step of the simulation that gives the signals, s
CUT_OFF = 40.0  # frequency of the filter before sampling, Hz
NOISE = 3.0  # standard deviation of the samples, m/s2
OFFSET = 0.2  # standard deviation of the zero, m/s2
DRIFT = 0.02  # standard deviation of the rate of the zero, m/s3
STANDSTILL = (kerb_test.ACCELERATE[0], kerb_test.BRAKE[1])  # s: the car stands before the first and after the second
_WINDOW = 1.0  # s at rest for each value of the drift
POSITIONS = prototype_car.car().chassis.accelerometers
_ARMS = np.array(list(POSITIONS.values())) - np.array(prototype_car.car().chassis.reference)


@dataclass(frozen=True)
class Signals:
    """Motion of the chassis from four accelerometers."""

    time: Array
    """s, shape (n,)."""
    force: Array
    """Specific force (acceleration less gravity) in chassis axes, m/s2, in the order of `POSITIONS`, shape (n, 4,
    3).
    """

    def filtered(self, frequency: float) -> Signals:
        """The signals after a low-pass without phase shift. `frequency`: Hz."""
        flat = self.force.reshape(len(self.time), -1)
        samples = np.stack([low_pass(column, RATE, frequency) for column in flat.T], axis=1)
        return Signals(self.time, samples.reshape(self.force.shape))


@dataclass(frozen=True)
class Motion:
    """Longitudinal motion of the chassis by double integration."""

    time: Array
    """s, shape (n,)."""
    way: Array
    """Along the axis of the chassis, m, shape (n,)."""
    speed: Array
    """Along that axis, m/s, shape (n,)."""
    guide: PPoly
    """The way over time, with a piecewise linear acceleration."""


def simulate_smooth() -> Trajectory:
    """Simulate the kerb test with its own guide, with steps of `FINE_STEP`."""
    return simulate(compile(kerb_test.build()), kerb_test.DURATION, FINE_STEP)


def accelerometer_signals(
    run: Trajectory, noise: float = NOISE, offset: float = OFFSET, drift: float = DRIFT, seed: int = 0
) -> Signals:
    """Accelerometer signals of a run.

    `noise`, `offset`, `drift`: standard deviations of the samples, m/s2, of the zero, m/s2, and of its rate, m/s3;
    `seed`: seed of NumPy's generator.
    """
    every = round(RATE / (run.t[1] - run.t[0]))
    axes = "xyz"
    accelerations = np.stack([[run[f"accelerometer_{name}.a{c}"] for c in axes] for name in POSITIONS]).transpose(
        2, 0, 1
    )
    pitch, roll = run["chassis.pitch"], run["chassis.roll"]
    down = -GRAVITY * np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)], axis=1)
    force = accelerations - down[:, np.newaxis, :]
    flat = force.reshape(len(force), -1)
    samples = np.stack([low_pass(column, run.t[1] - run.t[0], CUT_OFF)[::every] for column in flat.T], axis=1)
    time = run.t[::every]
    rng = np.random.default_rng(seed)
    samples = samples + offset * rng.normal(size=12) + drift * rng.normal(size=12) * time[:, np.newaxis]
    return Signals(time, (samples + noise * rng.normal(size=samples.shape)).reshape(-1, 4, 3))


def motion(signals: Signals, distance: float) -> Motion:
    """The longitudinal motion of the chassis, corrected for the drift at rest.

    Least squares give the acceleration of the reference point and the angular acceleration from the four signals;
    squares of angular velocities are neglected. The first is integrated; means over a second at rest are the drift of
    the speed, interpolated by a monotone cubic. The speed is then scaled to the known distance.

    `distance`: distance from rest to rest, m. The scaling corrects for the weight in the signal by the pitch of the
    braked car.
    """
    t = signals.time
    arms = np.vstack([np.hstack([np.eye(3), -_cross(arm)]) for arm in _ARMS])
    rigid = np.linalg.lstsq(arms, signals.force.reshape(len(t), 12).T, rcond=None)[0]
    speed = cumulative_trapezoid(rigid[0], t, initial=0)
    drift = _drift(t, speed)
    speed -= drift(t)
    scale = distance / float(cumulative_trapezoid(speed, t)[-1])
    speed *= scale
    change = scale * (rigid[0] - drift.derivative()(t))
    change, breaks = np.append(change, change[-1]), np.append(t, t[-1] + RATE)  # constant after its end
    guide = PPoly(np.stack([np.diff(change) / np.diff(breaks), change[:-1]]), breaks).antiderivative(2)
    return Motion(t, cumulative_trapezoid(speed, t, initial=0), speed, guide)


def _cross(r: Array) -> Array:
    """Matrix of the cross product r x."""
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def _drift(t: Array, v: Array) -> PchipInterpolator:
    """Drift of a rate `v` that begins at 0, interpolated between its means at rest."""
    begins = [*np.arange(t[0], STANDSTILL[0], _WINDOW), *np.arange(STANDSTILL[1], t[-1], _WINDOW)]
    windows = [(t >= b - 1e-9) & (t <= min(b + _WINDOW, t[-1]) + 1e-9) for b in begins]
    knots = [t[0], *(float(t[w].mean()) for w in windows), t[-1]]
    return PchipInterpolator(knots, [v[0], *(float(v[w].mean()) for w in windows), v[-1]])


def simulate_guided(driving_motion: Motion, settings: Settings | None = None) -> Trajectory:
    """Simulate the kerb test with its own step and the chassis guided by a motion."""

    def guide(m: Model, start: float) -> DrivingFunction:
        pieces = PPoly(driving_motion.guide.c.copy(), driving_motion.guide.x)
        pieces.c[-1] += start
        return m.guide_time("way of the chassis", pieces, unit="m")

    return simulate(compile(kerb_test.build(guide=guide)), kerb_test.DURATION, kerb_test.STEP, settings=settings)


CASES: dict[str, dict[str, float]] = {
    "no noise, offset or drift": {"noise": 0.0, "offset": 0.0, "drift": 0.0},
    "offset and drift": {"noise": 0.0},
    "and noise of 1 m/s²": {"noise": 1.0},
    "and noise of 3 m/s²": {},
    "the same after a low-pass of 10 Hz": {"filter": 10.0},
}
COLUMNS = {
    "guide": "",
    "way, m": ".3f",
    "speed, m/s": ".3f",
    "iterations": ".2f",
    "most": "d",
    "tangents": ".2f",
    "later, s": "+.3f",
    "moments, %": ".1f",
    "peaks, %": ".1f",
}
PAPER = {"guide": "the paper's, measured", "iterations": 2.0, "most": 3}
_MAX_SHIFT = 0.5  # s
_EDGE = 0.1  # s at the end that are not compared


def moments(run: Trajectory) -> Array:
    """Changes of the moments at the four gauges since the start, after the low-pass, N m, shape (n, 4).

    The last tenth of a second is left out, where the filter has signals on one side only.
    """
    h = float(run.t[1] - run.t[0])
    changes = np.stack([low_pass(run[name] - run[name][0], h, FREQUENCY) for name in MOMENTS], axis=1)
    return changes[: -round(_EDGE / h)]


def best_shift(reference: Array, replayed: Array) -> tuple[int, float]:
    """Delay of moments in steps, and their error after this shift, rms relative to the rms of the reference."""
    limit = round(_MAX_SHIFT / kerb_test.STEP)

    def error_of(k: int) -> float:
        one, other = (replayed[k:], reference[: len(reference) - k]) if k >= 0 else (replayed[:k], reference[-k:])
        return float(np.sqrt(np.mean((one - other) ** 2) / np.mean(other**2)))

    errors = {k: error_of(k) for k in range(-limit, limit + 1)}
    best = min(errors, key=lambda k: errors[k])
    return best, errors[best]


def cost(run: Trajectory) -> dict[str, float]:
    """Mean and largest number of iterations of a step, and mean number of its tangents."""
    report = run.report
    assert report is not None
    return {
        "iterations": report.mean_iterations,
        "most": report.max_iterations,
        "tangents": report.factorizations / report.steps,
    }


def row_of(name: str, true: Trajectory, plain: Trajectory, seeds: Sequence[int]) -> dict[str, Any]:
    """Row of a case: means over the seeds, and the largest number of iterations.

    `name`: key of `CASES`; `true`: the run with the signals; `plain`: the test with its own guide and step.
    """
    options = dict(CASES[name])
    frequency = options.pop("filter", 0.0)
    every = round(RATE / FINE_STEP)
    x = true["chassis.x"][::every] - true["chassis.x"][0]
    reference = moments(plain)
    results = []
    for seed in seeds:
        signals = accelerometer_signals(true, seed=seed, **options)
        driving_motion = motion(signals.filtered(frequency) if frequency else signals, float(x[-1]))
        run = simulate_guided(driving_motion)
        guided_moments = moments(run)
        delay, error = best_shift(reference, guided_moments)
        peaks = np.abs(guided_moments).max(axis=0) / np.abs(reference).max(axis=0) - 1.0
        results.append(
            {
                "way, m": _rms(driving_motion.way - x),
                "speed, m/s": _rms(driving_motion.speed - np.gradient(x, driving_motion.time)),
                **cost(run),
                "later, s": delay * kerb_test.STEP,
                "moments, %": 100.0 * error,
                "peaks, %": 100.0 * float(np.abs(peaks).max()),
            }
        )
    means: dict[str, Any] = {k: float(np.mean([m[k] for m in results])) for k in results[0]}
    return {"guide": name, **means, "most": int(max(m["most"] for m in results))}


def _rms(error: Array) -> float:
    return float(np.sqrt(np.mean(error**2)))


def measure(seeds: int) -> list[dict[str, Any]]:
    """Rows of the paper, of the smooth guide and of all cases. `seeds`: number of noises."""
    true, plain = simulate_smooth(), simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    none = dict.fromkeys(COLUMNS)
    rows = [none | PAPER, none | {"guide": "smooth", **cost(plain)}]
    return rows + [row_of(name, true, plain, range(seeds)) for name in watched(list(CASES))]


def driving_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the page."""
    return {"measured guides": table(rows, COLUMNS)}
