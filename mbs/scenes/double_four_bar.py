"""N-four-bar mechanism (paper, section 3.1 for N = 2; IFToMM benchmark A02): passes ten singular positions in 10 s."""

from mbs.common.checks import whole
from mbs.model.model import Model

LENGTH = 1.0  # m
MASS = 1.0  # kg
GRAVITY = 9.81  # m/s2
START_SPEED = 1.0  # rad/s, clockwise


def build(windows: int = 2) -> Model:
    """2N+1 uniform links: N+1 cranks on the ground at (i, 0), upright, and N couplers between their tips B0 .. BN.

    Parameters
    ----------
    windows : int
        N.
    """
    windows = whole(windows, "The number of windows", 1)
    name = "double four-bar" if windows == 2 else f"{windows}-four-bar"
    m = Model(name, dimension=2, gravity=(0.0, -GRAVITY))
    inertia = MASS * LENGTH**2 / 12.0
    cranks = []
    for i in range(windows + 1):
        x = i * LENGTH
        crank = m.body(f"crank {i}", mass=MASS, com=(x, 0.5 * LENGTH), inertia=inertia)
        m.revolute(f"A{i}", m.ground, crank, point=(x, 0.0))
        cranks.append(crank)
    for i in range(windows):
        x = i * LENGTH
        coupler = m.body(f"coupler {i}", mass=MASS, com=(x + 0.5 * LENGTH, LENGTH), inertia=inertia)
        m.revolute(f"B{i} left", cranks[i], coupler, point=(x, LENGTH))
        m.revolute(f"B{i + 1} right", cranks[i + 1], coupler, point=(x + LENGTH, LENGTH))
    m.initial_velocity(cranks[0], linear=(0.5 * LENGTH * START_SPEED, 0.0), angular=-START_SPEED)
    tip = (0.0, LENGTH)
    for component in "xy":
        m.sense_position(
            f"B0.position.{component}", cranks[0], tip, component, description=f"position of B0 along {component}"
        )
        m.sense_position(
            f"B0.velocity.{component}",
            cranks[0],
            tip,
            component,
            order=1,
            description=f"velocity of B0 along {component}",
        )
    for kind in ("kinetic", "gravity", "total"):
        m.sense_energy(f"energy.{kind}", kind, description=f"{kind} energy")
    return m
