"""Guides from measured accelerations, as the paper's authors made them: signals, double integration, the kerb test.

The authors of the paper drove the kerb test with what accelerometers on the prototype had measured. Their signals are
not published; here they are made of a computed run: the specific force at the four places where the car has
accelerometers, 100 Hz, with noise, offset and drift.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator, PPoly

from ali3.low_pass import low_pass
from benchmarks.car.fidelity_runs import FREQUENCY, MOMENTS
from benchmarks.shared.command import pyplot, save_chart, watched
from benchmarks.shared.pages import Row, table
from mbs import Settings, Trajectory, compile, simulate
from mbs.model.model import Model
from mbs.model.records import Guide
from mbs.scenes import kerb_test, prototype_car

Array = NDArray[np.float64]
GRAVITY = 9.81  # m/s2
RATE = 0.01  # s between samples
FINE = 0.002  # step of the measured run, s
CUT = 40.0  # frequency of the filter before sampling, Hz
NOISE = 3.0  # standard deviation, m/s2
OFFSET = 0.2  # standard deviation, m/s2
DRIFT = 0.02  # standard deviation, m/s3
REST = (kerb_test.ACCELERATE[0], kerb_test.BRAKE[1])  # s: it stands before the first and after the second
_WINDOW = 1.0  # s, of rest that tells one value of the drift
PLACES = prototype_car.car().chassis.accelerometers
_AT = np.array(list(PLACES.values())) - np.array(prototype_car.car().chassis.reference)


@dataclass(frozen=True)
class Signals:
    """Motion of the chassis from four accelerometers."""

    time: Array
    """Shape (n,): s."""
    force: Array
    """Shape (n, 4, 3): specific force (acceleration less gravity) in the axes of the chassis, m/s2, in the order of
    `PLACES`."""

    def filtered(self, frequency: float) -> Signals:
        """The same after a low-pass that shifts nothing in time, Hz."""
        flat = self.force.reshape(len(self.time), -1)
        seen = np.stack([low_pass(column, RATE, frequency) for column in flat.T], axis=1)
        return Signals(self.time, seen.reshape(self.force.shape))


@dataclass(frozen=True)
class Motion:
    """Motion of the chassis by double integration; a rate of each stands beside it."""

    time: Array
    way: Array
    speed: Array
    heave: Array
    pitch: Array
    """`time`, `way`, `speed`, `heave`, `pitch`: in s; m, m/s along the axis of the chassis; m upwards; rad, positive
    with the nose down, shape (n,)."""
    guide: PPoly
    """The way, whose acceleration is straight from sample to sample."""


def smooth() -> Trajectory:
    """The kerb test as it is, in steps that follow its vibrations."""
    return simulate(compile(kerb_test.build()), kerb_test.DURATION, FINE)


def measured(
    run: Trajectory, noise: float = NOISE, offset: float = OFFSET, drift: float = DRIFT, seed: int = 0
) -> Signals:
    """Signals of accelerometers that see a run.

    `noise`, `offset`, `drift`: standard deviations of each signal: of its samples, m/s2, of its zero, m/s2, and of how
    that moves, m/s3; `seed`: of the generator of NumPy.
    """
    every = round(RATE / (run.t[1] - run.t[0]))
    axes = "xyz"
    accelerations = np.stack([[run[f"accelerometer_{name}.a{c}"] for c in axes] for name in PLACES]).transpose(2, 0, 1)
    pitch, roll = run["chassis.pitch"], run["chassis.roll"]
    down = -GRAVITY * np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)], axis=1)
    force = accelerations - down[:, np.newaxis, :]
    flat = force.reshape(len(force), -1)
    seen = np.stack([low_pass(column, run.t[1] - run.t[0], CUT)[::every] for column in flat.T], axis=1)
    time = run.t[::every]
    rng = np.random.default_rng(seed)
    seen = seen + offset * rng.normal(size=12) + drift * rng.normal(size=12) * time[:, np.newaxis]
    return Signals(time, (seen + noise * rng.normal(size=seen.shape)).reshape(-1, 4, 3))


def motion(signals: Signals, distance: float) -> Motion:
    """The motion of the chassis, with the drift taken out where the car is known to stand.

    The four places give the acceleration of the reference point and the angular acceleration, by least squares; squares
    of angular velocities are left out. Each is integrated once; where the car stands, means over a second are what the
    rate has drifted by, between them a monotone cubic. The speed is then scaled to the known distance.

    `distance`: from rest to rest, m, as measured on the road. It takes out the part of the weight that the pitch of the
    braked car puts into the signal.
    """
    t = signals.time
    arms = np.vstack([np.hstack([np.eye(3), -_cross(place)]) for place in _AT])
    rigid = np.linalg.lstsq(arms, signals.force.reshape(len(t), 12).T, rcond=None)[0]
    drifts = {k: _drift(t, cumulative_trapezoid(rigid[k], t, initial=0)) for k in (0, 2, 4)}
    rates = {k: cumulative_trapezoid(rigid[k], t, initial=0) - drift(t) for k, drift in drifts.items()}
    scale = distance / float(cumulative_trapezoid(rates[0], t)[-1])
    speed = scale * rates[0]
    heave, pitch = (cumulative_trapezoid(rates[k], t, initial=0) for k in (2, 4))
    change = scale * (rigid[0] - drifts[0].derivative()(t))
    change, breaks = np.append(change, change[-1]), np.append(t, t[-1] + RATE)  # beyond its end a guide stands still
    guide = PPoly(np.stack([np.diff(change) / np.diff(breaks), change[:-1]]), breaks).antiderivative(2)
    return Motion(t, cumulative_trapezoid(speed, t, initial=0), speed, heave, pitch, guide)


def _cross(r: Array) -> Array:
    """Matrix whose product with a vector is r times it."""
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def _drift(t: Array, v: Array) -> PchipInterpolator:
    """The drift of a rate that begins at 0: its values while the car stands, interpolated between."""
    begins = [*np.arange(t[0], REST[0], _WINDOW), *np.arange(REST[1], t[-1], _WINDOW)]
    windows = [(t >= b - 1e-9) & (t <= min(b + _WINDOW, t[-1]) + 1e-9) for b in begins]
    knots = [t[0], *(float(t[w].mean()) for w in windows), t[-1]]
    return PchipInterpolator(knots, [v[0], *(float(v[w].mean()) for w in windows), v[-1]])


def driven(guide_motion: Motion, settings: Settings | None = None) -> Trajectory:
    """The kerb test in its own steps, the chassis guided by a motion."""

    def guide(m: Model, start: float) -> Guide:
        pieces = PPoly(guide_motion.guide.c.copy(), guide_motion.guide.x)
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
    "heave, m": ".3f",
    "pitch, deg": ".1f",
    "iterations": ".2f",
    "most": "d",
    "tangents": ".2f",
    "later, s": "+.3f",
    "moments, %": ".1f",
    "peaks, %": ".1f",
}
_SMOOTH = "#0b62c4"
_MEASURED = "#d55e00"
_SIGNAL = "#b0b0b0"
PAPER = {"guide": "the paper's, measured", "iterations": 2.0, "most": 3}
_LATEST = 0.5  # largest shift that is tried, s
_EDGE = 0.1  # cut off at the end, s


def moments(run: Trajectory) -> Array:
    """Changes of the moments at the four gauges since the start, after the low-pass, N m.

    Returns an array of shape (n, 4): without the last tenth of a second, where the low-pass has one side of the noise
    alone.
    """
    h = float(run.t[1] - run.t[0])
    changes = np.stack([low_pass(run[name] - run[name][0], h, FREQUENCY) for name in MOMENTS], axis=1)
    return changes[: -round(_EDGE / h)]


def shifted(reference: Array, replayed: Array) -> tuple[int, float]:
    """Steps by which moments come later, and how far they are off then, rms over the rms of what is wanted."""
    most = round(_LATEST / kerb_test.STEP)

    def off(k: int) -> float:
        one, other = (replayed[k:], reference[: len(reference) - k]) if k >= 0 else (replayed[:k], reference[-k:])
        return float(np.sqrt(np.mean((one - other) ** 2) / np.mean(other**2)))

    errors = {k: off(k) for k in range(-most, most + 1)}
    best = min(errors, key=lambda k: errors[k])
    return best, errors[best]


def cost(run: Trajectory) -> dict[str, float]:
    """Iterations a step, the most of a step, and the tangents that were made for them, a step."""
    report = run.report
    assert report is not None
    return {
        "iterations": report.mean_iterations,
        "most": report.max_iterations,
        "tangents": report.factorizations / report.steps,
    }


def row(name: str, true: Trajectory, plain: Trajectory, seeds: Sequence[int]) -> dict[str, Any]:
    """Means over the seeds, and the most iterations of all.

    `name`: of `CASES`; `true`, `plain`: the run that is measured, and the test with its own guide and steps.
    """
    options = dict(CASES[name])
    frequency = options.pop("filter", 0.0)
    every = round(RATE / FINE)
    x, z, pitch = (true[f"chassis.{k}"][::every] - true[f"chassis.{k}"][0] for k in ("x", "z", "pitch"))
    reference = moments(plain)
    results = []
    for seed in seeds:
        signals = measured(true, seed=seed, **options)
        guide_motion = motion(signals.filtered(frequency) if frequency else signals, float(x[-1]))
        run = driven(guide_motion)
        got = moments(run)
        later, off = shifted(reference, got)
        peaks = np.abs(got).max(axis=0) / np.abs(reference).max(axis=0) - 1.0
        results.append(
            {
                "way, m": _rms(guide_motion.way - x),
                "speed, m/s": _rms(guide_motion.speed - np.gradient(x, guide_motion.time)),
                "heave, m": _rms(guide_motion.heave - z),
                "pitch, deg": float(np.degrees(_rms(guide_motion.pitch - pitch))),
                **cost(run),
                "later, s": later * kerb_test.STEP,
                "moments, %": 100.0 * off,
                "peaks, %": 100.0 * float(np.abs(peaks).max()),
            }
        )
    means: dict[str, Any] = {k: float(np.mean([m[k] for m in results])) for k in results[0]}
    return {"guide": name, **means, "most": int(max(m["most"] for m in results))}


def _rms(error: Array) -> float:
    return float(np.sqrt(np.mean(error**2)))


def measure(seeds: int) -> list[dict[str, Any]]:
    """All rows, after the paper's and that of the smooth guide."""
    true, plain = smooth(), simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    none = dict.fromkeys(COLUMNS)
    rows = [none | PAPER, none | {"guide": "smooth", **cost(plain)}]
    return rows + [row(name, true, plain, range(seeds)) for name in watched(list(CASES))]


def guide_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """The table of the page."""
    return {"measured guides": table(rows, COLUMNS)}


def draw(file: Path) -> None:
    """One seed with all of its noise; moments after the low-pass."""
    plt = pyplot()
    true, plain = smooth(), simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    signals = measured(true)
    guide_motion = motion(signals, float(true["chassis.x"][-1] - true["chassis.x"][0]))
    run = driven(guide_motion)
    shown = [k for k, name in enumerate(MOMENTS) if name.endswith(("SG1", "SG3"))]
    figure, parts = plt.subplots(2 + len(shown), 1, figsize=(9.0, 8.4), sharex=True, layout="constrained")
    parts[0].plot(signals.time, signals.force[:, 0, 0], color=_SIGNAL, linewidth=0.6, label="accelerometer FL, along")
    parts[0].plot(signals.time, np.gradient(kerb_test.speed(signals.time), signals.time), color=_SMOOTH, label="smooth")
    parts[0].set_ylabel("m/s²")
    parts[1].plot(guide_motion.time, kerb_test.speed(guide_motion.time), color=_SMOOTH, label="smooth guide")
    parts[1].plot(guide_motion.time, guide_motion.speed, color=_MEASURED, linewidth=1.0, label="from accelerations")
    parts[1].set_ylabel("speed, m/s")
    reference, got = moments(plain), moments(run)
    for axes, k in zip(parts[2:], shown, strict=True):
        axes.plot(plain.t[: len(reference)], reference[:, k], color=_SMOOTH, label="smooth guide")
        axes.plot(run.t[: len(got)], got[:, k], color=_MEASURED, linewidth=1.0, label="from accelerations")
        axes.set_ylabel(f"change at {MOMENTS[k].split('.')[-1]}, N m")
    parts[-1].set_xlabel("time, s")
    for axes in parts:
        axes.legend(loc="upper left", frameon=False, ncols=2)
        axes.margins(x=0)
        axes.spines[["top", "right"]].set_visible(False)
    save_chart(figure, file)
