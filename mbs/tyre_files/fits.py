"""Fits TMeasy to the Magic Formula and the Magic Formula to TMeasy by their steady curves, and gives the errors."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import atan, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.tyre_files.pure_curves import (
    at_load,
    carcass_stiffness,
    cornering_stiffness,
    formula_slip,
    magic_lateral,
    magic_longitudinal,
    magic_trail,
    slip_at_load,
    tmeasy_force,
    tmeasy_forces,
    tmeasy_trail,
)

Array = NDArray[np.float64]
_Errors = Callable[[dict[str, float]], Array]
LOADS = (0.5, 1.0, 1.5, 2.0)
"""Loads at which curves are fitted and compared, relative to the nominal load."""
LONGITUDINAL_SLIPS = np.concatenate([-np.geomspace(0.5, 1e-3, 60), np.geomspace(1e-3, 1.0, 60)])
TANGENTS = np.geomspace(1e-3, 0.6, 80)
"""Tangents of the slip angle."""
_TMEASY_SLIPS = LONGITUDINAL_SLIPS / (1.0 + LONGITUDINAL_SLIPS)
"""Slips of TMeasy, which are relative to the rolling speed instead of the speed of travel."""
_MAX_LOAD_RATIO = 2.5  # up to which a fitted Magic Formula holds
_MIN_SLIP_RATIO = 0.7  # slip at two nominal loads, relative to that at one
_MAX_SLIP_RATIO = 1.9


def magic_of_tmeasy(tyre: Tyre) -> tuple[MagicTyre, dict[str, float]]:
    """Fit MF-Tyre 5.2 to a TMeasy tyre by the curves at pure slip.

    Combined slip follows the friction ellipse, which differs from the ellipse of TMeasy; camber thrust and bore torque
    are neglected.

    `tyre`: its curves must be those at the reference friction.

    Returns
    -------
    fitted_tyre : MagicTyre
        Symmetric, in ISO axes.
    errors : dict of str to float
        Largest difference at 0.5 to 2 nominal loads, longitudinal slips from -0.5 to 1 and tan(alpha) up to 0.6:
        "longitudinal" and "lateral" relative to the largest force at that load; "moment": lateral force times trail,
        relative to the largest moment at that load.
    """
    nominal, alpha = tyre.nominal_load, formula_slip("MF52", TANGENTS)
    errors = {
        "longitudinal": _force_errors(
            magic_longitudinal, nominal, tyre.longitudinal, LONGITUDINAL_SLIPS, _TMEASY_SLIPS
        ),
        "lateral": _force_errors(magic_lateral, nominal, tyre.lateral, alpha, TANGENTS),
        "moment": _moment_errors(tyre),
    }
    c: dict[str, float] = {}
    for name, start in _start_coefficients(tyre).items():
        c |= _fit_coefficients(start, errors[name])
    largest_errors = {name: float(np.abs(error(c)).max()) for name, error in errors.items()}
    c |= _relaxation_coefficients(tyre, c)
    c["QSY1"] = tyre.rolling_resistance
    fitted_tyre = MagicTyre(
        "MF52",
        c,
        tyre.radius,
        tyre.bottoming_radius,
        tyre.stiffness,
        tyre.nominal_load,
        damping=tyre.damping,
        bottoming_stiffness=tyre.bottoming_stiffness,
        reference_friction=tyre.reference_friction,
        friction_factor=tyre.friction_factor,
        combination="ellipse",
        largest_load=_MAX_LOAD_RATIO * tyre.nominal_load,
    )
    return fitted_tyre, largest_errors


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
    longitudinal = _fit_both_loads(_TMEASY_SLIPS, longitudinal_forces)
    lateral = _fit_both_loads(TANGENTS, lateral_forces)
    # N/m, tangent stiffness at the nominal load
    stiffness = 0.5 * (tyre.stiffness + sqrt(tyre.stiffness**2 + 4.0 * tyre.progression * nominal))
    relative_trails = {r: trails[r] / _patch_length(tyre.radius, r, nominal, stiffness) for r in LOADS}
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


def _start_coefficients(tyre: Tyre) -> dict[str, dict[str, float]]:
    """Coefficients from which the fits of longitudinal force, lateral force and moment start."""
    nominal, x, y = tyre.nominal_load, tyre.longitudinal, tyre.lateral
    # usual values of passenger-car tyres where TMeasy gives none
    return {
        "longitudinal": {
            "PCX1": 1.5,
            "PDX1": x.max_force[0] / nominal,
            "PDX2": -0.05,
            "PEX1": 0.0,
            "PEX2": 0.0,
            "PKX1": x.slope[0] / nominal,
            "PKX2": 0.0,
        },
        "lateral": {
            "PCY1": 1.3,
            "PDY1": y.max_force[0] / nominal,
            "PDY2": -0.05,
            "PEY1": 0.0,
            "PEY2": 0.0,
            "PKY1": -1.2 * (y.slope[0] / nominal),
            "PKY2": 2.0,
        },
        "moment": {"QBZ1": 8.0, "QBZ2": 0.0, "QCZ1": 1.2, "QDZ1": 0.1, "QDZ2": 0.0, "QEZ1": -1.0},
    }


def _fit_coefficients(start: Mapping[str, float], residuals: _Errors) -> dict[str, float]:
    """Coefficients with the least squares of the residuals."""

    def by_name(x: Array) -> dict[str, float]:
        return dict(zip(start, map(float, x), strict=True))

    def differences(x: Array) -> Array:
        return residuals(by_name(x))

    return by_name(least_squares(differences, list(start.values()), x_scale="jac").x)


def _force_errors(
    law: Callable[..., Array], nominal: float, curve: TyreCurve, slip: Array, tmeasy_slip: Array
) -> _Errors:
    """Function of coefficients: errors of a force at all loads and slips, relative to the largest force at each load.

    `law`: `magic_longitudinal` or `magic_lateral`; `slip`, `tmeasy_slip`: the same slips as both formulas take them.
    """
    targets = [(r * nominal, tmeasy_forces(curve, r, tmeasy_slip), at_load(curve.max_force, r)) for r in LOADS]

    def errors(c: dict[str, float]) -> Array:
        return np.concatenate([(law(c, nominal, load, slip) - target) / largest for load, target, largest in targets])

    return errors


def _moment_errors(tyre: Tyre) -> _Errors:
    """Function of coefficients: errors of the moment at all loads and slips, relative to the largest at each load."""
    nominal, targets = tyre.nominal_load, []
    for r in LOADS:
        force = tmeasy_forces(tyre.lateral, r, TANGENTS)
        moment = _trail(tyre, r) * force
        targets.append((r * nominal, force, moment, np.abs(moment).max()))

    def errors(c: dict[str, float]) -> Array:
        trails = [magic_trail(c, nominal, tyre.radius, load, TANGENTS, "MF52") for load, *_ in targets]
        return np.concatenate(
            [(trail * f - m) / largest for trail, (_, f, m, largest) in zip(trails, targets, strict=True)]
        )

    return errors


def _relaxation_coefficients(tyre: Tyre, c: dict[str, float]) -> dict[str, float]:
    """PTX1, PTY1 and PTY2 that give the carcass stiffnesses at the nominal load."""
    nominal, (longitudinal, lateral), PTY2 = tyre.nominal_load, tyre.carcass_stiffness, 2.0
    load_factor = sin(2.0 * atan(1.0 / PTY2))
    PTX1 = c["PKX1"] * nominal / longitudinal / tyre.radius
    PTY1 = cornering_stiffness(c, nominal, nominal) / lateral / (tyre.radius * load_factor)
    return {"PTX1": PTX1, "PTY2": PTY2, "PTY1": PTY1}


def _tmeasy_errors(
    tyre: Tyre,
    longitudinal_forces: Mapping[float, Array],
    lateral_forces: Mapping[float, Array],
    trails: Mapping[float, Array],
) -> dict[str, float]:
    """Largest errors of a fitted TMeasy, as in `magic_of_tmeasy`; target forces, N, and trails, m, by load ratio."""

    def moment_errors(r: float) -> Array:
        return np.asarray((_trail(tyre, r) - trails[r]) * lateral_forces[r])

    def largest(error: Callable[[float], Array], references: Mapping[float, Array]) -> float:
        # a tyre without trail has moments of 0
        return max(float(np.abs(error(r)).max()) / (float(references[r].max()) or 1.0) for r in LOADS)

    moments = {r: np.abs(trails[r] * lateral_forces[r]) for r in LOADS}
    return {
        "longitudinal": largest(
            lambda r: tmeasy_forces(tyre.longitudinal, r, _TMEASY_SLIPS) - longitudinal_forces[r], longitudinal_forces
        ),
        "lateral": largest(lambda r: tmeasy_forces(tyre.lateral, r, TANGENTS) - lateral_forces[r], lateral_forces),
        "moment": largest(moment_errors, moments),
    }


def _patch_length(radius: float, load_ratio: float, nominal: float, stiffness: float) -> float:
    """Length of the contact patch, m."""
    return 2.0 * sqrt(radius * load_ratio * nominal / stiffness)


def _trail(tyre: Tyre, load_ratio: float) -> Array:
    """Trail of TMeasy at the slips `TANGENTS`, m."""
    pairs = (tyre.trail, tyre.trail_zero, tyre.trail_end)
    trail, zero, end = (slip_at_load(pair, load_ratio) for pair in pairs)
    length = _patch_length(tyre.radius, load_ratio, tyre.nominal_load, tyre.stiffness)
    return length * tmeasy_trail(trail, zero, end, TANGENTS)


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
    """Load, relative to the nominal load, at which an extrapolated force or slip of TMeasy vanishes."""
    limits = [100.0]  # no limit
    for curve in curves:
        for first, second in (curve.slope, curve.max_force, curve.slide_force):
            difference = first - 0.5 * second
            if difference > 0.0:
                limits.append((2.0 * first - 0.5 * second) / difference)
        slip_gaps = tuple(slide - peak for slide, peak in zip(curve.slide_slip, curve.max_slip, strict=True))
        for first, second in (curve.max_slip, slip_gaps):
            if second < first:
                limits.append(1.0 + first / (first - second))
    return min(limits)
