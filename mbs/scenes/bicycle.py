"""Rigid bicycle (IFToMM benchmark library; Meijaard, Papadopoulos, Ruina and Schwab): rear frame with rider, fork, two
wheels as spins. The contact with the road is not part of it: rolling without slip is a condition on velocities that
the rows of a System cannot state; `benchmarks.rolling` adds it for the linear analysis.
"""

from __future__ import annotations

import numpy as np

from mbs.model import Model

WHEELBASE, TRAIL, TILT = 1.02, 0.08, np.pi / 10.0  # m, m, rad
REAR_RADIUS, FRONT_RADIUS = 0.3, 0.35  # m
AXES = {"centre": (0, 0, 0), "x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


def build() -> Model:
    """Upright and straight, rear contact at the origin, x forward, y left, z up, at rest."""
    m = Model("bicycle", dimension=3)
    # products of inertia in axes with z up
    rear = m.body("rear frame", mass=85.0, com=(0.3, 0.0, 0.9), inertia=[[9.2, 0, -2.4], [0, 11.0, 0], [-2.4, 0, 2.8]])
    fork = m.body(
        "fork",
        mass=4.0,
        com=(0.9, 0.0, 0.7),
        inertia=[[0.05892, 0, 0.00756], [0, 0.06, 0], [0.00756, 0, 0.00708]],
    )
    steering_axis = np.array([-np.sin(TILT), 0.0, np.cos(TILT)])
    head = np.array([WHEELBASE + TRAIL, 0.0, 0.0]) + 0.9 * steering_axis
    m.revolute("head", rear, fork, point=head, axis=steering_axis)
    steer = m.relative_angle("steer", rear, fork, axis=steering_axis)
    m.sense_coordinate("steer", steer, description="angle of the fork, positive to the left")
    wheels = (
        ("rear wheel", rear, (0.0, 0.0, REAR_RADIUS), 2.0, 0.0603, 0.12),
        ("front wheel", fork, (WHEELBASE, 0.0, FRONT_RADIUS), 3.0, 0.1405, 0.28),
    )
    for name, carrier, centre, mass, diametral, axial in wheels:
        spin = m.spin(
            name,
            carrier=carrier,
            centre=centre,
            axis=(0, 1, 0),
            mass=mass,
            spin_inertia=axial,
            diametral_inertia=diametral,
            rolling_radius=centre[2],
        )
        m.sense_coordinate(f"{name}.spin", spin, description="its rate is the spin")
        for axis, step in AXES.items():
            for component in "xyz":
                m.sense_position(
                    f"{name}.{axis}.{component}",
                    carrier,
                    np.add(centre, step),
                    component,
                    description=f"{component} of the wheel centre, or of the point 1 m from it along an axis",
                )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
