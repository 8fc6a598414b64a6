"""Skates and rolling discs with closed forms."""

import numpy as np

from benchmarks.methods.kernel_methods import POSITIONS_ONLY, TREE_ONLY
from mbs import Model
from mbs.settings.settings import METHODS

ROLLING = [method for method in METHODS if method not in (*TREE_ONLY, *POSITIONS_ONLY)]  # the others refuse them

GRAVITY = 9.81
MASS = 2.0  # kg, of the disc
RADIUS = 0.5  # m
DIAMETRAL = 0.15  # kg m2: a disc of some thickness
AXIAL = 0.25  # kg m2
AXLE_MASS = 0.1  # kg, of what carries it as a spin
AXLE_INERTIA = 0.02  # kg m2
SLEIGH_MASS = 2.0  # kg
SLEIGH_INERTIA = 0.5  # kg m2
ARM = 0.3  # m
TURN = 1.0  # rad/s
ROLY_MASS = 3.0  # kg
ROLY_INERTIA = 0.2  # kg m2
ROLY_RADIUS = 0.4  # m
ROLY_DEPTH = 0.1  # m


def sleigh(turn: float = TURN, switch: bool | None = None, drift: float = 0.0) -> Model:
    """Chaplygin's sleigh: a body on a knife edge ARM behind its centre of mass, that turns about the edge at first."""
    m = Model("sleigh", dimension=2, gravity=(0.0, 0.0))
    body = m.body("sleigh", mass=SLEIGH_MASS, com=(ARM, 0.0), inertia=SLEIGH_INERTIA)
    m.skate("edge", body, point=(0.0, 0.0), direction=(1.0, 0.0), switch=switch)
    m.initial_velocity(body, linear=(0.0, ARM * turn + drift), angular=turn)
    m.sense_angle("yaw", body, "yaw")
    for c in "xy":
        m.sense_position(f"edge.{c}", body, (0.0, 0.0), c)
        m.sense_position(f"edge.v{c}", body, (0.0, 0.0), c, order=1, axes=body)
    m.sense_rotation("turn", body, order=1)
    m.sense_energy("energy", "total")
    return m


def disc(lean: float, precession: float, spin: float, kick: float = 0.0, reduced: bool = False) -> Model:
    """A disc with a knife edge on the plane, its centre above the origin and heading along x.

    `lean`: in rad, to the right; `precession`, `spin`, `kick`: rad/s: rate of the plane of the disc along its steepest
    line, about the axle and about the heading; `reduced`: as a spin on an axle that does not turn about itself.
    """
    s, n_z = np.cos(lean), np.sin(lean)
    axle, up, heading = np.array([0.0, s, n_z]), np.array([0.0, -n_z, s]), np.array([1.0, 0.0, 0.0])
    turning = precession * s * up + kick * heading
    centre = np.array([0.0, 0.0, RADIUS * s])
    speed = np.cross(turning + spin * axle, RADIUS * up)
    m = Model("disc")
    if reduced:
        body = m.body("axle", mass=AXLE_MASS, com=centre, inertia=[AXLE_INERTIA] * 3)
        wheel = m.spin(
            "wheel",
            carrier=body,
            centre=centre,
            axis=axle,
            mass=MASS - AXLE_MASS,
            spin_inertia=AXIAL,
            diametral_inertia=DIAMETRAL - AXLE_INERTIA,
        )
        m.rolling("rim", wheel, radius=RADIUS)
        m.initial_rate(wheel, spin)
        m.initial_velocity(body, linear=speed, angular=turning)
    else:
        inertia = DIAMETRAL * np.eye(3) + (AXIAL - DIAMETRAL) * np.outer(axle, axle)
        body = m.body("disc", mass=MASS, com=centre, inertia=inertia)
        m.rolling("rim", body, radius=RADIUS, centre=centre, axis=axle)
        m.initial_velocity(body, linear=speed, angular=turning + spin * axle)
    for c in "xyz":
        m.sense_position(f"centre.{c}", body, centre, c)
    m.sense_coordinate("axle.z", body.vector(axle)[2])
    m.sense_energy("energy", "total")
    return m


def roly_poly(rate: float, turn: float = 0.0) -> Model:
    """A body with two wheels on one axle, its centre of mass below it, turned about the axle (rad) and rolling (rad/s).

    Both wheels say that the axle does not move along itself: one condition too many, everywhere.
    """
    m = Model("roly-poly")
    com = (ROLY_DEPTH * np.sin(turn), 0.0, ROLY_RADIUS - ROLY_DEPTH * np.cos(turn))
    body = m.body("body", mass=ROLY_MASS, com=com, inertia=(0.5, ROLY_INERTIA, 0.5))
    for name, y in (("left", 0.5), ("right", -0.5)):
        m.rolling(name, body, radius=ROLY_RADIUS, centre=(0.0, y, ROLY_RADIUS), axis=(0.0, 1.0, 0.0))
    angular = np.array([0.0, rate, 0.0])
    m.initial_velocity(body, linear=np.cross(angular, com), angular=angular)
    m.sense_angle("pitch", body, "pitch")
    m.sense_position("height", body, None, "z")
    m.sense_energy("energy", "total")
    return m
