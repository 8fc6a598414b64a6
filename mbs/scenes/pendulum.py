"""Planar pendulum (IFToMM benchmark A01): a point mass on a massless rod."""

from mbs.common.checks import positive
from mbs.model.model import Model


def build(length: float = 1.0, mass: float = 1.0) -> Model:
    """A particle at (-length, 0) that hangs on the origin by a massless rod and starts at rest.

    Parameters
    ----------
    length : float
        m.
    mass : float
        kg.
    """
    length, mass = positive(length, "The length of the pendulum"), positive(mass, "The mass of the pendulum")
    m = Model("pendulum", dimension=2, gravity=(0.0, -9.81))
    bob = m.point_mass("bob", mass=mass, position=(-length, 0.0))
    rod = m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    for component in "xy":
        m.sense_position(
            f"bob.position.{component}", bob, None, component, description=f"position of the mass along {component}"
        )
        m.sense_position(
            f"bob.velocity.{component}",
            bob,
            None,
            component,
            order=1,
            description=f"velocity of the mass along {component}",
        )
    m.sense_joint("rod.tension", rod, "tension", description="force in the rod, positive in tension")
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
