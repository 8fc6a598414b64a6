"""Slider-crank with equal arms: its motion bifurcates when the crank is upright and the rod lies on it.

Then the slider moves on, or stays while both arms rotate together.
"""

from math import cos, radians, sin

from mbs.model.model import Model

LENGTH, MASS = 1.0, 1.0  # m, kg, of crank and rod
SLIDER_MASS = 1.0  # kg
GRAVITY = 9.81  # m/s2
START_ANGLE, START_SPEED = radians(45.0), 4.0  # rad, rad/s, of the crank from the x axis


def build() -> Model:
    """On the branch where the slider moves: rod and crank are mirror images, slider at x = 2 cos(angle)."""
    m = Model("slider-crank with equal arms", dimension=2, gravity=(0.0, -GRAVITY))
    inertia = MASS * LENGTH**2 / 12.0
    c, s = LENGTH * cos(START_ANGLE), LENGTH * sin(START_ANGLE)
    crank = m.body("crank", mass=MASS, com=(0.5 * c, 0.5 * s), inertia=inertia)
    rod = m.body("rod", mass=MASS, com=(1.5 * c, 0.5 * s), inertia=inertia)
    slider = m.point_mass("slider", mass=SLIDER_MASS, position=(2.0 * c, 0.0))
    m.revolute("O", m.ground, crank, point=(0.0, 0.0))
    m.revolute("A", crank, rod, point=(c, s))
    m.spherical("B", rod, slider, point=(2.0 * c, 0.0))
    m.point_on_line("guide", (slider, (2.0 * c, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    m.initial_velocity(crank, linear=(-0.5 * s * START_SPEED, 0.5 * c * START_SPEED), angular=START_SPEED)
    for component in "xy":
        m.sense_position(
            f"A.position.{component}",
            crank,
            (c, s),
            component,
            description=f"position of the crank pin along {component}",
        )
    m.sense_position("slider.position.x", slider, None, "x", description="position of the slider")
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
