"""TMeasy's steady forces as the publications write them, independent of the kernel.

W. Hirschberg, G. Rill, H. Weinfurter, "Tire model TMeasy", Vehicle System Dynamics 45(S1), 2007, 101-119: slips over
the transport speed, curves by parts, generalised slip, influence of load and friction, dynamic tyre offset. The same
equations are in G. Rill, "Road Vehicle Dynamics", CRC Press, 2012, chapter 3.
"""

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

from mbs.elements import Tyre


@dataclass(frozen=True)
class Direction:
    """The five parameters of one direction at one load and friction."""

    dF0: float
    FM: float
    sM: float
    FS: float
    sS: float


def quadratic(pair: tuple[float, float], q: float) -> float:
    """Y(Fz) = q (2 Y1 - Y2/2 - (Y1 - Y2/2) q): nought at no load, Y1 at the nominal load, Y2 at twice of it."""
    y1, y2 = pair
    return q * (2.0 * y1 - 0.5 * y2 - (y1 - 0.5 * y2) * q)


def linear(pair: tuple[float, float], q: float) -> float:
    """y(Fz) = y1 + (y2 - y1) (q - 1)."""
    return pair[0] + (pair[1] - pair[0]) * (q - 1.0)


def scale(tyre: Tyre, friction: float) -> float:
    """mu_L/mu_0."""
    return friction * tyre.friction_factor / tyre.reference_friction


def direction(tyre: Tyre, name: str, load: float, friction: float) -> Direction:
    """Parameters at a load; friction scales forces and slips by mu_L/mu_0 and leaves the initial slope alone."""
    c = getattr(tyre, name)
    q, r = min(load / tyre.nominal_load, tyre.max_load_factor), scale(tyre, friction)
    return Direction(
        quadratic(c.slope, q),
        r * quadratic(c.max_force, q),
        r * linear(c.max_slip, q),
        r * quadratic(c.slide_force, q),
        r * linear(c.slide_slip, q),
    )


def generalised_force(s: float, dF0: float, sM: float, FM: float, sS: float, FS: float) -> float:
    """F(s): broken rational function up to the maximum, cubic polynomial to the sliding value, constant after it."""
    if s <= sM:
        sigma = s / sM
        return sM * dF0 * sigma / (1.0 + sigma * (sigma + dF0 * sM / FM - 2.0))
    if s <= sS:
        sigma = (s - sM) / (sS - sM)
        return FM - (FM - FS) * sigma**2 * (3.0 - 2.0 * sigma)
    return FS


def forces(tyre: Tyre, load: float, friction: float, sx: float, sy: float) -> tuple[float, float]:
    """Fx, Fy at the slips sx, sy (both along the force: driven and to the left positive)."""
    x, y = direction(tyre, "longitudinal", load, friction), direction(tyre, "lateral", load, friction)
    hx = x.sM / (x.sM + y.sM) + (x.FM / x.dF0) / (x.FM / x.dF0 + y.FM / y.dF0)
    hy = y.sM / (x.sM + y.sM) + (y.FM / y.dF0) / (x.FM / x.dF0 + y.FM / y.dF0)
    s = hypot(sx / hx, sy / hy)
    if s == 0.0:
        return 0.0, 0.0
    c, t = (sx / hx) / s, (sy / hy) / s  # cos phi, sin phi
    F = generalised_force(
        s,
        dF0=sqrt((x.dF0 * hx * c) ** 2 + (y.dF0 * hy * t) ** 2),
        sM=sqrt((x.sM / hx * c) ** 2 + (y.sM / hy * t) ** 2),
        FM=sqrt((x.FM * c) ** 2 + (y.FM * t) ** 2),
        sS=sqrt((x.sS / hx * c) ** 2 + (y.sS / hy * t) ** 2),
        FS=sqrt((x.FS * c) ** 2 + (y.FS * t) ** 2),
    )
    return F * c, F * t


def offset(tyre: Tyre, load: float, friction: float, sy: float) -> float:
    """Dynamic tyre offset over the length of the contact, n/L."""
    q, r = min(load / tyre.nominal_load, tyre.max_load_factor), scale(tyre, friction)
    n0, s0, sE = linear(tyre.trail, q), r * linear(tyre.trail_zero, q), r * linear(tyre.trail_end, q)
    s, w = abs(sy), s0 / sE
    if s <= s0:
        x = s / s0
        return n0 * ((1.0 - w) * (1.0 - x) + w * (1.0 - (3.0 - 2.0 * x) * x**2))
    if s <= sE:
        return -n0 * (1.0 - w) * (s - s0) / s0 * ((sE - s) / (sE - s0)) ** 2
    return 0.0


def aligning_moment(tyre: Tyre, load: float, friction: float, sx: float, sy: float) -> float:
    """Mz = -n Fy with the contact length L = 2 sqrt(r0 dz)."""
    length = 2.0 * sqrt(tyre.radius * load / tyre.stiffness)
    return -offset(tyre, load, friction, sy) * length * forces(tyre, load, friction, sx, sy)[1]


def largest(x: Direction, y: Direction, angle: float) -> float:
    """Largest force whose direction is `angle`."""
    return hypot(x.FM * cos(angle), y.FM * sin(angle))
