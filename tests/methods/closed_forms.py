"""Mechanisms whose motion, accelerations and forces follow from one equation in one angle, and that equation solved to
thirteen digits: what every reported quantity is held against.

`rod`: a rod that swings on a hinge. `arm`: a rod that hangs from an arm whose angle a driving function prescribes, so
that positions depend on the method and the torque of the drive on everything. `chirp`: the rod with a motor whose
torque is a function of time. Joint forces are those on the rod.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

from mbs import Model

MASS = 2.0  # kg
INERTIA = 0.17  # kg m2
CENTRE = 0.5  # m
LENGTH = 1.0  # m
GRAVITY = 9.81  # m/s2
ARM_MASS = 1.5  # kg
ARM_INERTIA = 0.2  # kg m2
ARM_CENTRE = 0.4  # m
ARM = 0.8  # m
SPIN = 6.0  # rad/s, at the start, where the rod hangs
QUANTITIES = {
    "position": ("tip.x", "tip.y"),
    "velocity": ("tip.vx", "tip.vy"),
    "acceleration": ("tip.ax", "tip.ay"),
    "joint force": ("force.x", "force.y"),
    "drive torque": ("torque",),
}


@dataclass(frozen=True)
class Mechanism:
    """A model, the end of its run in s, its inputs and its sensors (n, k) at times (n,) in order of `QUANTITIES`."""

    model: Model
    end: float
    inputs: dict[str, Callable[[float], float]]
    exact: Callable[[np.ndarray], dict[str, np.ndarray]]


def _sensors(m, rod, tip):
    for c in "xy":
        m.sense_position(f"tip.{c}", rod, tip, c)
        m.sense_position(f"tip.v{c}", rod, tip, c, order=1)
        m.sense_position(f"tip.a{c}", rod, tip, c, order=2)
        m.sense_joint(f"force.{c}", "hinge", c)


def _solve(acceleration, start, t):
    """Angle, rate and acceleration (n,) at times (n,)."""
    solution = solve_ivp(
        lambda time, x: [x[1], acceleration(time, *x)],
        (0.0, float(t[-1])),
        start,
        method="DOP853",
        t_eval=t,
        rtol=3e-14,
        atol=1e-14,
        max_step=0.01,
    ).y
    return solution[0], solution[1], np.array([acceleration(*x) for x in zip(t, *solution, strict=True)])


def _along(angle, rate, turn, length):
    """Place, velocity and acceleration (n, 2) of a point at `length` below a hinge, angle from hanging."""
    out, down = np.array([np.cos(angle), np.sin(angle)]), np.array([np.sin(angle), -np.cos(angle)])
    return length * down.T, length * (rate * out).T, length * (turn * out - rate**2 * down).T


def _named(place, velocity, acceleration, force, torque=None):
    columns = (place, velocity, acceleration, force, torque)
    return {name: c for name, c in zip(QUANTITIES, columns, strict=True) if c is not None}


def rod(torque=None) -> Mechanism:
    """The rod, with a motor where a torque is given, N m over s."""
    m = Model("rod", dimension=2)
    body = m.body("rod", mass=MASS, com=(0.0, -CENTRE), inertia=INERTIA)
    m.revolute("hinge", body, m.ground, point=(0.0, 0.0))
    m.initial_velocity(body, linear=(SPIN * CENTRE, 0.0), angular=SPIN)
    inputs = {}
    if torque is not None:
        m.torque("motor", body, inputs=m.input("motor", unit="N.m"))
        inputs = {"motor": torque}
    _sensors(m, body, (0.0, -LENGTH))
    about = INERTIA + MASS * CENTRE**2

    def exact(t):
        u = torque or (lambda _: 0.0)
        motion = _solve(lambda time, a, w: (u(time) - MASS * GRAVITY * CENTRE * sin(a)) / about, [0.0, SPIN], t)
        force = MASS * (_along(*motion, CENTRE)[2] + [0.0, GRAVITY])
        return _named(*_along(*motion, LENGTH), force)

    return Mechanism(m, 1.0, inputs, exact)


def chirp() -> Mechanism:
    """The rod under a torque whose frequency rises from 1 to 9 Hz."""
    return rod(lambda t: 5.0 * sin(2.0 * pi * (1.0 + 4.0 * t) * t))


def arm() -> Mechanism:
    """The arm points along x at first and turns by a radian within a second; the run ends at 0.8 s."""
    m = Model("arm", dimension=2)
    first = m.body("arm", mass=ARM_MASS, com=(ARM_CENTRE, 0.0), inertia=ARM_INERTIA)
    second = m.body("rod", mass=MASS, com=(ARM, -CENTRE), inertia=INERTIA)
    m.revolute("bearing", first, m.ground, point=(0.0, 0.0))
    m.revolute("hinge", second, first, point=(ARM, 0.0))
    m.initial_velocity(second, linear=(SPIN * CENTRE, 0.0), angular=SPIN)
    angle = m.relative_angle("angle", m.ground, first)
    rise = PPoly(np.array([[6.0], [-15.0], [10.0], [0.0], [0.0], [0.0]]), np.array([0.0, 1.0]))
    m.drive("motor", angle, m.guide_time("rise", rise, unit="rad"))
    _sensors(m, second, (ARM, -LENGTH))
    m.sense_joint("torque", "motor", "drive", unit="N.m")
    about = INERTIA + MASS * CENTRE**2

    def end_of_arm(t):
        a, w, e = rise(t), rise(t, 1), rise(t, 2)
        c, s = np.cos(a), np.sin(a)
        return (
            ARM * np.array([c, s]),
            ARM * w * np.array([-s, c]),
            ARM * np.array([-e * s - w * w * c, e * c - w * w * s]),
        )

    def exact(t):
        def rates(time, b, w):
            ax, ay = end_of_arm(time)[2]
            return -MASS * CENTRE * (ax * cos(b) + (ay + GRAVITY) * sin(b)) / about

        motion = _solve(rates, [0.0, SPIN], t)
        base = [x.T for x in end_of_arm(t)]
        tip = [a + b for a, b in zip(base, _along(*motion, LENGTH), strict=True)]
        force = MASS * (base[2] + _along(*motion, CENTRE)[2] + [0.0, GRAVITY])
        a, e = rise(t), rise(t, 2)
        torque = (ARM_INERTIA + ARM_MASS * ARM_CENTRE**2) * e + ARM_MASS * GRAVITY * ARM_CENTRE * np.cos(a)
        torque = torque + base[0][:, 0] * force[:, 1] - base[0][:, 1] * force[:, 0]
        return _named(*tip, force, torque[:, None])

    return Mechanism(m, 0.8, {}, exact)
