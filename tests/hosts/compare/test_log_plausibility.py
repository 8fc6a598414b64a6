"""Faulty columns of a log (units, delays, exchanged, frozen, joined) are reported with their correction."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hosts.measures.log_plausibility import consistent, log_plausibility
from hosts.measures.signal import Signal

Drive = dict[str, Signal]
UNITS = {"speed": "m/s", "chassis.ax": "m/s2", "chassis.ay": "m/s2", "chassis.wz": "rad/s", "chassis.yaw": "rad"} | {
    "chassis.x": "m", "chassis.y": "m", "wheel_FL.omega": "rad/s", "wheel_RR.omega": "rad/s"}  # fmt: skip


def drive(seed: int = 0, end: float = 40.0) -> Drive:
    """A minute of turns and pedals with the noise of sensors."""
    noise, t = np.random.default_rng(seed), np.arange(0.0, end, 0.02)
    speed = 18.0 + 5.0 * np.sin(0.25 * t) + 0.8 * np.sin(0.9 * t + seed)
    ax = 1.25 * np.cos(0.25 * t) + 0.72 * np.cos(0.9 * t + seed)
    wz = 0.25 * np.sin(0.5 * t) + 0.08 * np.sin(1.3 * t)
    yaw = -0.5 * (np.cos(0.5 * t) - 1.0) - 0.08 / 1.3 * (np.cos(1.3 * t) - 1.0)
    x, y = (np.cumsum(speed * f(yaw)) * 0.02 for f in (np.cos, np.sin))
    values = dict(zip(UNITS, (speed, ax, speed * wz, wz, yaw, x, y, speed / 0.3, speed / 0.31), strict=True))
    spread = {"m/s": 0.02, "m/s2": 0.15, "rad/s": 0.005, "rad": 1e-4, "m": 0.01}
    return {
        name: Signal(name, name.split(".")[-1], UNITS[name], t, v + spread[UNITS[name]] * noise.normal(size=len(t)))
        for name, v in values.items()
    }


def scaled(name: str, factor: float) -> Callable[[Drive], Drive]:
    return lambda d: d | {name: replace(d[name], values=factor * d[name].values)}


def timed(factor: float) -> Callable[[Drive], Drive]:
    return lambda d: {n: replace(s, time=factor * s.time) for n, s in d.items()}


def swapped(a: str, b: str) -> Callable[[Drive], Drive]:
    return lambda d: d | {a: replace(d[a], values=d[b].values), b: replace(d[b], values=d[a].values)}


def late(name: str, delay: float) -> Callable[[Drive], Drive]:
    return lambda d: d | {name: replace(d[name], time=d[name].time + delay)}


def frozen(name: str, begin: float, end: float) -> Callable[[Drive], Drive]:
    def change(d: Drive) -> Drive:
        s = d[name]
        k = int(np.searchsorted(s.time, begin))
        inside = (s.time >= begin) & (s.time < end)
        return d | {name: replace(s, values=np.where(inside, s.values[k], s.values))}

    return change


def missing(name: str) -> Callable[[Drive], Drive]:
    def change(d: Drive) -> Drive:
        values = d[name].values.copy()
        values[[100, 101, 700]] = -9999.0
        return d | {name: replace(d[name], values=values)}

    return change


def twice(d: Drive) -> Drive:
    """Appended to itself."""
    return {
        n: replace(s, time=np.append(s.time, s.time + s.time[-1] + 0.02), values=np.tile(s.values, 2))
        for n, s in d.items()
    }


def joined(d: Drive) -> Drive:
    """Behind another one, which ends elsewhere."""
    other = {n: replace(s, values=s.values[::-1] + 8.0 * np.std(s.values)) for n, s in drive(5).items()}
    return {
        n: replace(s, time=np.append(s.time, s.time + s.time[-1] + 0.02), values=np.append(s.values, other[n].values))
        for n, s in d.items()
    }


PLANTED = {
    "km/h": (scaled("speed", 3.6), "km/h instead of m/s of 'speed'"),
    "deg/s": (scaled("chassis.wz", 57.3), "deg/s instead of rad/s of 'wz'"),
    "g of ay": (scaled("chassis.ay", 1.0 / 9.81), "g instead of m/s² of 'ay'"),
    "heading in degrees": (scaled("chassis.yaw", 57.3), "deg instead of rad of 'yaw'"),
    "path in mm": (lambda d: scaled("chassis.x", 1e3)(scaled("chassis.y", 1e3)(d)), "mm instead of m of the path"),
    "rpm": (scaled("wheel_FL.omega", 9.549), "rpm instead of rad/s of 'omega' (wheel_FL.omega)"),
    "sign of ay": (scaled("chassis.ay", -1.0), "the other sign of 'ay'"),
    "sign of the heading": (scaled("chassis.yaw", -1.0), "the other sign of 'yaw'"),
    "time twice as fast": (timed(0.5), "time twice as fast"),
    "time in ms": (timed(1e3), "ms instead of s"),
    "ax and ay": (swapped("chassis.ax", "chassis.ay"), "'ax' and 'ay' exchanged"),
    "x and y": (swapped("chassis.x", "chassis.y"), "'x' and 'y' exchanged"),
    "gravity in ax": (
        lambda d: d | {"chassis.ax": replace(d["chassis.ax"], values=d["chassis.ax"].values + 9.81)},
        "an offset of 9.8",
    ),
    "wz late": (late("chassis.wz", 0.6), "s (within 0.02 s) of 'wz'"),
    "ay late": (late("chassis.ay", 0.9), "a delay of 0.9"),
    "-9999": (missing("chassis.ay"), "-9999 in the place of no value in"),
    "a frozen yaw rate": (
        frozen("chassis.wz", 10.0, 14.0),
        "'wz', longest time without a change while the car moves is 3.9",
    ),
    "a frozen wheel": (frozen("wheel_RR.omega", 10.0, 16.0), "'omega', longest time without a change"),
    "appended to itself": (twice, "samples that come again one by one"),
    "two drives": (joined, "samples at which most signals jump is 1"),
}


@pytest.mark.parametrize("case", PLANTED)
def test_a_mistake_is_reported_with_its_correction(case: str) -> None:
    change, message = PLANTED[case]
    warnings = log_plausibility("log.csv", change(drive(len(case)))).warnings()
    assert any(message in sentence for sentence in warnings), warnings


@pytest.mark.parametrize("seed", range(3))
def test_a_right_drive_has_nothing_odd(seed: int) -> None:
    log = drive(seed)
    plausibility = log_plausibility("log.csv", log)
    assert plausibility.warnings() == []
    assert consistent(plausibility) >= {"speed", "chassis.ax", "chassis.ay", "chassis.wz", "chassis.yaw"}
    coarse = {n: replace(s, values=np.round(s.values, 1 if "omega" in n else 2)) for n, s in log.items()}
    assert log_plausibility("log.csv", coarse).warnings() == []


@pytest.mark.parametrize("name", ["chassis.ax", "chassis.wz"])
def test_a_signal_of_the_other_sign_is_not_consistent(name: str) -> None:
    assert name not in consistent(log_plausibility("log.csv", scaled(name, -1.0)(drive())))


@pytest.mark.parametrize("factor", [0.5, 1.8])
def test_a_factor_without_a_name_is_reported_with_its_interval(factor: float) -> None:
    """A hint names a signal only if correcting it alone mends all relations it is in."""
    (sentence,) = log_plausibility("log.csv", scaled("chassis.wz", factor)(drive())).warnings()
    match = re.search(r"a factor of (\S+) \((\S+) to (\S+)\) of 'wz' \(chassis\.wz\) would explain", sentence)
    assert match is not None, sentence
    middle, low, high = map(float, match.groups())
    assert low < 1.0 / factor < high
    assert middle == pytest.approx(1.0 / factor, rel=0.05)


def test_a_car_that_stands_at_lights_has_no_frozen_sensors() -> None:
    """Its speed tells a little more than 0, its acceleration the offset of the sensor; its place is the same."""
    log = drive(end=80.0)
    t = log["speed"].time
    stands = (t > 20.0) & (t < 55.0)
    level = {"speed": 0.2 + 2e-3 * np.sin(t), "chassis.ax": np.full(len(t), -0.098)}
    for name in ("chassis.x", "chassis.y"):
        level[name] = np.full(len(t), log[name].values[stands][0])
    still = {n: replace(log[n], values=np.where(stands, v, log[n].values)) for n, v in level.items()}
    warnings = log_plausibility("log.csv", log | still).warnings()
    assert not any("longest time without a change" in sentence for sentence in warnings), warnings


def test_a_speed_of_0_is_reported_unless_all_others_stand_too() -> None:
    """A car on a rig or parked is a log like others; a speed that is 0 while something moves is a dead channel."""
    moving = drive()
    dead = moving | {"speed": replace(moving["speed"], values=0.0 * moving["speed"].values)}
    still = {n: replace(s, values=1e-3 * s.values) for n, s in dead.items()}
    message = "largest speed is 0 m/s"
    assert not any(message in sentence for sentence in log_plausibility("log.csv", still).warnings())
    for name in UNITS.keys() - {"speed", "chassis.yaw"}:
        warnings = log_plausibility("log.csv", still | {name: dead[name]}).warnings()
        assert any(message in sentence for sentence in warnings), name
    assert any(message in sentence for sentence in log_plausibility("log.csv", {"speed": dead["speed"]}).warnings())


@pytest.mark.parametrize("step", [0.2, 0.01])
def test_peaks_that_are_rounded_are_no_range_that_a_sensor_reaches(step: float) -> None:
    """A robot steers to both sides alike; the sensor tells whole steps."""
    time = np.asarray(0.01 * np.arange(2000), dtype=np.float64)
    wave = np.asarray(np.sin(np.pi * time), dtype=np.float64)
    result = {
        n: Signal(n, n, unit, time, values)
        for n, unit, values in (
            ("speed", "m/s", 20.0 + 0.01 * np.sin(time)),
            ("chassis.wz", "rad/s", 0.21 * wave),
            ("chassis.ay", "m/s2", np.asarray(step * np.round(4.2 * wave / step), dtype=np.float64)),
        )
    }
    assert log_plausibility("log.csv", result).warnings() == []
    for round_to in (step, 1e-9):
        ay = np.clip(round_to * np.round(4.2 * wave / round_to), -3.8, 3.8)
        clipped = replace(result["chassis.ay"], values=ay)
        (warning,) = log_plausibility("log.csv", result | {clipped.name: clipped}).warnings()
        assert "'chassis.ay', samples at both ends of a range" in warning
        assert "offset" not in warning, "it would make the ends unlike, and mend nothing"


def test_the_steering_wheel_determines_the_sign_of_the_yaw_rate_and_no_factor() -> None:
    result = {n: s for n, s in drive().items() if n in ("speed", "chassis.wz")}
    wz = result["chassis.wz"]
    turn = replace(wz, name="steering_wheel_angle", source="wheel", unit="rad", values=12.0 * wz.values)
    plausibility = log_plausibility("log.csv", result | {turn.name: turn})
    assert (plausibility.warnings(), consistent(plausibility)) == ([], set())
    (warning,) = log_plausibility("log.csv", result | {turn.name: replace(turn, values=-turn.values)}).warnings()
    assert "the other sign of 'wheel' (steering_wheel_angle)" in warning
    alike = np.tile(np.sin(np.linspace(0.0, 2.0 * np.pi, 250, endpoint=False)), len(wz.time) // 250)
    robot = replace(turn, values=alike)
    assert not any(
        "come again" in sentence for sentence in log_plausibility("log.csv", result | {turn.name: robot}).warnings()
    )
