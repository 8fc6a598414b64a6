"""Mass properties of a link in a URDF file, with factors that undo mistakes of units."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mbs.urdf.source import INERTIA, Element

MIN_SECOND_MOMENT = 0.01
"""Least second moment of mass of a link, relative to the largest: a plate has a thickness."""
SOLID_DENSITY = 1000.0  # kg/m3


class Factors(NamedTuple):
    """Factors on groups of numbers of the file that undo a mistake."""

    lengths: float = 1.0
    masses: float = 1.0
    inertias: float = 1.0
    limits: float = 1.0
    angles: float = 1.0
    centres: float = 1.0
    """Factor on origins of inertias, in addition to `lengths`."""
    efforts: float = 1.0
    speeds: float = 1.0
    solid: bool = False
    """Whether placeholder inertias of 1, 0.1, ... kg m2 about all axes are replaced by the inertia of a ball of
    `SOLID_DENSITY`."""
    only: str = ""
    """Name of the only link to which the factors apply; empty: all links."""

    def of(self, name: str) -> Factors:
        """Factors that apply to a link."""
        return self if self.only in ("", name) else Factors()


class LinkMass(NamedTuple):
    """Mass properties of a link."""

    mass: float
    centre: NDArray[np.float64]
    """Centre of mass in the frame of the link, m, shape (3,)."""
    inertia: NDArray[np.float64]
    """Shape (3, 3), kg m2."""
    line: int

    @property
    def moment(self) -> float:
        """Largest principal moment of inertia, kg m2."""
        return float(np.linalg.eigvalsh(self.inertia)[-1])

    @property
    def density(self) -> float:
        """Density of the homogeneous ellipsoid with this mass and inertia, kg/m3; 0 without inertia."""
        second_moments = 0.5 * np.trace(self.inertia) - np.linalg.eigvalsh(self.inertia)
        if not max(second_moments) > 0.0:
            return 0.0
        axes = np.sqrt(5.0 * np.maximum(second_moments, MIN_SECOND_MOMENT * max(second_moments)) / self.mass)
        return float(self.mass / (4.0 / 3.0 * math.pi * np.prod(axes)))


def link_mass(link: Element, factors: Factors) -> LinkMass:
    """Mass, centre of mass and inertia of a link, times the factors; 0 without an element `inertial`."""
    inertial = link.first("inertial")
    if inertial is None:
        return LinkMass(0.0, np.zeros(3), np.zeros((3, 3)), link.line)
    mass, origin, inertia = (inertial.first(tag) for tag in ("mass", "origin", "inertia"))
    centre = np.zeros(3) if origin is None else factors.lengths * factors.centres * np.array(origin.numbers("xyz"))
    mass_value = 0.0 if mass is None else factors.masses * mass.numbers("value")[0]
    upper = np.zeros((3, 3))
    if inertia is not None:
        upper[np.triu_indices(3)] = [factors.inertias * inertia.numbers(name)[0] for name in INERTIA]
    tensor = upper + np.triu(upper, 1).T
    if factors.solid and _is_placeholder(tensor):
        tensor = _ball_inertia(mass_value)
    return LinkMass(mass_value, centre, tensor, inertial.line)


def _is_placeholder(inertia: NDArray[np.float64]) -> bool:
    """Whether an inertia is the same power of ten about all axes."""
    moment = inertia[0, 0]
    return bool(moment > 0.0 and abs(math.log10(moment) % 1.0) < 1e-9 and np.all(inertia == moment * np.eye(3)))


def _ball_inertia(mass: float) -> NDArray[np.float64]:
    """Inertia of a ball of `SOLID_DENSITY`, kg m2, shape (3, 3)."""
    radius_squared = (mass / (4.0 / 3.0 * math.pi * SOLID_DENSITY)) ** (2.0 / 3.0)
    return np.asarray(0.4 * mass * radius_squared * np.eye(3))
