"""A published tyre on a rig: forces of both tyre models of the engine against a published formula.

The tyre is the Michelin MXV8 with coefficients of the early Magic Formula from the repository
n-jokic/Vehicle_MPC_control, src/simulink/pacajeka_init.m. With the load in kN, the slip angle in degrees and the slip
in percent:

    D = a1 Fz^2 + a2 Fz, BCD = a3 sin(a4 atan(a5 Fz)), E = a6 Fz^2 + a7 Fz + a8, C = a0 (lateral)
    D = b1 Fz^2 + b2 Fz, BCD = (b3 Fz^2 + b4 Fz) exp(-b5 Fz), E = b6 Fz^2 + b7 Fz + b8, C = b0 (longitudinal)
"""

from collections.abc import Sequence
from math import atan, cos, degrees, exp, pi, sin

import numpy as np

from benchmarks.validation.published_figures import Published
from mbs import Model, compile, simulate
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.road import PlaneRoad
from mbs.elements.tyre import Tyre
from mbs.tyre_files.fit_tmeasy import tmeasy_of_magic

LATERAL = (1.30, -22.1, 1011.0, 1078.0, 1.82, 0.208, 0.0, -0.354, 0.707)
LONGITUDINAL = (1.65, -21.3, 1144.0, 49.6, 226.0, 0.069, -0.006, 0.056, 0.486)
LAST_DIGITS = (
    (0.01, 0.1, 1.0, 1.0, 0.01, 0.001, 0.001, 0.001, 0.001),
    (0.01, 0.1, 1.0, 0.1, 1.0, 0.001, 0.001, 0.001, 0.001),
)
SOURCE = "n-jokic/Vehicle_MPC_control"
NOMINAL = 4000.0  # N
LOADS = (2000.0, 6000.0)  # N: TMeasy is fitted at 4 and 8 kN
ANGLES = (2.0, 8.0)  # deg
SLIPS = (-5.0, -15.0)  # %
SPEED = 20.0  # m/s; the formula does not depend on it
RADIUS = 0.30  # m
STIFFNESS = 200e3  # N/m
_SLED = 1e9  # kg, so that forces do not change its speed
_SETTLED = 1.0  # s, duration
_STEP = 0.002  # s


def published(coefficients: Sequence[float], lateral: bool, load: float, slip: float) -> float:
    """Force of the published formula, N, with the sign of the slip. `load`: N; `slip`: deg or %."""
    c, a1, a2, a3, a4, a5, a6, a7, a8 = coefficients
    q = 1e-3 * load
    most = a1 * q * q + a2 * q
    slope = a3 * sin(a4 * atan(a5 * q)) if lateral else (a3 * q * q + a4 * q) * exp(-a5 * q)
    bend, x = a6 * q * q + a7 * q + a8, slope / (c * most) * slip
    return most * sin(c * atan(x - bend * (x - atan(x))))


def read_within(lateral: bool, load: float, slip: float) -> float:
    """Largest change of the force by half a unit of the last digit of each coefficient, N."""
    of, digits = (LATERAL, LAST_DIGITS[0]) if lateral else (LONGITUDINAL, LAST_DIGITS[1])
    nominal = published(of, lateral, load, slip)
    changed = ([*of[:k], of[k] + 0.5 * digits[k], *of[k + 1 :]] for k in range(len(of)))
    return sum(abs(published(each, lateral, load, slip) - nominal) for each in changed)


def magic() -> MagicTyre:
    """The published formula with the coefficients of a tyre property file, to which it can be converted exactly."""
    _, a1, a2, a3, a4, a5, _, a7, a8 = LATERAL
    _, b1, b2, b3, b4, b5, b6, b7, b8 = LONGITUDINAL
    q = 1e-3 * NOMINAL
    at = exp(-b5 * q)
    coefficients = {
        "PCY1": LATERAL[0],
        "PDY1": 1e-3 * (a1 * q + a2),
        "PDY2": 1e-3 * a1 * q,
        "PEY1": a7 * q + a8,
        "PEY2": a7 * q,
        "PKY1": -degrees(a3) / NOMINAL,
        "PKY2": 1.0 / (a5 * q),
        "PKY4": a4,
        "PCX1": LONGITUDINAL[0],
        "PDX1": 1e-3 * (b1 * q + b2),
        "PDX2": 1e-3 * b1 * q,
        "PEX1": b6 * q * q + b7 * q + b8,
        "PEX2": 2.0 * b6 * q * q + b7 * q,
        "PEX3": b6 * q * q,
        "PKX1": 0.1 * (b3 * q + b4) * at,
        "PKX2": 0.1 * b3 * q * at,
        "PKX3": -b5 * q,
    }
    coefficients |= {"PTX1": 1.0, "PTY1": 1.0, "PTY2": 2.0}
    return MagicTyre(
        "MF52", coefficients, RADIUS, 0.15, STIFFNESS, NOMINAL, damping=500.0, combination="none", largest_load=8000.0
    )


def rig_forces(tyre: MagicTyre | Tyre, load: float, angle: float = 0.0, slip: float = 0.0) -> tuple[float, float]:
    """Steady forces of a wheel on a heavy sled.

    `load`: N; `angle`: direction of the sled to the right of the wheel's heading, deg; `slip`: longitudinal, % of the
    speed along the wheel, positive when driven. Returns `longitudinal` and `lateral`: forces of the road along the
    wheel's heading and to its left, N.
    """
    height = RADIUS - load / STIFFNESS
    rolling = (2.0 * RADIUS + height) / 3.0  # of both models for a tyre without its own rolling radius
    direction = np.array([cos(angle * pi / 180.0), -sin(angle * pi / 180.0), 0.0])
    m = Model("tyre rig")
    centre = (0.0, 0.0, height)
    sled = m.body("sled", mass=_SLED, com=centre, inertia=(1.0, 1.0, 1.0))
    m.prismatic("track", m.ground, sled, axis=direction)
    hub = m.body("hub", mass=load / 9.81 - 1.0, com=centre, inertia=(1.0, 1.0, 1.0))
    m.prismatic("slide", sled, hub, axis=(0.0, 0.0, 1.0))
    inertia = 1e6 if slip else 0.1
    wheel = m.spin(
        "wheel", carrier=hub, centre=centre, axis=(0.0, 1.0, 0.0), mass=1.0,
        spin_inertia=inertia, diametral_inertia=0.6 * inertia,
    )  # fmt: skip
    road = m.road(PlaneRoad(friction=1.0))
    element = m.add(tyre.record("tyre", wheel.centre, wheel.axis, wheel.coordinate, road))
    m.initial_velocity(sled, SPEED * direction)
    m.initial_velocity(hub, SPEED * direction)
    m.initial_rate(wheel, (1.0 + 0.01 * slip) * SPEED * direction[0] / rolling)
    for name in ("longitudinal_force", "lateral_force", "vertical_force"):
        m.sense_element(name, element, name)
    run = simulate(compile(m), _SETTLED, _STEP)
    assert abs(run["vertical_force"][-1] / load - 1.0) < 1e-4, run["vertical_force"][-1]
    return float(run["longitudinal_force"][-1]), float(run["lateral_force"][-1])


def compared() -> list[tuple[Published, float]]:
    """Published forces, each with the force of the rig, for both tyre models of the engine."""
    own = magic()
    results = []
    for name, tyre in (("Magic Formula", own), ("TMeasy, fitted at 4 and 8 kN", tmeasy_of_magic(own)[0])):
        for load in LOADS:
            for lateral, at in [*((True, angle) for angle in ANGLES), *((False, slip) for slip in SLIPS)]:
                force = published(LATERAL if lateral else LONGITUDINAL, lateral, load, at)
                forces = rig_forces(tyre, load, angle=at) if lateral else rig_forces(tyre, load, slip=at)
                label = f"side force at {at:g} deg" if lateral else f"force along at {at:g} % slip"
                test = f"tyre MXV8 on the rig, {name}: {label}, {1e-3 * load:g} kN"
                results.append((Published(test, "N", {SOURCE: force}, read_within(lateral, load, at)), forces[lateral]))
    return results
