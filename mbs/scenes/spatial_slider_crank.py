"""Spatial rigid slider-crank (IFToMM benchmark library): a crank turns about x beside the line of the slider."""

import numpy as np

from mbs.model.model import Model

PIVOT = (0.0, 0.1, 0.12)  # m
CRANK, ROD = 0.08, 0.3  # m
SLIDER_X = 0.2  # m, at the start: 0.2^2 + 0.1^2 + 0.2^2 = 0.3^2
MASSES = (0.12, 0.5, 2.0)  # kg, crank, rod, slider
CRANK_INERTIA = (1e-4, 1e-4, 1e-5)  # kg m2, z along the crank
ROD_AXIAL, ROD_TRANSVERSE = 4e-4, 4e-3  # kg m2
SLIDER_INERTIA = 1e-4  # kg m2
SPEED = 6.0  # rad/s


def build() -> Model:
    """Crank upright, 6 rad/s about x: the slider moves at 0.24 m/s; gravity along -z."""
    m = Model("spatial slider-crank", dimension=3)
    pin = (PIVOT[0], PIVOT[1], PIVOT[2] + CRANK)
    start = (SLIDER_X, 0.0, 0.0)
    rod_axis = (np.array(pin) - np.array(start)) / ROD
    crank = m.body("crank", mass=MASSES[0], com=(PIVOT[0], PIVOT[1], PIVOT[2] + 0.5 * CRANK), inertia=CRANK_INERTIA)
    rod = m.body(
        "rod",
        mass=MASSES[1],
        com=0.5 * (np.array(pin) + np.array(start)),
        inertia=ROD_TRANSVERSE * np.eye(3) + (ROD_AXIAL - ROD_TRANSVERSE) * np.outer(rod_axis, rod_axis),
    )
    slider = m.body("slider", mass=MASSES[2], com=start, inertia=[SLIDER_INERTIA] * 3)
    m.revolute("A", m.ground, crank, point=PIVOT, axis=(1, 0, 0))
    m.spherical("B", crank, rod, point=pin)
    # the pin of the rod is perpendicular to the rod and to the vertical pin of the slider
    rod_pin = np.cross((0.0, 0.0, 1.0), rod_axis)
    m.universal("C", rod, slider, point=start, axis_1=rod_pin, axis_2=(0, 0, 1))
    m.prismatic("guide", slider, m.ground, axis=(1, 0, 0))
    m.initial_velocity(crank, linear=(0.0, -0.5 * CRANK * SPEED, 0.0), angular=(SPEED, 0.0, 0.0))
    for component in "yz":
        m.sense_position(
            f"B.position.{component}", crank, pin, component, description=f"position of the crank pin along {component}"
        )
    m.sense_position("slider.position.x", slider, None, "x", description="position of the slider")
    m.sense_position("slider.velocity.x", slider, None, "x", order=1, description="velocity of the slider")
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
