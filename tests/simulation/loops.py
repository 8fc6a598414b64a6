"""Mechanisms with closed loops, for notices on their assembly modes."""

from math import atan2, cos, sin

import numpy as np

from mbs import Model

HARD_POINTS = {
    "lower pivot front": (0.15, 0.30, 0.165),
    "lower pivot rear": (-0.15, 0.30, 0.165),
    "upper pivot front": (0.13, 0.35, 0.372),
    "upper pivot rear": (-0.13, 0.35, 0.372),
    "lower ball": (0.005, 0.60, 0.15),
    "upper ball": (-0.015, 0.575, 0.385),
    "tie rod inner": (-0.1457, 0.3109, 0.21),
    "tie rod outer": (-0.125, 0.572, 0.2032),
}


def suspension(speed: float, sprung: bool = True) -> Model:
    """A double wishbone without stops on a fixed chassis; its upright starts upwards with `speed`, m/s."""
    m = Model("double wishbone")
    p = HARD_POINTS
    lower = m.body("lower wishbone", mass=3.0, com=(0.0, 0.42, 0.16), inertia=(0.03, 0.025, 0.05))
    upper = m.body("upper wishbone", mass=2.0, com=(-0.005, 0.44, 0.377), inertia=(0.012, 0.012, 0.022))
    upright = m.body("upright", mass=24.0, com=(-0.003, 0.64, 0.252), inertia=(0.4, 0.6, 0.4))
    for name, arm in (("lower", lower), ("upper", upper)):
        for end in ("front", "rear"):
            m.spherical(f"{name} {end}", m.ground, arm, point=p[f"{name} pivot {end}"])
        m.spherical(f"{name} ball", arm, upright, point=p[f"{name} ball"])
    m.distance("tie rod", (upright, p["tie rod outer"]), (m.ground, p["tie rod inner"]))
    if sprung:
        ends = (lower, (0.0, 0.5, 0.175)), (m.ground, (0.0, 0.38, 0.785))
        m.spring_damper("spring", *ends, stiffness=12360.0, free_length=0.64, damping=200.0)
    m.initial_velocity(upright, linear=(0.0, 0.0, speed))
    m.sense_position("wheel.z", upright, (-0.003, 0.64, 0.252), "z")
    return m


def four_bar(lengths: tuple[float, float, float, float], crank_angle: float, side: int, speed: float) -> Model:
    """A planar four-bar: ground, crank, coupler, rocker (m), the rocker's pin on one side (1 or -1) of the diagonal."""
    ground, crank, coupler, rocker = lengths
    m = Model("four-bar", dimension=2, gravity=(0.0, 0.0))
    b = crank * np.array([cos(crank_angle), sin(crank_angle)])
    d = np.array([ground, 0.0])
    span = float(np.linalg.norm(d - b))
    along = (coupler**2 - rocker**2 + span**2) / (2.0 * span)
    across = np.sqrt(coupler**2 - along**2)
    u = (d - b) / span
    c = b + along * u + side * across * np.array([-u[1], u[0]])
    bars = [
        m.body(name, mass=1.0, com=0.5 * (np.add(p, q)), inertia=np.linalg.norm(np.subtract(q, p)) ** 2 / 12.0)
        for name, p, q in (("crank", (0, 0), b), ("coupler", b, c), ("rocker", c, d))
    ]
    m.revolute("A", m.ground, bars[0], point=(0.0, 0.0))
    m.revolute("B", bars[0], bars[1], point=b)
    m.revolute("C", bars[1], bars[2], point=c)
    m.revolute("D", bars[2], m.ground, point=d)
    m.initial_velocity(bars[0], linear=0.5 * speed * np.array([-b[1], b[0]]), angular=speed)
    m.sense_position("C.x", bars[1], c, "x")
    m.sense_position("C.y", bars[1], c, "y")
    m.sense_coordinate("crank.angle", m.relative_angle("angle", m.ground, bars[0], zero=atan2(b[1], b[0])))
    return m
