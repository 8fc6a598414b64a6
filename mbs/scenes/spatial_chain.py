"""A chain of ten links with pins that alternate between two directions: smooth spatial motion in ten degrees of
freedom, without a loop; what tree-coordinate engines are made for.
"""

from __future__ import annotations

import numpy as np

from mbs.common.checks import whole
from mbs.model.model import Model

LINKS = 10
LENGTH, MASS, SECTION = 0.2, 0.5, 0.04  # m, kg, m, of one link with a square section
TILT = 0.5  # rad, of the straight chain from the vertical at the start
SPIN = 1.5  # rad/s, about each of the first two pins at the start


def build(links: int = LINKS) -> Model:
    """Straight, tilted in the x-z plane, swinging about its first pin and, from the second on, sideways too."""
    links = whole(links, "The number of links", 1)
    m = Model(f"chain of {links} links", dimension=3)
    along, square, across = directions()
    axial, transverse = MASS * SECTION**2 / 6.0, MASS * (LENGTH**2 + SECTION**2) / 12.0
    inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(along, along)
    before = m.ground
    rate = SPIN * across
    for k in range(links):
        start = k * LENGTH * along
        centre = start + 0.5 * LENGTH * along
        link = m.body(f"link {k}", mass=MASS, com=centre, inertia=inertia)
        m.revolute(f"pin {k}", before, link, point=start, axis=across if k % 2 == 0 else square)
        # the chain swings as one about its first pin, and its second part sideways about the second
        turn = rate if k == 0 else rate + SPIN * square
        pivot = np.zeros(3) if k == 0 else LENGTH * along
        linear = np.cross(rate, pivot) + np.cross(turn, centre - pivot)
        m.initial_velocity(link, linear=linear, angular=turn)
        before = link
    tip = links * LENGTH * along
    for component in "xyz":
        m.sense_position(
            f"tip.position.{component}", before, tip, component, description=f"position of the tip along {component}"
        )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m


def directions() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors along the chain at the start, square to it in the x-z plane, and along y."""
    along = np.array([np.sin(TILT), 0.0, -np.cos(TILT)])
    across = np.array([0.0, 1.0, 0.0])
    return along, np.cross(across, along), across
