"""Fits TMeasy to the Magic Formula by their steady curves at pure slip, and gives the errors."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from mbs.elements.load_laws import largest_load_of_force, largest_load_of_slip
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.tyre_files.pure_curves import (
    LOADS,
    LONGITUDINAL_SLIPS,
    TANGENTS,
    TMEASY_SLIPS,
    Array,
    carcass_stiffness,
    formula_slip,
    magic_lateral,
    magic_longitudinal,
    magic_trail,
    patch_length,
    tmeasy_force,
    tmeasy_forces,
    tmeasy_trail,
    trail_at_load,
)

_MIN_SLIP_RATIO = 0.7  # slip at two nominal loads, relative to that at one
_MAX_SLIP_RATIO = 1.9


def tmeasy_of_magic(tyre: MagicTyre) -> tuple[Tyre, dict[str, float]]:
    """Fit TMeasy to a Magic Formula tyre by the curves at pure slip, at one and two nominal loads.

    The nominal load is the tyre's, or half of the largest load for which the coefficients are valid, if that is
    less. Shifts, camber, moments other than of the trail and the influence of the speed are neglected.

    `tyre`: a tyre at its nominal pressure, otherwise `ValueError` is raised.

    Returns
    -------
    fitted_tyre : Tyre
        Its curves hold on a road of the reference friction.
    errors : dict of str to float
        As in `magic_of_tmeasy`.
    """
    if tyre.pressure != 0.0:
        raise ValueError(
            f"The pressure of the tyre is {1.0 + tyre.pressure:g} times the nominal pressure; it must be that."
        )
    c, nominal_of_file = dict(tyre.coefficients), tyre.nominal_load
    nominal = min(nominal_of_file, 0.5 * tyre.largest_load)
    c["LMUX"], c["LMUY"] = c.get("LMUX", 1.0) * tyre.lmux, c.get("LMUY", 1.0) * tyre.lmuy
    c["LKX"], c["LKY"] = c.get("LKX", 1.0) * tyre.lkx, c.get("LKY", 1.0) * tyre.lky
    alpha = formula_slip(tyre.version, TANGENTS)
    longitudinal_forces = {r: magic_longitudinal(c, nominal_of_file, r * nominal, LONGITUDINAL_SLIPS) for r in LOADS}
    lateral_forces = {r: magic_lateral(c, nominal_of_file, r * nominal, alpha) for r in LOADS}
    trails = {r: magic_trail(c, nominal_of_file, tyre.radius, r * nominal, TANGENTS, tyre.version) for r in LOADS}
    longitudinal = _fit_both_loads(TMEASY_SLIPS, longitudinal_forces)
    lateral = _fit_both_loads(TANGENTS, lateral_forces)
    # N/m, tangent stiffness at the nominal load
    stiffness = 0.5 * (tyre.stiffness + sqrt(tyre.stiffness**2 + 4.0 * tyre.progression * nominal))
    relative_trails = {r: trails[r] / patch_length(tyre.radius, r, nominal, stiffness) for r in LOADS}
    trail, trail_zero, trail_end = _fit_trail_at_both_loads(relative_trails, lateral_forces)
    carcass = carcass_stiffness(tyre, c)
    fitted_tyre = Tyre(
        radius=tyre.radius * c.get("Q_RE0", 1.0),
        bottoming_radius=tyre.bottoming_radius,
        stiffness=stiffness,
        damping=tyre.damping,
        longitudinal=longitudinal,
        lateral=lateral,
        trail=trail,
        trail_zero=trail_zero,
        trail_end=trail_end,
        carcass_stiffness=carcass,
        carcass_damping=(tyre.settling * carcass[0], tyre.settling * carcass[1]),
        nominal_load=nominal,
        reference_friction=tyre.reference_friction,
        bottoming_stiffness=tyre.bottoming_stiffness,
        max_load_factor=min(3.5, tyre.largest_load / nominal, 0.95 * _max_load_ratio([longitudinal, lateral])),
        rolling_resistance=max(c.get("QSY1", 0.0) * c.get("LMY", 1.0), 0.0),
        friction_factor=tyre.friction_factor,
        bore=tyre.bore,
    )
    return fitted_tyre, _tmeasy_errors(fitted_tyre, longitudinal_forces, lateral_forces, trails)


def _tmeasy_errors(
    tyre: Tyre,
    longitudinal_forces: Mapping[float, Array],
    lateral_forces: Mapping[float, Array],
    trails: Mapping[float, Array],
) -> dict[str, float]:
    """Largest errors of a fitted TMeasy, as in `magic_of_tmeasy`; target forces, N, and trails, m, by load ratio."""

    def moment_errors(r: float) -> Array:
        return np.asarray((trail_at_load(tyre, r) - trails[r]) * lateral_forces[r])

    def largest(error: Callable[[float], Array], references: Mapping[float, Array]) -> float:
        # a tyre without trail has moments of 0
        return max(float(np.abs(error(r)).max()) / (float(references[r].max()) or 1.0) for r in LOADS)

    moments = {r: np.abs(trails[r] * lateral_forces[r]) for r in LOADS}
    return {
        "longitudinal": largest(
            lambda r: tmeasy_forces(tyre.longitudinal, r, TMEASY_SLIPS) - longitudinal_forces[r], longitudinal_forces
        ),
        "lateral": largest(lambda r: tmeasy_forces(tyre.lateral, r, TANGENTS) - lateral_forces[r], lateral_forces),
        "moment": largest(moment_errors, moments),
    }


class _CurveValues(NamedTuple):
    """Fields of `TyreCurve` at one load."""

    slope: float
    max_force: float
    max_slip: float
    slide_force: float
    slide_slip: float


class _TrailValues(NamedTuple):
    """Fields of the trail of `Tyre` at one load."""

    trail: float
    trail_zero: float
    trail_end: float


def _fit_curve(slip: Array, force: Array, nominal: _CurveValues | None = None) -> _CurveValues:
    """Fit a curve at one load.

    The unknowns are logarithms, so that all values are positive. `nominal`: the result at the nominal load; it bounds
    the slips, so that they stay positive and in order when TMeasy extrapolates them.
    """
    peak = int(np.argmax(force))
    scale = float(force[peak])

    def values(x: Array) -> _CurveValues:
        peak_ratio, max_slip, slide_ratio, slip_gap, excess_slope = (float(v) for v in np.exp(x))
        max_force = peak_ratio * scale
        slope = max_force * (1.02 + excess_slope) / max_slip  # steeper than the secant to the peak
        return _CurveValues(slope, max_force, max_slip, max_force * slide_ratio, max_slip + slip_gap)

    # in the order of the unknowns
    low, high = [0.5, 0.01, 0.2, 0.005, 1e-3], [2.0, 2.0, 0.9999, 20.0, 20.0]
    if nominal is not None:
        slip_gap, slide_ratio = nominal.slide_slip - nominal.max_slip, nominal.slide_force / nominal.max_force
        low[1:4] = _MIN_SLIP_RATIO * nominal.max_slip, 0.7 * slide_ratio, _MIN_SLIP_RATIO * slip_gap
        high[1:4] = _MAX_SLIP_RATIO * nominal.max_slip, min(1.4 * slide_ratio, 0.9999), _MAX_SLIP_RATIO * slip_gap
    start = np.clip([1.0, float(slip[peak]), 0.85, 0.5, 1.0], np.multiply(low, 1.01), np.multiply(high, 0.99))

    def differences(x: Array) -> Array:
        return np.asarray((tmeasy_force(*values(x), slip) - force) / scale)

    return values(least_squares(differences, np.log(start), bounds=(np.log(low), np.log(high))).x)


def _fit_trail(relative_trail: Array, weight: Array, nominal: _TrailValues | None = None) -> _TrailValues:
    """Fit the trail at one load; `nominal` as in `_fit_curve`.

    The unknowns are the trail at zero slip relative to the patch length, and logarithms of the slip at which it
    vanishes and of the further slip up to its end.
    """

    def values(x: Array) -> _TrailValues:
        zero = float(np.exp(x[1]))
        return _TrailValues(float(x[0]), zero, zero + float(np.exp(x[2])))

    low, high = [0.02, 0.01], [3.0, 20.0]  # of both slips
    if nominal is not None:
        slips = nominal.trail_zero, nominal.trail_end - nominal.trail_zero
        low, high = [_MIN_SLIP_RATIO * slip for slip in slips], [_MAX_SLIP_RATIO * slip for slip in slips]
    start = np.clip([0.2, 0.8], np.multiply(low, 1.01), np.multiply(high, 0.99))
    bounds = [-1.0, *np.log(low)], [1.0, *np.log(high)]
    initial = [float(np.clip(relative_trail[0], -0.99, 0.99)), *np.log(start)]

    def differences(x: Array) -> Array:
        return np.asarray((tmeasy_trail(*values(x), TANGENTS) - relative_trail) * weight)

    return values(least_squares(differences, initial, bounds=bounds).x)


def _fit_both_loads(slip: Array, forces: Mapping[float, Array]) -> TyreCurve:
    """Fit a curve at one and two nominal loads. `forces`: N, by load ratio."""
    nominal = _fit_curve(slip, forces[1.0])
    return TyreCurve(*zip(nominal, _fit_curve(slip, forces[2.0], nominal), strict=True))


def _fit_trail_at_both_loads(
    relative_trails: Mapping[float, Array], forces: Mapping[float, Array]
) -> Iterator[tuple[float, float]]:
    """Trail, its zero and its end at one and two nominal loads. `forces`: N, by load ratio, the weights of the fit."""
    weights = {r: forces[r] / forces[r].max() for r in (1.0, 2.0)}
    nominal = _fit_trail(relative_trails[1.0], weights[1.0])
    return zip(nominal, _fit_trail(relative_trails[2.0], weights[2.0], nominal), strict=True)


def _max_load_ratio(curves: Sequence[TyreCurve]) -> float:
    """Load, relative to the nominal load, at which the first force or slip of TMeasy vanishes (or inf)."""
    limits: list[float] = []
    for curve in curves:
        limits += map(largest_load_of_force, (curve.slope, curve.max_force, curve.slide_force))
        slip_gaps = tuple(slide - peak for slide, peak in zip(curve.slide_slip, curve.max_slip, strict=True))
        limits += map(largest_load_of_slip, (curve.max_slip, slip_gaps))
    return min(limits)
