"""Chains of point masses on rods, which swing chaotically, with their exact motion in angles."""

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import mbs
from benchmarks.references.newton_euler import INSTANTS

Array = NDArray[np.float64]
GRAVITY = 9.81  # m/s^2


def random_pendulum(rng: np.random.Generator) -> tuple[mbs.System, dict[str, Array], float]:
    """Two or three rods that start at rest, high enough to turn over.

    Result: the System, the coordinates of the masses at equal instants by sensor, m, and the duration, s.
    """
    n = int(rng.choice([2, 3]))
    masses, lengths = 10.0 ** rng.uniform(-0.3, 0.3, n), rng.uniform(0.5, 1.0, n)
    angles = rng.uniform(1.2, 3.0, n) * rng.choice([-1.0, 1.0], n)  # rad, from the lower vertical
    span = float(round(rng.uniform(4.0, 9.0), 1))
    positions = _positions(_angles(masses, lengths, angles, span), lengths)
    m = mbs.Model("pendulum", dimension=2, gravity=(0.0, -GRAVITY))
    previous, joint = m.ground, (0.0, 0.0)
    for k, place in enumerate(_positions(angles[:, None], lengths)[:, :, 0]):
        mass = m.point_mass(f"mass{k}", mass=masses[k], position=tuple(place))
        m.distance(f"rod{k}", (previous, joint), (mass, tuple(place)))
        for c in "xy":
            m.sense_position(f"mass{k}.{c}", mass, None, c)
        previous, joint = mass, tuple(place)
    names = [f"mass{k}.{c}" for k in range(n) for c in "xy"]
    return mbs.compile(m), dict(zip(names, positions.reshape(2 * n, -1), strict=True)), span


def _positions(angles: Array, lengths: Array) -> Array:
    """Coordinates of the masses, shape (n, 2, times), m, from the angles of the rods, shape (n, times)."""
    rods = lengths[:, None, None] * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
    return np.asarray(np.cumsum(rods, axis=0))


def _angles(masses: Array, lengths: Array, start: Array, span: float) -> Array:
    """Angles, shape (n, times), by Lagrange's equations, integrated to 1e-13."""
    n = len(masses)
    carried = np.array([[masses[max(i, j) :].sum() for j in range(n)] for i in range(n)]) * np.outer(lengths, lengths)
    weight = GRAVITY * lengths * np.array([masses[i:].sum() for i in range(n)])

    def rates(_: float, y: Array) -> Array:
        turn = y[:n, None] - y[None, :n]
        force = -(carried * np.sin(turn)) @ y[n:] ** 2 - weight * np.sin(y[:n])
        return np.concatenate([y[n:], np.linalg.solve(carried * np.cos(turn), force)])

    instants = np.linspace(0.0, span, INSTANTS + 1)
    start = np.concatenate([start, np.zeros(n)])
    return np.asarray(
        solve_ivp(rates, (0.0, span), start, t_eval=instants, method="DOP853", rtol=1e-13, atol=1e-13).y[:n]
    )
