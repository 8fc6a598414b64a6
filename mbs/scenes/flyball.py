"""Stiff flyball governor (IFToMM benchmark A05): a spinning shaft, two rods with balls, and a slider on the shaft.

Stiff springs and dampers hold the slider: the fastest eigenvalue is 27000 1/s, the motion takes a second.
"""

from math import cos, pi, radians, sin

import numpy as np

from mbs.model.model import Model

LENGTH, WIDTH = 1.0, 0.01  # m, of shaft and rods
DENSITY = 3000.0  # kg/m3
SLIDER_SIDE = 0.1  # m, cube
BALL = 5.0  # kg
OFFSET = 0.05  # m, of the hinges from the axis
START_ANGLE = radians(30.0)  # of the rods below the horizontal at the start
SLIDER_HEIGHT = 0.5  # m
STIFFNESS, DAMPING, FREE_LENGTH = 8e5, 4e4, 0.5  # N/m, N s/m, m
SPIN = 2.0 * pi  # rad/s


def build() -> Model:
    """The governor, which turns as one rigid body at the start; gravity along -z."""
    m = Model("flyball governor", dimension=3)
    bar = DENSITY * LENGTH * WIDTH**2
    cube = DENSITY * SLIDER_SIDE**3
    axial, transverse = bar * WIDTH**2 / 6.0, bar * (LENGTH**2 + WIDTH**2) / 12.0
    shaft = m.body("shaft", mass=bar, com=(0, 0, 0.5 * LENGTH), inertia=(transverse, transverse, axial))
    m.revolute("bearing", m.ground, shaft, point=(0, 0, 0), axis=(0, 0, 1))
    slider = m.body("slider", mass=cube, com=(0, 0, SLIDER_HEIGHT), inertia=[cube * SLIDER_SIDE**2 / 6.0] * 3)
    m.prismatic("guide", slider, shaft, axis=(0, 0, 1))
    m.initial_velocity(shaft, (0, 0, 0), (0, 0, SPIN))
    m.initial_velocity(slider, (0, 0, 0), (0, 0, SPIN))
    for side, sign in (("right", 1.0), ("left", -1.0)):
        axis = np.array([sign * cos(START_ANGLE), 0.0, -sin(START_ANGLE)])
        hinge = np.array([sign * OFFSET, 0.0, LENGTH])
        middle, end = hinge + 0.5 * LENGTH * axis, hinge + LENGTH * axis
        # rod and ball as one body
        centre = (bar * middle + BALL * end) / (bar + BALL)
        inertia = transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)
        for mass, position in ((bar, middle), (BALL, end)):
            offset = position - centre
            inertia = inertia + mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
        rod = m.body(f"rod {side}", mass=bar + BALL, com=centre, inertia=inertia)
        m.revolute(f"hinge {side}", shaft, rod, point=hinge, axis=(0, 1, 0))
        m.spring_damper(
            f"spring {side}",
            (slider, (sign * OFFSET, 0.0, SLIDER_HEIGHT)),
            (rod, middle),
            stiffness=STIFFNESS,
            damping=DAMPING,
            free_length=FREE_LENGTH,
        )
        m.initial_velocity(rod, linear=np.cross((0, 0, SPIN), centre), angular=(0, 0, SPIN))
    m.sense_position("slider.position.z", slider, None, "z", description="height of the slider")
    m.sense_rotation("shaft.rate", shaft, "z", order=1, description="spin of the shaft")
    m.sense_energy("energy.total", "total", description="kinetic, potential and elastic energy")
    return m
