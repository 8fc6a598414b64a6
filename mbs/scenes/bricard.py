"""Bricard's loop (IFToMM benchmark A04): five rods, six revolutes, one degree of freedom, always overconstrained."""

import numpy as np

from mbs.model.model import Model

LENGTH = 1.0  # m
MASS = 1.0  # kg
SECTION = 0.1  # m, side of the square section
POINTS = ((0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1))
AXES = ((0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0))


def build() -> Model:
    """Rods between consecutive joints, the first and the last joint on the ground, gravity along -y, at rest."""
    m = Model("bricard", dimension=3, gravity=(0.0, -9.81, 0.0))
    points = np.array(POINTS, dtype=float) * LENGTH
    axial = MASS * (SECTION**2 + SECTION**2) / 12.0
    transverse = MASS * (LENGTH**2 + SECTION**2) / 12.0
    chain = [m.ground]
    for k in range(5):
        axis = (points[k + 1] - points[k]) / LENGTH
        inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)
        chain.append(m.body(f"rod {k + 1}", mass=MASS, com=0.5 * (points[k] + points[k + 1]), inertia=inertia))
    chain.append(m.ground)
    for k in range(6):
        m.revolute(f"P{k + 1}", chain[k], chain[k + 1], point=points[k], axis=AXES[k])
    for component in "xyz":
        m.sense_position(
            f"P3.position.{component}", chain[2], points[2], component, description=f"position of P3 along {component}"
        )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
