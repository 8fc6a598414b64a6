"""Steady forces at pure slip and trail of both tyre formulas, without camber and shifts, for fits."""

from collections.abc import Mapping
from math import atan, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.elements.load_laws import force_at_load, slip_at_load
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS

Array = NDArray[np.float64]
LOADS = (0.5, 1.0, 1.5, 2.0)
"""Loads at which curves are fitted and compared, relative to the nominal load."""
LONGITUDINAL_SLIPS = np.concatenate([-np.geomspace(0.5, 1e-3, 60), np.geomspace(1e-3, 1.0, 60)])
TANGENTS = np.geomspace(1e-3, 0.6, 80)
"""Tangents of the slip angle."""
TMEASY_SLIPS = LONGITUDINAL_SLIPS / (1.0 + LONGITUDINAL_SLIPS)
"""Slips of TMeasy, which are relative to the rolling speed instead of the speed of travel."""


def tmeasy_force(
    slope: float, peak: float, peak_slip: float, sliding: float, sliding_slip: float, slip: ArrayLike
) -> Array:
    """Force of TMeasy, N, an odd function of the slip (Hirschberg, Rill and Weinfurter, 2007).

    `slope`, `peak`, `sliding`: initial slope, largest and sliding force, N; `peak_slip`, `sliding_slip`: slips of the
    largest force and at which sliding starts; `slip`: relative to the speed of the rolling wheel.
    """
    s = np.abs(np.asarray(slip, float))
    x = s / peak_slip
    rising = slope * s / ((1.0 - x) ** 2 + slope * s / peak)
    progress = np.clip((s - peak_slip) / (sliding_slip - peak_slip), 0.0, 1.0)
    falling = peak - (peak - sliding) * progress**2 * (3.0 - 2.0 * progress)
    return np.asarray(np.sign(slip) * np.where(s < peak_slip, rising, falling))


def tmeasy_forces(curve: TyreCurve, load_ratio: float, slip: ArrayLike) -> Array:
    """Forces of TMeasy at a load relative to the nominal load, N. `slip`: as in `tmeasy_force`."""
    slope, max_force, slide_force = (
        force_at_load(pair, load_ratio) for pair in (curve.slope, curve.max_force, curve.slide_force)
    )
    max_slip, slide_slip = (slip_at_load(pair, load_ratio) for pair in (curve.max_slip, curve.slide_slip))
    return tmeasy_force(slope, max_force, max_slip, slide_force, slide_slip, slip)


def tmeasy_trail(first: float, zero: float, end: float, slip: ArrayLike) -> Array:
    """Trail of TMeasy at a lateral slip, relative to the length of the contact patch.

    `first`: trail at zero slip; `zero`, `end`: slips at which it vanishes and ends.
    """
    s = np.abs(np.asarray(slip, float))
    w, x = zero / end, s / zero
    before_zero = first * ((1.0 - w) * (1.0 - x) + w * (1.0 - (3.0 - 2.0 * x) * x * x))
    after_zero = -first * (1.0 - w) * (x - 1.0) * ((end - s) / (end - zero)) ** 2
    return np.where(s >= end, 0.0, np.where(s >= zero, after_zero, before_zero))


def _magic_sine(B: float, C: float, D: float, E: float, x: Array) -> Array:
    """Sine version of the Magic Formula (4.E9)."""
    scaled = B * x
    return np.asarray(D * np.sin(C * np.arctan(scaled - min(E, 1.0) * (scaled - np.arctan(scaled)))))


def magic_longitudinal(coefficients: Mapping[str, float], nominal: float, load: float, kappa: ArrayLike) -> Array:
    """Longitudinal force of the Magic Formula at pure slip (4.E9 to 4.E18), N.

    `coefficients`: coefficients by name, the missing ones at their defaults; `nominal`, `load`: N.
    """
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    nominal *= c["LFZO"]
    dfz = load / nominal - 1.0
    C, D = c["PCX1"] * c["LCX"], (c["PDX1"] + c["PDX2"] * dfz) * c["LMUX"] * load
    K = load * (c["PKX1"] + c["PKX2"] * dfz) * np.exp(c["PKX3"] * dfz) * c["LKX"]
    E = (c["PEX1"] + c["PEX2"] * dfz + c["PEX3"] * dfz**2) * c["LEX"]
    return _magic_sine(K / (C * D), C, D, E, np.asarray(kappa, float))


def cornering_stiffness(coefficients: Mapping[str, float], nominal: float, load: float) -> float:
    """K of 4.E25 without camber, N/rad, positive."""
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    nominal *= c["LFZO"]
    turn = c["PKY4"] * np.arctan(load / (c["PKY2"] * nominal))
    return float(abs(c["PKY1"]) * nominal * np.sin(turn) * c["LKY"])


def carcass_stiffness(tyre: MagicTyre, coefficients: Mapping[str, float]) -> tuple[float, float]:
    """Longitudinal and lateral carcass stiffness at the nominal load, N/m.

    The stiffness of the file, otherwise slip stiffness divided by relaxation length.
    """
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    # a file without PTY1 has no relaxation length: 1 radius
    relative_length = c["PTY1"] * sin(2.0 * atan(1.0 / (c["PTY2"] or 1.0))) or 1.0
    slip_stiffness = cornering_stiffness(c, tyre.nominal_load, tyre.nominal_load)
    return tyre.along[1], c["LATERAL_STIFFNESS"] or slip_stiffness / (relative_length * tyre.radius)


def formula_slip(version: str, tangent: ArrayLike) -> Array:
    """Lateral slip of the Magic Formula (4.E3): the slip angle, rad, up to 5.2, its tangent from 6.1.

    `version`: key of `VERSIONS`; `tangent`: tangent of the slip angle.
    """
    return np.asarray(tangent, float) if version in ("MF61", "MF62") else np.asarray(np.arctan(tangent))


def magic_lateral(coefficients: Mapping[str, float], nominal: float, load: float, alpha: ArrayLike) -> Array:
    """Lateral force, opposite to the slip, at pure slip (4.E19 to 4.E30), N.

    `alpha`: lateral slip as `formula_slip` gives it.
    """
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    dfz = load / (nominal * c["LFZO"]) - 1.0
    C, D = c["PCY1"] * c["LCY"], (c["PDY1"] + c["PDY2"] * dfz) * c["LMUY"] * load
    E = (c["PEY1"] + c["PEY2"] * dfz) * c["LEY"]
    return _magic_sine(cornering_stiffness(coefficients, nominal, load) / (C * D), C, D, E, np.asarray(alpha, float))


def magic_trail(
    coefficients: Mapping[str, float], nominal: float, radius: float, load: float, tangent: ArrayLike, version: str
) -> Array:
    """Pneumatic trail (4.E71 to 4.E75) without camber and shifts, m.

    `tangent`: tangent of the slip angle; `version`: key of `VERSIONS`.
    """
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    alpha = np.arctan(tangent)
    a = formula_slip(version, tangent)
    dfz = load / (nominal * c["LFZO"]) - 1.0
    B = (c["QBZ1"] + c["QBZ2"] * dfz + c["QBZ3"] * dfz**2) * c["LKY"] / c["LMUY"]
    D = load * radius / (nominal * c["LFZO"]) * (c["QDZ1"] + c["QDZ2"] * dfz) * c["LTR"]
    E = min(c["QEZ1"] + c["QEZ2"] * dfz + c["QEZ3"] * dfz**2, 1.0)
    scaled = B * a
    return np.asarray(D * np.cos(c["QCZ1"] * np.arctan(scaled - E * (scaled - np.arctan(scaled)))) * np.cos(alpha))


def patch_length(radius: float, load_ratio: float, nominal: float, stiffness: float) -> float:
    """Length of the contact patch, m."""
    return 2.0 * sqrt(radius * load_ratio * nominal / stiffness)


def trail_at_load(tyre: Tyre, load_ratio: float) -> Array:
    """Trail of TMeasy at the slips `TANGENTS`, m."""
    pairs = (tyre.trail, tyre.trail_zero, tyre.trail_end)
    trail, zero, end = (slip_at_load(pair, load_ratio) for pair in pairs)
    length = patch_length(tyre.radius, load_ratio, tyre.nominal_load, tyre.stiffness)
    return length * tmeasy_trail(trail, zero, end, TANGENTS)
