"""Rigid bicycle (IFToMM benchmark library; Meijaard, Papadopoulos, Ruina and Schwab): rear frame with rider, fork, two
wheels as spins that roll without slip on a level road. Upright it is stable by itself between 4.292 and 6.024 m/s.
"""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from mbs.common.checks import flag, number
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.model import Model

Point: TypeAlias = tuple[float, float, float]

WHEELBASE, TRAIL, TILT = 1.02, 0.08, np.pi / 10.0  # m, m, rad
REAR_RADIUS, FRONT_RADIUS = 0.3, 0.35  # m
SPEED, LEAN_RATE = 4.6, 0.5  # m/s, rad/s: of the second run of the library, over 5 s
AXES = {"centre": (0, 0, 0), "x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


def build(speed: float = SPEED, lean_rate: float = LEAN_RATE, rolling: bool = True) -> Model:
    """Upright and straight, rear contact at the origin, x forward, y left, z up.

    Parameters
    ----------
    speed : float
        m/s, along x.
    lean_rate : float
        rad/s about the line through both contact points, positive to the right.
    rolling : bool
        Whether the wheels roll on the road; without, nothing touches.
    """
    speed = number(speed, "The speed of the bicycle")
    lean_rate = number(lean_rate, "The lean rate of the bicycle")
    rolling = flag(rolling, "The rolling of the bicycle")
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
    for name, carrier, centre, *inertias in wheels:
        spin = _add_wheel(m, name, carrier, centre, inertias, speed, rolling)
        if carrier is rear:
            m.sense_coordinate("speed", spin, order=1, scale=REAR_RADIUS, unit="m/s", description="of the rear contact")
        _sense_axes(m, name, carrier, centre)
    for body in (rear, fork):
        m.initial_velocity(body, linear=(speed, -lean_rate * body.com[2], 0.0), angular=(lean_rate, 0.0, 0.0))
    m.sense_angle("lean", rear, "roll", description="roll of the rear frame, positive to the right")
    m.sense_coordinate("lean.sine", rear.vector((0.0, 1.0, 0.0))[2], unit="1", description="z of the rear axle, unit")
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    m.stop_time, m.step = 5.0, 0.01
    return m


def _add_wheel(
    m: Model, name: str, carrier: Body, centre: Point, inertias: Sequence[float], speed: float, rolling: bool
) -> Spin:
    """Add a wheel. `centre`: m; its height is the radius; `inertias`: mass, kg, diametral and axial inertia, kg m2."""
    mass, diametral, axial = inertias
    radius = centre[2]
    spin = m.spin(
        name,
        carrier=carrier,
        centre=centre,
        axis=(0, 1, 0),
        mass=mass,
        spin_inertia=axial,
        diametral_inertia=diametral,
        rolling_radius=radius,
    )
    if rolling:
        m.rolling(f"{name} on road", spin, radius=radius)
    m.initial_rate(spin, speed / radius)
    m.sense_coordinate(f"{name}.spin", spin, description="its rate is the spin")
    return spin


def _sense_axes(m: Model, name: str, carrier: Body, centre: Point) -> None:
    """Add sensors of the centre of a wheel and of points on the axes of its carrier."""
    text = "{} of the wheel centre, or of the point 1 m from it along an axis"
    for axis, offset in AXES.items():
        for c in "xyz":
            column = f"{name}.{axis}.{c}"
            m.sense_position(column, carrier, np.add(centre, offset), c, description=text.format(c))
