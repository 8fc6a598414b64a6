"""The signals of a log beside simulated ones: deviations, rating and delay of each, and their common delay."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hosts.compare.alignment import Alignment, align
from hosts.compare.curve import Curve
from hosts.compare.deviations import Deviations, deviations
from hosts.compare.rating import Rating, rating, resampled_evenly
from hosts.measures.measure import Measure
from hosts.measures.signal import Signal


@dataclass(frozen=True)
class ComparedSignal:
    """A signal of the log and of the simulation."""

    measured: Signal
    simulated: Curve
    deviations: Deviations
    """At the samples of the log, without correction of a delay."""
    rating: Rating
    alignment: Alignment


@dataclass(frozen=True)
class Comparison:
    """The comparison of all signals."""

    signals: dict[str, ComparedSignal]
    common: Alignment
    """Common delay and drift of the signals whose own delay could be determined; of all signals if there are none."""


def compare(
    outputs: Mapping[str, Signal], curves: Mapping[str, Curve], longest_delay: float, skip: float = 0.0
) -> Comparison:
    """Compare measured signals with simulated ones.

    `longest_delay`: largest delay of the search, s; `skip`: time at the beginning that is not compared, s.
    """
    pairs = {}
    for name, measured in outputs.items():
        curve = curves[name]
        pairs[name] = curve.with_nearest_turns(measured.between(skip, curve.end)), curve
    signals = {name: _compare_signal(*pair, longest_delay) for name, pair in pairs.items()}
    determined = [pairs[name] for name, signal in signals.items() if math.isfinite(signal.alignment.delay)]
    return Comparison(signals, align(determined or list(pairs.values()), longest_delay))


def _compare_signal(measured: Signal, curve: Curve, longest_delay: float) -> ComparedSignal:
    t, y, x = measured.time, measured.values, curve(measured.time)
    _, (y_even, x_even) = resampled_evenly(t, y, x)
    alignment = align([(measured, curve)], longest_delay, drift=False)
    return ComparedSignal(measured, curve, deviations(t, y, x), rating(y_even, x_even), alignment)


def measures(comparison: Comparison) -> list[Measure]:
    """All numbers of a comparison as measures with names such as ``chassis.wz.rms``."""
    results = []
    for name, s in comparison.signals.items():
        unit, d, r, a = s.measured.unit, s.deviations, s.rating, s.alignment
        rows: Sequence[tuple[str, float, str, str, str]] = (
            ("rms", d.rms, unit, "root mean square of simulated minus measured", ""),
            ("normalised_rms", d.normalised, "1", "rms over the standard deviation of the measured signal", d.note),
            ("mean", d.mean, unit, "mean of simulated minus measured", ""),
            ("largest", d.largest, unit, f"largest deviation, at {d.time_of_largest:.4g} s", ""),
            ("correlation", d.correlation, "1", "Pearson's coefficient", d.note),
            ("rating", r.overall, "1", "like ISO/TS 18571, 0 to 1", d.note if math.isnan(r.overall) else ""),
            ("rating.corridor", r.corridor, "1", "score of the corridor", ""),
            ("rating.phase", r.phase, "1", "score of the phase", ""),
            ("rating.magnitude", r.magnitude, "1", "score of the magnitude", ""),
            ("rating.slope", r.slope, "1", "score of the slope", ""),
            ("delay", a.delay, "s", "of the log after the simulation", a.note),
        )
        results += [Measure(f"{name}.{suffix}", value, u, text, None, note) for suffix, value, u, text, note in rows]
    c = comparison.common
    results.append(Measure("delay", c.delay, "s", "of the log after the simulation, of all signals", None, c.note))
    results.append(Measure("drift", c.drift, "1", "by how much the clock of the log runs fast", None, c.note))
    return results
