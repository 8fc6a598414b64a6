"""Delay and drift against known values, in closed form."""

import math
import re

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from hosts.compare.alignment import align
from hosts.compare.comparison import compare
from hosts.compare.comparison_text import delay_sentence
from hosts.compare.curve import Curve
from hosts.driving.result import Result
from hosts.measures.signal import Signal

END = 20.0


def motion(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.sin(2.0 * t) + 0.5 * np.sin(5.3 * t + 0.7) * np.exp(-(((t - 8.0) / 5.0) ** 2))


def simulated(values: NDArray[np.float64], t: NDArray[np.float64]) -> Curve:
    return Curve(Result(["y"], {"y": "1"}, t, values[:, None], 0.0, END, 0, []), "y")


@pytest.fixture(scope="module")
def curve() -> Curve:
    t = np.arange(0.0, END, 0.01)
    return simulated(motion(t), t)


def log_of(delay: float, drift: float, noise: float = 0.0, seed: int = 1) -> Signal:
    """Samples at another interval: what happens at t is written at delay + (1 + drift) t."""
    t = np.arange(0.0, 19.5, 0.013)
    values = 3.0 + 1.2 * motion((t - delay) / (1.0 + drift))
    return Signal("y", "y", "1", t, values + noise * np.random.default_rng(seed).normal(size=len(t)))


@pytest.mark.parametrize(("delay", "drift"), [(-0.057, 3e-4), (0.4, -2e-3)])
def test_known_delay_and_drift_are_found_to_a_thousandth_of_a_sample(curve: Curve, delay: float, drift: float) -> None:
    alignment = align([(log_of(delay, drift), curve)], 0.6)
    assert alignment.delay == pytest.approx(delay, abs=1e-5)
    assert alignment.drift == pytest.approx(drift, abs=1e-6)
    assert alignment.correlation == pytest.approx(1.0, abs=1e-9)


def test_intervals_hold_under_noise(curve: Curve) -> None:
    inside = 0
    for seed in range(40):
        alignment = align([(log_of(0.08, 0.0, 0.1, seed), curve)], 0.5, drift=False)
        inside += abs(alignment.delay - 0.08) <= alignment.delay_error
        assert 0.001 < alignment.delay_error < 0.01
    assert inside >= 34  # of 40; fewer than 34 has a probability of 0.3 % where it is 95 %


@pytest.mark.slow
def test_intervals_hold_where_a_start_is_measured_with_noise() -> None:
    """A rate, its integral and a speed whose start is off, as a log gives it: no clock runs fast for that."""
    t, late, covered, count = np.arange(0.0, END, 0.01), 0.02, 0, 40
    memory = 0.97
    rate = motion(t)
    angle = np.cumsum(rate) * 0.01
    parts = {"rate": rate, "angle": angle, "speed": 15.0 + 0.5 * np.sin(0.4 * t) + 0.05 * rate**2}
    for seed in range(count):
        random, pairs = np.random.default_rng(seed), []
        for name, values in parts.items():
            size = 0.03 * float(np.std(values))
            off = size * random.normal(size=2) * {"rate": (0.0, 0.0), "angle": (1.0, 0.3), "speed": (1.0, 0.0)}[name]
            noise = lfilter([math.sqrt(1.0 - memory**2)], [1.0, -memory], random.normal(size=len(t) + 500))[500:]
            measured = np.interp(t - late, t, values) + off[0] + off[1] * t + size * noise
            curve = Curve(Result([name], {name: "1"}, t, values[:, None], 0.0, END, 0, []), name)
            pairs.append((Signal(name, name, "1", t[5:-5], measured[5:-5]), curve))
        alignment = align(pairs, 0.5)
        covered += abs(alignment.delay - late) <= alignment.delay_error
        assert not alignment.has_drift
    print(f"\nintervals of 95 % hold in {covered} of {count} logs")
    assert covered >= 36  # fewer have a probability of 1 % where it is 95 %


def test_a_delay_that_cannot_be_determined_is_reported(curve: Curve) -> None:
    noise = np.random.default_rng(2).normal(size=1000)
    alignment = align([(Signal("y", "y", "1", 0.015 * np.arange(1000), noise), curve)], 0.5)
    assert math.isnan(alignment.delay)
    assert "no delay can be determined" in alignment.note
    flat = align([(Signal("y", "y", "1", 0.015 * np.arange(1000), np.ones(1000)), curve)], 0.5)
    assert flat.note == "no signal moves in both"


@pytest.mark.parametrize("bend", [0.0, 1e-3])
def test_a_short_and_straight_log_gives_no_delay(bend: float) -> None:
    """The rest of another start is enough to move the best delay by samples: of 0.3 s it is none of the log."""
    t = np.arange(0.0, 0.295, 0.01)
    curve = simulated(20.0 - 0.5 * t + 0.1 * t**2, t)
    alignment = align([(Signal("y", "y", "1", t, curve(t) + bend * np.exp(-t / 0.03)), curve)], 1.0)
    assert math.isnan(alignment.delay)
    assert "so short a log" in alignment.note


def test_of_a_periodic_signal_the_smallest_delay_is_taken_and_the_other_named() -> None:
    t = np.arange(0.0, END, 0.01)
    wave = simulated(np.sin(2.0 * np.pi * 2.0 * t), t)
    signal = Signal("y", "y", "1", t[:-100], np.sin(2.0 * np.pi * 2.0 * (t[:-100] - 0.1)))
    alignment = align([(signal, wave)], 1.0, drift=False)
    assert alignment.delay == pytest.approx(0.1, abs=1e-4)
    assert "-0.4" in alignment.note or "0.6" in alignment.note


@pytest.mark.parametrize(("drift", "reported"), [(0.0, False), (-3e-3, True)])
def test_a_difference_of_the_model_in_many_signals_is_no_drift(curve: Curve, drift: float, reported: bool) -> None:
    """Its drift is none of the clock: only what is explained tells. One that is not told leaves the delay alone."""
    t = np.arange(0.0, 19.5, 0.013)
    at = t / (1.0 + drift)
    values = motion(at - 2e-3 * np.sin(3.0 * at))
    pair = (Signal("y", "y", "1", t, values), curve)
    alignment = align(20 * [pair], 0.6)
    assert abs(alignment.drift - drift) < 1e-4
    assert alignment.has_drift is reported
    if not reported:
        assert abs(alignment.drift) > 0.0
        assert alignment.delay == pytest.approx(align([pair], 0.6, drift=False).delay, abs=1e-9)


def test_signals_that_differ_alike_count_as_one(curve: Curve) -> None:
    """Equal ones, of either sign, have the interval of one; of independent noise the root of their number counts."""
    one, count = log_of(0.08, 0.0, 0.1), 16
    alone = align([(one, curve)], 0.5, drift=False).delay_error
    mirrored = Signal("z", "z", "1", one.time, -one.values)
    upside = simulated(-motion(np.arange(0.0, END, 0.01)), np.arange(0.0, END, 0.01))
    alike = align((count // 2) * [(one, curve), (mirrored, upside)], 0.5, drift=False)
    assert alike.delay_error == pytest.approx(alone, rel=0.01)
    others = align([(log_of(0.08, 0.0, 0.1, seed), curve) for seed in range(count)], 0.5, drift=False)
    assert others.delay_error == pytest.approx(alone / math.sqrt(count), rel=0.25)


@pytest.mark.slow
def test_a_signal_with_a_delay_of_its_own_is_reported(curve: Curve) -> None:
    """One of six is 5 ms late: the common delay is of none, and the sentence names the one."""
    names = "abcdef"
    logs = {n: log_of(0.005 if n == "b" else 0.0, 0.0, 1e-3, seed) for seed, n in enumerate(names)}
    text = delay_sentence(compare(logs, dict.fromkeys(names, curve), 0.5))
    (alone,) = re.findall(r" \d of 6 signals have another delay, 'b' farthest, ([\d.]+) ms\.$", text)
    assert float(alone) == pytest.approx(5.0, abs=0.1)
    logs["b"] = log_of(0.0, 0.0, 1e-3, 9)
    assert "another" not in delay_sentence(compare(logs, dict.fromkeys(names, curve), 0.5))
