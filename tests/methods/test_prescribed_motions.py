"""Prescribed motions against closed forms: legs of a hexapod, and a cart whose prescribed speed jumps."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PPoly
from scipy.spatial.transform import Rotation

import mbs

G = 9.81  # m/s2
MASS = 12.0  # kg
INERTIA = np.array([0.35, 0.5, 0.7])  # kg m2
SHIFT, TURN = np.array([0.06, -0.09, 0.08]), np.array([0.2, -0.3, 0.25])  # m, rad
RATES = np.array([3.0, 5.0, 7.0, 4.0, 6.0, 2.5])  # rad/s
HEIGHT = np.array([0.0, 0.0, 0.8])  # m


def _ring(radius, offset, z):
    angles = [math.pi / 3.0 * (leg // 2 * 2) + (offset if leg % 2 else -offset) for leg in range(6)]
    return np.array([(radius * math.cos(a), radius * math.sin(a), z) for a in angles])


BASE, PLATE = _ring(0.8, 0.3, 0.0), _ring(0.4, 0.75, 0.05)  # PLATE from the centre of mass, m


def _motion(t):
    """Place and rotation vector of the plate with their first and second derivatives: shape (3, 6)."""
    size = np.concatenate((SHIFT, TURN)) / 2.0
    c, s = np.cos(RATES * t), np.sin(RATES * t)
    return np.array([size * (1.0 - c), size * RATES * s, size * RATES**2 * c])


def _rotation(t):
    return Rotation.from_rotvec(_motion(t)[0, 3:]).as_matrix()


def _spin(t, d=1e-4):
    rate = (_rotation(t + d) - _rotation(t - d)) / (2.0 * d) @ _rotation(t).T
    return np.array([rate[2, 1], rate[0, 2], rate[1, 0]])


def _legs(t):
    return HEIGHT + _motion(t)[0, :3] + PLATE @ _rotation(t).T - BASE


def _leg_forces(t, d=1e-3):
    """Newton and Euler's equations of the plate, solved for the six forces; positive pushes the ends apart."""
    rotation, spin = _rotation(t), _spin(t)
    inertia = rotation @ np.diag(INERTIA) @ rotation.T
    moment = inertia @ (_spin(t + d) - _spin(t - d)) / (2.0 * d) + np.cross(spin, inertia @ spin)
    along = _legs(t) / np.linalg.norm(_legs(t), axis=1)[:, None]
    wrench = np.vstack((along.T, np.cross(PLATE @ rotation.T, along).T))
    force = MASS * (_motion(t)[2, :3] + np.array([0.0, 0.0, G]))
    return np.linalg.solve(wrench, np.concatenate((force, moment)))


def test_legs_of_a_hexapod_have_the_forces_of_inverse_dynamics():
    m = mbs.Model("hexapod")
    plate = m.body("plate", mass=MASS, com=HEIGHT, inertia=INERTIA)
    times = np.linspace(0.0, 2.0, 401)
    lengths = np.linalg.norm([_legs(t) for t in times], axis=2)
    for leg in range(6):
        guide = m.guide_time(f"length {leg}", CubicSpline(times, lengths[:, leg]), unit="m")
        drive = m.drive(f"leg {leg}", ((m.ground, BASE[leg]), (plate, HEIGHT + PLATE[leg])), guide)
        m.sense_joint(f"force {leg}", drive, "drive", unit="N")
    r = mbs.simulate(mbs.compile(m), 2.0, 0.01, progress=False)
    inner = range(2, len(r.t) - 2, 4)
    expected = np.array([_leg_forces(r.t[i]) for i in inner])
    actual = np.array([[r[f"force {leg}"][i] for leg in range(6)] for i in inner])
    assert np.abs(actual - expected).max() < 1e-3 * np.abs(expected).max()


def test_a_prescribed_speed_that_jumps_gives_the_rest_an_impulse_also_at_the_start():
    """The bob of a cart on a polyline: A w jumps by -M L cos(angle) times the jump of the speed of the cart."""
    times, places, length, mass, inertia = [0.0, 0.5, 1.1, 1.6], [0.0, 0.3, -0.1, 0.2], 0.6, 0.7, 0.03
    speeds = np.diff(places) / np.diff(times)
    way = PPoly(np.array([speeds, places[:-1]]), times)
    m = mbs.Model("cart", dimension=2)
    cart = m.body("cart", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    bob = m.body("bob", mass=mass, com=(0.0, -length), inertia=inertia)
    m.prismatic("rail", m.ground, cart, axis=(1.0, 0.0))
    m.revolute("pin", cart, bob, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, bob)
    m.drive("motor", cart.point((0.0, 0.0))[0], m.guide_time("way", way, unit="m"))
    m.sense_coordinate("angle", angle, unit="rad")
    r = mbs.simulate(mbs.compile(m), times[-1], 0.002, progress=False)
    arm = inertia + mass * length**2
    state, before = np.zeros(2), 0.0
    for start, end, speed in zip(times, times[1:], speeds, strict=False):
        state = state - [0.0, mass * length * math.cos(state[0]) * (speed - before) / arm]
        before = speed
        solution = solve_ivp(
            lambda t, y: [y[1], -mass * G * length * math.sin(y[0]) / arm], (start, end), state, rtol=1e-10, atol=1e-10
        )
        state = solution.y[:, -1]
        assert np.interp(end, r.t, r["angle"]) == pytest.approx(state[0], abs=2e-3)
