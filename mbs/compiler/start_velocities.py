"""Given start velocities, and those that contradict each other through the joints."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.model.body import Body
from mbs.model.model import Model

Array = NDArray[np.float64]

LEAST_WEIGHT = 1e-3
"""Least mass by which a given velocity counts, parts of the mean mass: a light body may carry heavy ones."""
ROUND_OFF = 1e-12
"""Smallest mass of a weight, parts of its largest one: others are none."""
MISSED = 1e-6
"""Largest error of a velocity that is satisfied, parts of the largest velocity in the metric of the mass."""


@dataclass(frozen=True)
class GivenVelocity:
    """Velocity of a centre of mass, angular velocity of a body, or rate of a coordinate."""

    name: str
    unit: str
    coordinates: slice
    """Its full coordinates."""
    weight: Array
    """Mass of the rates of these, shape (n, n), kg."""
    rates: Array
    """Given rates of these, shape (n,)."""
    axes: Array
    """Axes of the body, shape (m, dimension), for an angular velocity; shape (0, n) for the first n rates alone."""

    def energy(self, rates: Array) -> float:
        """Twice the kinetic energy of rates, J."""
        return float(rates @ self.weight @ rates)

    def energy_of_error(self, full: Array) -> float:
        """Twice the kinetic energy of the difference between rates of the full coordinates and the given ones, J."""
        return self.energy(full[self.coordinates] - self.rates)

    def text(self, rates: Array) -> str:
        """Numbers and unit of the velocity with these rates."""
        m, n = self.axes.shape
        moved = rates[n : n + m * n].reshape(m, n) if m else rates[:n]
        if n == 3 and m:
            moved = 0.5 * np.cross(self.axes, moved).sum(axis=0)
        elif m:
            moved = self.axes[:, 0] * moved[:, 1] - self.axes[:, 1] * moved[:, 0]
        return f"{', '.join(f'{v + 0.0:.4g}' for v in moved)} {self.unit}"

    def matrix(self, n: int) -> sparse.csr_matrix:
        """The weight as a matrix over all `n` full coordinates, kg."""
        rows, columns = np.mgrid[self.coordinates, self.coordinates]
        return sparse.csr_matrix((self.weight.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))


def raised_weight(body: Body, linear: bool, angular: bool, least: float) -> Array:
    """`Body.velocity_weight`, raised until its smallest mass, but for modes, is at least `least`, kg."""
    weight = body.velocity_weight(linear, angular)
    masses = np.diag(weight)[:12]
    return weight * max(1.0, least / np.min(masses, initial=np.inf, where=masses > ROUND_OFF * np.max(masses)))


def given_velocities(model: Model, position: Array, mass: float, least: float) -> Iterator[GivenVelocity]:
    """Given velocities of a model.

    `position`: full coordinates; `mass`: mass of coordinates without mass, kg; `least`: see `raised_weight`.
    """
    d, turns = model.dimension, 1 if model.dimension == 2 else 3
    for k, (linear, angular) in model.body_velocities.items():
        body = model.bodies[k]
        coordinates, none = slice(body.start, body.start + body.size), np.zeros((0, d))
        v, w = (np.zeros(n) if x is None else x for x, n in ((linear, d), (angular, turns)))
        rates = body.velocity(v, w, position[coordinates])
        if linear is not None:
            weight = raised_weight(body, True, False, least)
            yield GivenVelocity(f"the velocity of '{body.name}'", "m/s", coordinates, weight, rates, none)
        if angular is not None and not body.is_point:
            axes = position[coordinates][d : 4 if d == 2 else 12].reshape(-1, d)
            weight = raised_weight(body, False, True, least)
            yield GivenVelocity(f"the angular velocity of '{body.name}'", "rad/s", coordinates, weight, rates, axes)
    for i, rate in model.coordinate_rates.items():
        weight = np.array([[max(mass, model.inertias.get(i, 0.0))]])
        name = f"the rate of '{model.coordinates[i].name}'"
        yield GivenVelocity(name, "1/s", slice(i, i + 1), weight, np.array([rate]), np.zeros((0, 1)))


def contradiction(
    model: Model, given: list[GivenVelocity], actual: Array, solve_alone: Callable[[GivenVelocity], Array]
) -> str:
    """A sentence on velocities that the joints allow one by one, but not together; empty if there are none.

    `actual`: rates of the full coordinates; `solve_alone`: returns those with one given velocity only.
    """
    tolerance = MISSED**2 * max((g.energy(g.rates) for g in given), default=0.0)
    missed = sorted(
        (g for g in given if g.energy_of_error(actual) > tolerance), key=lambda g: -g.energy_of_error(actual)
    )
    contradicted = [g for g in missed if g.energy_of_error(solve_alone(g)) <= tolerance] if len(given) > 1 else []
    if not contradicted:
        return ""
    contradictions = "; ".join(
        f"{g.name} is given as {g.text(g.rates)} and is {g.text(actual[g.coordinates])}" for g in contradicted[:2]
    )
    return (
        f"The initial velocities of '{model.name}' contradict each other through its joints: {contradictions}. Each "
        "alone could hold: give one of them, or values that fit."
    )
