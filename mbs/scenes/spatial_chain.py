"""Chain of ten links with pins in two alternating directions: smooth spatial motion in ten degrees of freedom, no loop.

Engines with relative coordinates need the least time for such trees.
"""

import numpy as np

from mbs.common.checks import whole
from mbs.model.model import Model

LINKS = 10
LENGTH, MASS, SECTION = 0.2, 0.5, 0.04  # m, kg, m, of one link with a square section
TILT = 0.5  # rad, of the straight chain from the vertical at the start
SPIN = 1.5  # rad/s, about each of the first two pins at the start


def build(links: int = LINKS) -> Model:
    """Straight, tilted in the x-z plane, swinging about its first pin and, from the second link, sideways too."""
    links = whole(links, "The number of links", 1)
    m = Model(f"chain of {links} links", dimension=3)
    axis, normal, lateral = directions()
    axial, transverse = MASS * SECTION**2 / 6.0, MASS * (LENGTH**2 + SECTION**2) / 12.0
    inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)
    parent = m.ground
    rate = SPIN * lateral
    for k in range(links):
        start = k * LENGTH * axis
        centre = start + 0.5 * LENGTH * axis
        link = m.body(f"link {k}", mass=MASS, com=centre, inertia=inertia)
        m.revolute(f"pin {k}", parent, link, point=start, axis=lateral if k % 2 == 0 else normal)
        # the whole chain rotates about the first pin, all links but the first also about the second pin
        angular_velocity = rate if k == 0 else rate + SPIN * normal
        pivot = np.zeros(3) if k == 0 else LENGTH * axis
        linear = np.cross(rate, pivot) + np.cross(angular_velocity, centre - pivot)
        m.initial_velocity(link, linear=linear, angular=angular_velocity)
        parent = link
    tip = links * LENGTH * axis
    for component in "xyz":
        m.sense_position(
            f"tip.position.{component}", parent, tip, component, description=f"position of the tip along {component}"
        )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m


def directions() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors along the chain at the start, square to it in the x-z plane, and along y."""
    axis = np.array([np.sin(TILT), 0.0, -np.cos(TILT)])
    lateral = np.array([0.0, 1.0, 0.0])
    return axis, np.cross(lateral, axis), lateral
