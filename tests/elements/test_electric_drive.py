"""Electric motor: its curve, its powers, regeneration, the selector, and the reaction on its carrier."""

from dataclasses import replace

import numpy as np
import pytest

from mbs import Model, compile, simulate
from mbs.analysis.linear_model import linearise
from mbs.elements import ElectricDrive
from mbs.simulation.stepping import Simulation
from tests.elements.harness import (
    Array,
    Element,
    Result,
    check_reaction,
    drive_signals,
    tangent_by_differences,
    vectors,
)

DRIVE = ElectricDrive(
    max_torque=250.0, max_power=100e3, ratio=9.5, regeneration_torque=60.0, regeneration_power=20e3, limit_speed=1100.0
)
BASE = DRIVE.max_power / DRIVE.max_torque  # rad/s, where constant power begins
H = 0.01
EDGES = np.array(
    [
        *(0.0, DRIVE.regeneration_speed, DRIVE.regeneration_power / DRIVE.regeneration_torque, BASE),
        *np.outer((1.0, 1.05), (DRIVE.limit_speed, DRIVE.reverse_speed)).flat,
    ]
)
"""Motor speeds, rad/s, between which the law is smooth, and either side of which it is another."""


def drive_element(drive: ElectricDrive = DRIVE, selector: bool = False) -> Element:
    left, right, f, g = vectors(1, 1, 3, 3)
    return Element(drive.record("drive", left[0], right[0], f, g, 0, 1 if selector else None))


def at(motor_speed: float, throttle: float, drive: ElectricDrive = DRIVE) -> dict[str, float]:
    """Outputs without a selector."""
    W = motor_speed / drive.ratio
    return drive_element(drive)(*drive_signals(W, W), inputs=[throttle]).out


def test_both_wheels_get_the_same_torque_and_the_frame_its_reaction() -> None:
    r, relative = check_reaction(drive_element())
    assert r.out["motor_speed"] == pytest.approx(DRIVE.ratio * relative, rel=1e-12)


@pytest.mark.parametrize("throttle", [1.0, 0.4])
def test_torque_is_constant_then_the_power_then_the_speed_is_limited(throttle: float) -> None:
    drive = replace(DRIVE, regeneration_torque=0.0)
    for w in (-900.0, -10.0, 0.0, 50.0, 0.99 * BASE, 1.01 * BASE, 700.0, 1099.0):
        expected = throttle * min(drive.max_torque, drive.max_power / abs(w) if w else np.inf)
        assert at(w, throttle, drive)["motor_torque"] == pytest.approx(expected, rel=1e-12)
    half = at(1.025 * drive.limit_speed, throttle, drive)["motor_torque"]
    assert half == pytest.approx(0.5 * throttle * drive.max_power / (1.025 * drive.limit_speed), rel=1e-9)
    for w in (1.05 * drive.limit_speed + 1e-6, 3000.0):
        assert at(w, throttle, drive)["motor_torque"] == 0.0


def test_closed_throttle_brakes_up_to_the_power_of_regeneration_and_lets_the_car_rest() -> None:
    for w in (60.0, 100.0, 300.0, 400.0, 1000.0, 2000.0):
        expected = min(DRIVE.regeneration_torque, DRIVE.regeneration_power / w)
        assert at(w, 0.0)["motor_torque"] == pytest.approx(-expected, rel=1e-12)
        assert at(-w, 0.0)["motor_torque"] == pytest.approx(expected, rel=1e-12)
    assert at(0.0, 0.0)["motor_torque"] == 0.0
    assert at(30.0, 0.0)["motor_torque"] == pytest.approx(-60.0 * 0.5 * 0.5 * (3.0 - 0.25))
    assert at(800.0, 0.5)["motor_torque"] == pytest.approx(0.5 * (100e3 - 20e3) / 800.0)


@pytest.mark.parametrize("w", [-700.0, -200.0, -6.0, 6.0, 100.0, 700.0])
@pytest.mark.parametrize("throttle", [0.0, 1.0])
def test_every_power_is_that_of_the_one_before_times_an_efficiency(w: float, throttle: float) -> None:
    out = at(w, throttle)
    shaft, wheels = out["motor_torque"] * w, 2.0 * out["wheel_torque"] * w / DRIVE.ratio
    assert shaft != 0.0
    if shaft > 0.0:
        assert wheels == pytest.approx(shaft * DRIVE.gear_efficiency, rel=1e-12)
        assert out["electric_power"] == pytest.approx(shaft / DRIVE.efficiency, rel=1e-12)
    else:
        assert shaft == pytest.approx(wheels * DRIVE.gear_efficiency, rel=1e-12)
        assert out["electric_power"] == pytest.approx(shaft * DRIVE.efficiency, rel=1e-12)


def settled(element: Element, W: float, throttle: float, selector: float) -> Array:
    """States after a start with the selector there."""
    return element(*drive_signals(W, W), inputs=[throttle, selector], accept=True).y


@pytest.mark.parametrize(("selector", "throttle"), [(None, 0.0), (None, 1.0), (1.0, 0.3), (-1.0, 1.0)])
def test_the_tangent_is_the_derivative_where_torque_falls(selector: float | None, throttle: float) -> None:
    element = drive_element(selector=selector is not None)
    inputs = [throttle, selector or 0.0]
    y = None if selector is None else settled(element, 0.0, throttle, selector)
    fell = 0
    near = np.add.outer(np.concatenate([EDGES, -EDGES]) / DRIVE.ratio, np.linspace(-1.5, 1.5, 4)).ravel()
    for W in np.concatenate([np.linspace(-125.0, 125.0, 21), near]) + 0.0131:
        u, ud = drive_signals(W, W + 0.2)
        r = element(u, ud, y, H, 0.5 * H, 0.0, inputs)
        expected = tangent_by_differences(element, u, ud, y, H, 0.5 * H, 0.0, inputs)
        if expected[0, 0] > 1e-6:
            assert np.max(np.abs(r.S - expected)) < 1e-6 + 1e-6 * np.max(np.abs(expected))
            fell += 1
        else:
            assert not r.S.any()
    assert fell > 3


def course(element: Element, speed: float, selector: list[float], throttle: float = 1.0, h: float = H) -> list[Result]:
    """Results while the selector moves through a list of positions, one per step; the first is that of the start."""
    y, results = settled(element, speed, throttle, selector[0]), []
    for position in selector:
        r = element(*drive_signals(speed, speed), y, h, inputs=[throttle, position], accept=True)
        y = r.y
        results.append(r)
    return results


def test_reverse_is_forwards_seen_from_behind_with_its_own_limits() -> None:
    drive = replace(DRIVE, reverse_torque=1.0, reverse_speed=DRIVE.limit_speed)
    element, plain = drive_element(drive, True), drive_element(drive)
    for W in (-60.0, -3.0, 0.0, 3.0, 7.0):
        y = settled(element, W, 0.6, -1.0)
        back = element(*drive_signals(W, W), y, H, inputs=[0.6, -1.0])
        assert back.out["gear"] == -1.0
        assert np.allclose(back.f, -plain(*drive_signals(-W, -W), inputs=[0.6]).f, rtol=1e-14)
    half = drive_element(selector=True)
    slow = course(half, -10.0, [-1.0])[0].out
    assert slow["motor_torque"] == pytest.approx(-DRIVE.reverse_torque * DRIVE.max_torque)
    assert slow["electric_power"] > 0.0
    assert course(half, -1.06 * DRIVE.reverse_speed / DRIVE.ratio, [-1.0])[0].out["motor_torque"] == 0.0


@pytest.mark.parametrize("selector", [-1.0, 0.0, 1.0])
def test_a_start_is_in_the_selected_direction_at_once_unless_the_car_rolls_against_it(selector: float) -> None:
    for speed in (-30.0, -7.9, 0.0, 7.9, 30.0):
        r = course(drive_element(selector=True), speed, [selector])[0]
        allowed = selector * speed > -DRIVE.engage_speed
        assert r.out["gear"] == (selector if allowed else 0.0)


def test_torque_goes_through_zero_between_directions_without_a_jump_and_at_any_step() -> None:
    switched = []
    for h in (0.02, 0.01, 0.002):
        n = round(1.0 / h)
        results = course(drive_element(selector=True), 3.0, [1.0] * (n // 10) + [-1.0] * n, h=h)
        torques = np.array([DRIVE.max_torque] + [r.out["motor_torque"] for r in results])
        assert torques[1] == pytest.approx(DRIVE.max_torque)
        assert torques[-1] == pytest.approx(-DRIVE.reverse_torque * DRIVE.max_torque)
        assert np.all(np.diff(torques) <= 0.0)
        steepest = 1.5 * DRIVE.max_torque / DRIVE.engage_time  # of the smooth fade
        assert np.max(np.abs(np.diff(torques))) <= 1.01 * steepest * h
        middle = 0.5 * (torques[1:] + torques[:-1])
        switched.append(h * np.sum(middle[: round(0.9 / h)]) / DRIVE.max_torque)
    assert switched[0] == pytest.approx(switched[2], abs=0.003)
    assert switched[1] == pytest.approx(switched[2], abs=0.0015)


def test_reverse_at_speed_is_neutral_until_the_car_is_slow() -> None:
    element = drive_element(selector=True)
    y = settled(element, 40.0, 1.0, 1.0)
    gears, torques, speeds = [], [], np.arange(40.0, 0.0, -0.1)
    for W in speeds:
        r = element(*drive_signals(W, W), y, H, inputs=[1.0, -1.0], accept=True)
        y = r.y
        gears.append(r.out["gear"])
        torques.append(r.out["motor_torque"])
    first = gears.index(-1.0)
    assert speeds[first] == pytest.approx(DRIVE.engage_speed, abs=0.21)
    assert gears[gears.index(0.0) : first] == [0.0] * (first - gears.index(0.0))
    assert set(gears[: gears.index(0.0)]) == {1.0}
    assert torques[first - 1] == 0.0
    assert torques[-1] < 0.0


def test_a_selector_that_comes_back_in_time_takes_the_torque_up_again() -> None:
    results = course(drive_element(selector=True), 5.0, [1.0] * 3 + [0.0] * 10 + [1.0] * 30)
    torques = [r.out["motor_torque"] for r in results]
    assert 0.0 < min(torques) < torques[0] == torques[-1]
    assert {r.out["gear"] for r in results} == {1.0}


def car(m: Model, drive: ElectricDrive, selector: bool = False) -> None:
    """Two wheels on a carrier that may turn about their axis, seen from a train that cannot."""
    carrier = m.body("carrier", mass=10.0, com=(0.0, 0.0, 0.0), inertia=(300.0, CARRIER, 300.0))
    m.revolute("bench", m.ground, carrier, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    spins = [
        m.spin(
            side,
            carrier=carrier,
            centre=(0.0, y, 0.0),
            axis=(0.0, 1.0, 0.0),
            mass=1.0,
            spin_inertia=1.0,
            diametral_inertia=1.0,
        )
        for side, y in (("left", 1.0), ("right", -1.0))
    ]
    for spin in spins:
        m.armature(spin.name, spin, inertia=0.5 * 0.04, ratio=drive.ratio)
    throttle = m.input("throttle", min=0.0, max=1.0)
    lever = m.input("selector", start=1.0, min=-1.0, max=1.0) if selector else None
    up, forward = carrier.vector((0.0, 0.0, 1.0)), carrier.vector((1.0, 0.0, 0.0))
    m.add(
        drive.record(
            "drive",
            spins[0].coordinate,
            spins[1].coordinate,
            up,
            forward,
            throttle.index,
            None if lever is None else lever.index,
        )
    )
    m.sense_coordinate("carrier", m.relative_angle("pitch", m.ground, carrier, axis=(0.0, 1.0, 0.0)), order=1)
    for spin in spins:
        m.sense_coordinate(spin.name, spin, order=1)
    for output in ("electric_power", "motor_torque", "motor_speed", "wheel_torque"):
        m.sense_element(output, "drive", output)


WHEEL = 1.0 + 0.5 * 0.04 * DRIVE.ratio**2
CARRIER = 400.0  # about the axis: the wheels are points on it


def test_a_launch_follows_the_closed_form_and_keeps_angular_momentum() -> None:
    """Constant torque, then constant power on the relative rate W; one half of the reduced inertia for each wheel."""
    drive = replace(DRIVE, limit_speed=5000.0, gear_efficiency=1.0)
    m = Model("launch")
    car(m, drive)
    h = 1e-3
    y = simulate(compile(m), 3.0, h, inputs={"throttle": 1.0})
    spin, carrier = y["left"], y["carrier"]
    assert np.allclose(y["right"], spin, rtol=1e-12)
    assert np.allclose(2.0 * WHEEL * spin + CARRIER * carrier, 0.0, atol=2e-6 * 2.0 * WHEEL * spin[-1])
    reduced = 1.0 / (1.0 / (2.0 * WHEEL) + 1.0 / CARRIER)
    W, t = spin - carrier, y.t
    knee = BASE / drive.ratio
    t_knee = reduced * knee / (drive.ratio * drive.max_torque)
    assert t_knee < 1.0
    exact = np.where(
        t < t_knee,
        knee * t / t_knee,
        np.sqrt(knee**2 + 2.0 * drive.max_power * np.maximum(t - t_knee, 0.0) / reduced),
    )
    assert np.max(np.abs(W - exact)) < 1e-4 * exact[-1]
    kinetic = WHEEL * spin**2 + 0.5 * CARRIER * carrier**2
    electric = np.concatenate([[0.0], np.cumsum(0.5 * h * (y["electric_power"][1:] + y["electric_power"][:-1]))])
    assert kinetic[-1] == pytest.approx(drive.efficiency * electric[-1], rel=1e-4)


def test_regeneration_returns_the_energy_of_the_wheels_and_the_car_comes_to_rest() -> None:
    m = Model("coasting")
    car(m, DRIVE)
    for spin in m.spins:
        m.initial_rate(spin, 60.0)
    h = 1e-3
    y = simulate(compile(m), 20.0, h)
    kinetic = WHEEL * y["left"] ** 2 + 0.5 * CARRIER * y["carrier"] ** 2
    battery = -np.sum(0.5 * h * (y["electric_power"][1:] + y["electric_power"][:-1]))
    both = DRIVE.efficiency * DRIVE.gear_efficiency
    assert battery == pytest.approx(both * (kinetic[0] - kinetic[-1]), rel=2e-3)  # gears lose less below 5 rad/s
    relative = y["left"] - y["carrier"]
    assert abs(relative[-1]) < 1e-3
    assert np.all(np.diff(relative) < 1e-9)


def test_a_selector_in_a_model_drives_forwards_then_backwards() -> None:
    m = Model("shunting")
    car(m, replace(DRIVE, engage_speed=3.0), selector=True)
    lever = {"throttle": 0.3, "selector": lambda t: 1.0 if t < 0.5 else 0.0 if t < 1.0 else -1.0}
    y = simulate(compile(m), 6.0, 0.005, inputs=lever)
    W = y["left"] - y["carrier"]
    t = y.t
    middle = (t > 0.81) & (t < 0.99)
    assert np.ptp(W[middle]) < 1e-9  # neutral: nothing brakes
    assert W[t > 1.0][0] > 3.0
    assert np.allclose(W[t > 1.01], W[middle][0])  # and reverse is refused
    simulation = Simulation(compile(m))
    model = linearise(simulation)
    assert model.slots == ()
