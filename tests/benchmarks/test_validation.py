"""Fits of bicycle models to a drive with known parameters, integrated by SciPy."""

import gzip
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.validation import fitting, two_track
from benchmarks.validation.bank import PORT, bank_of, distance_and_lap, write_banked
from benchmarks.validation.bicycle import MODELS, Body, Model, simulate
from benchmarks.validation.drive import Drive, read_drive
from hosts.common.errors import HostError
from hosts.compare.log_aliases import read_log_aliases
from hosts.compare.log_file import read_log

BODY = Body(1000.0, 1500.0, 1.3, 1.1)
STIFFNESS = (80e3, 120e3)  # N/rad, front and rear
GRIP = 1.1
OFFSET = 0.002  # rad, of the steering
END = 275.0  # s
H = 0.01  # s
SPANS = ((0.0, 60.0),), ((60.0, 100.0),)  # s that are fitted, and that tell what a fit predicts
PLACES = {model.name: k for k, model in enumerate(MODELS)}


def steer(t: float) -> float:
    return 0.05 * np.sin(0.7 * t) + 0.04 * np.sin(0.23 * t + 1.0)


def speed(t: float) -> float:
    return 27.0 + 8.0 * np.sin(0.11 * t)


@pytest.fixture(scope="module")
def drive() -> Drive:
    """Two wheels, forces grip * load * tanh(stiffness * slip / (grip * load)), by SciPy's LSODA."""
    load = BODY.mass * 9.81 / BODY.wheelbase * np.array([BODY.rear, BODY.front])

    def rates(t: float, x: np.ndarray) -> list[float]:
        vy, r = x
        v, d = speed(t), steer(t) + OFFSET
        slip = np.arctan2(vy + BODY.front * r, v) - d, np.arctan2(vy - BODY.rear * r, v)
        front, rear = (-GRIP * f * np.tanh(c * a / (GRIP * f)) for f, c, a in zip(load, STIFFNESS, slip, strict=True))
        front *= np.cos(d)
        return [(front + rear) / BODY.mass - v * r, (BODY.front * front - BODY.rear * rear) / BODY.yaw_inertia]

    t = np.arange(0.0, END + 0.5 * H, H)
    x = solve_ivp(rates, (0.0, END), [0.0, 0.0], method="LSODA", t_eval=t, rtol=1e-9, atol=1e-9).y
    return Drive(t, np.array([steer(s) for s in t]), np.array([speed(s) for s in t]), x[0], x[1])


@pytest.mark.slow
def test_the_fit_finds_the_numbers_of_a_drive(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fitting, "LENGTH", 4.0)  # s: more windows cost nothing, longer ones do
    model = MODELS[PLACES["saturating bicycle, tanh"]]
    actual = fitting.fit(model, BODY, drive, *SPANS)
    assert np.max(np.abs(drive.yaw_rate * drive.vx)) > 0.75 * 9.81 * GRIP  # the curves bend
    np.testing.assert_allclose(actual.numbers, [*STIFFNESS, GRIP, OFFSET], rtol=0.01)
    assert max(actual.fitted, actual.windows, actual.whole) < 3e-4
    assert actual.lateral < 0.01
    assert actual.departed == 0
    linear = fitting.fit(MODELS[PLACES["linear bicycle"]], BODY, drive, *SPANS)
    assert linear.windows > 20.0 * actual.windows


@pytest.mark.slow
def test_the_steps_of_a_bicycle_are_fine_enough(drive: Drive) -> None:
    """Heun's method at the samples against LSODA, over the whole drive."""
    model = MODELS[PLACES["saturating bicycle, tanh"]]
    numbers = np.array([[*STIFFNESS, GRIP, OFFSET]])
    vy, rate = simulate(model, BODY, drive, np.array([0]), len(drive.time) - 1, numbers)
    assert np.max(np.abs(rate[0, 0] - drive.yaw_rate)) < 0.01 * np.max(np.abs(drive.yaw_rate))
    assert np.max(np.abs(vy[0, 0] - drive.vy)) < 0.02


def test_a_centre_of_mass_beside_the_middle_turns_the_braked_car(drive: Drive) -> None:
    """On the right the braked car turns to the left: mass times deceleration times lever over the inertia."""
    model = MODELS[PLACES["load transfer, centre of mass beside the middle"]]
    right, deceleration = -0.03, 4.0
    speeds = 40.0 - deceleration * drive.time
    zero = np.zeros_like(drive.time)
    braked = Drive(drive.time, zero, speeds, zero, zero)
    soft = {"front stiffness": 1e-6, "rear stiffness": 1e-6, "front grip": 1.0, "rear grip": 1.0}
    own = soft | {"centre of mass to the left": right}
    numbers = np.array([[own.get(u.name, 0.0) for u in model.unknowns]])
    _, rate = simulate(model, BODY, braked, np.array([100]), 100, numbers)
    expected = BODY.mass * deceleration * -right / BODY.yaw_inertia
    assert rate[0, 0, -1] == pytest.approx(expected, rel=1e-3)


def test_a_packed_log_is_read_by_its_alias_file(tmp_path: Path) -> None:
    """Signs, units and offsets of the alias file; the angles of both wheels are averaged."""
    (tmp_path / "a.toml").write_text(
        '[time]\nname = "t"\n[signals]\n"wheel_FL.steer" = { name = "l", unit = "deg" }\n'
        '"wheel_FR.steer" = { name = "r", unit = "deg", factor = -1.0, offset = 2.0 }\n'
        '"chassis.vx" = { name = "v", unit = "km/h" }\n"chassis.vy" = "w"\n"chassis.wz" = "y"\n',
        encoding="utf-8",
    )
    rows = "\n".join(f"{5 + 0.01 * k:.2f},{k},{2 - 3 * k},36,0.5,0.1" for k in range(20))
    with gzip.open(tmp_path / "log.csv.gz", "wt", encoding="utf-8") as stream:
        stream.write(f"t,l,r,v,w,y\n{rows}\n")
    actual = read_drive(tmp_path / "log.csv.gz", tmp_path / "a.toml")
    np.testing.assert_allclose(actual.steer, np.radians(2.0 * np.arange(20)))
    assert (actual.time[0], actual.interval) == (0.0, pytest.approx(0.01))
    assert actual.vx[0] == pytest.approx(10.0)
    assert (actual.vy[0], actual.yaw_rate[0]) == (0.5, 0.1)
    (tmp_path / "a.toml").write_text('[time]\nname = "t"\n[signals]\n"chassis.vx" = "v"\n', encoding="utf-8")
    with pytest.raises(HostError, match=r"has no 'wheel_FL\.steer'"):
        read_drive(tmp_path / "log.csv.gz", tmp_path / "a.toml")


def test_two_tracks_turn_where_brakes_and_drive_differ_from_side_to_side(drive: Drive) -> None:
    """Moments of forces along by their levers; of the drive by load, those of a car that already turns."""
    by_load, opened = (two_track.MODELS[k] for k in (1, 0))
    speeds, zero = 40.0 - 4.0 * drive.time, np.zeros_like(drive.time)
    numbers = {"front stiffness": 1e-6, "rear stiffness": 1e-6, "front grip": 1.0, "rear grip": 1.0}
    numbers |= {"yaw inertia factor": 1.0, "brake side": 0.1, "exponent of stiffness": 0.5}
    braked = Drive(drive.time, zero, speeds, zero, zero)

    def turned(model: Model, drive: Drive, **changed: float) -> float:
        p = np.array([[(numbers | changed)[u.name] for u in model.unknowns]])
        return float(two_track.simulate(model, BODY, drive, np.array([0]), 50, p)[1][0, 0, 50])

    moment = 0.1 * 4.0 * BODY.mass * 0.5 * two_track.TRACK
    for model in (by_load, opened):
        assert turned(model, braked) == pytest.approx(moment * 50 * H / BODY.yaw_inertia, rel=1e-6)
    driven = Drive(drive.time, zero, 20.0 + 4.0 * drive.time, zero, zero + 0.2)
    first = turned(by_load, driven, **{"brake side": 0.0}) - 0.2
    assert turned(opened, driven, **{"brake side": 0.0}) == pytest.approx(0.2)
    assert first > 0.01  # the outer wheels carry more and push more: a left turn is pushed to the left


@pytest.mark.slow
def test_the_bank_of_the_road_is_computed_by_position_and_accelerates_the_car(drive: Drive) -> None:
    """Laps of 2200 m on a banked road; roll adds 3 % of the acceleration to the signal."""
    time = np.arange(0.0, 190.0, H)
    v = 31.0 + 3.0 * np.sin(0.13 * time)
    distance = np.concatenate([[0.0], np.cumsum(0.5 * H * (v[1:] + v[:-1]))])
    phase = 2.0 * np.pi * distance / 2200.0
    rate = v * 4e-3 * (np.sin(phase) + np.sin(3.0 * phase) + 0.7 * np.cos(7.0 * phase))
    true = 0.4 * np.sin(2.0 * phase) - 0.2 * np.cos(4.0 * phase)
    banked = Drive(time, 0.0 * v, v, 0.0 * v, rate, 1.03 * rate * v - true)
    actual = bank_of(banked)
    assert distance_and_lap(banked)[1] == pytest.approx(2200.0, abs=2.0)
    inside = (time > 5.0) & (time < 185.0)
    assert np.sqrt(np.mean((actual - true)[inside] ** 2)) < 0.08
    noise = np.random.default_rng(5).normal(size=len(time))
    elsewhere = Drive(time, 0.0 * v, v, 0.0 * v, 0.1 * noise, noise)
    with pytest.raises(ValueError, match="does not repeat its path"):
        bank_of(elsewhere)
    model = two_track.MODELS[2]
    p = np.array([[1e-6, 1e-6, 1.0, 1.0, 1.0, 0.0, 0.5]])
    slope = Drive(drive.time, 0.0 * drive.time, 20.0 + 0.0 * drive.time, 0.0 * drive.time, 0.0 * drive.time)
    moved = two_track.simulate(model, BODY, replace(slope, bank=0.5 + 0.0 * drive.time), np.array([0]), 100, p)[0]
    assert moved[0, 0, 100] == pytest.approx(0.5, rel=1e-6)  # m/s after a second


@pytest.mark.parametrize("name", ["drive.csv", "drive.csv.gz"])
def test_a_log_gets_the_bank_of_the_road_as_a_force(tmp_path: Path, name: str) -> None:
    text = b"time [s],vx [m/s]\n0.0,20\n0.01,21\n"
    log, aliases = tmp_path / name, tmp_path / "drive.toml"
    log.write_bytes(gzip.compress(text) if name.endswith(".gz") else text)
    aliases.write_text('[time]\nname = "time"\n[signals]\n"chassis.vx" = { name = "vx", unit = "m/s" }\n', "utf-8")
    file, names = write_banked(tmp_path, log, aliases, np.array([0.5, -0.25]), 1000.0)
    form = read_log_aliases(names)
    assert form.columns[PORT].unit == "N"
    read = read_log(file, form.dialect)
    assert read.numbers(form.columns[PORT].name).tolist() == [500.0, -250.0]
    assert read.numbers("vx").tolist() == [20.0, 21.0]
