"""Fits of TMeasy to the Magic Formula and of the Magic Formula to TMeasy by their steady curves, with the errors."""

from collections.abc import Callable, Sequence
from math import atan, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.tyre_files.pure_curves import (
    at_load,
    cornering_stiffness,
    formula_slip,
    magic_lateral,
    magic_longitudinal,
    magic_trail,
    tmeasy_force,
    tmeasy_trail,
)

Array = NDArray[np.float64]
LOADS = (0.5, 1.0, 1.5, 2.0)
"""Loads at which curves are fitted and compared, relative to the nominal load."""
KAPPA = np.concatenate([-np.geomspace(0.5, 1e-3, 60), np.geomspace(1e-3, 1.0, 60)])
"""Longitudinal slips."""
TANGENT = np.geomspace(1e-3, 0.6, 80)
"""Tangents of the slip angle."""
_LEAST_SLIP_RATIO, _LARGEST_SLIP_RATIO = 0.7, 1.9  # slips at two nominal loads over those at one


def magic_of_tmeasy(tyre: Tyre) -> tuple[MagicTyre, dict[str, float]]:
    """Fit MF-Tyre 5.2 to a TMeasy tyre by the curves at pure slip.

    Combined slip follows the friction ellipse, in TMeasy another one; camber thrust and bore torque are neglected.

    `tyre`: its curves hold on a road of the reference friction.

    Returns
    -------
    fitted_tyre : MagicTyre
        Symmetric, in ISO axes.
    errors : dict of str to float
        Largest difference at 0.5 to 2 nominal loads: "longitudinal" and "lateral" over the largest force at each load,
        longitudinal slips from -0.5 to 1 and tan(alpha) up to 0.6; "moment": trail times force, over the largest moment
        at each load.
    """
    nominal, alpha = tyre.nominal_load, formula_slip("MF52", TANGENT)
    longitudinal_forces = {q: _tmeasy_curve(tyre.longitudinal, q, KAPPA / (1.0 + KAPPA)) for q in LOADS}
    lateral_forces = {q: _tmeasy_curve(tyre.lateral, q, TANGENT) for q in LOADS}
    largest_forces = {
        name: [at_load(getattr(tyre, name).max_force, q) for q in LOADS] for name in ("longitudinal", "lateral")
    }
    slopes = {name: getattr(tyre, name).slope[0] / nominal for name in largest_forces}
    peaks = {name: getattr(tyre, name).max_force[0] / nominal for name in largest_forces}

    def fit(
        names: Sequence[str], start: Sequence[float], residuals: Callable[[dict[str, float]], Array]
    ) -> dict[str, float]:
        """Coefficients with the least squares of the residuals."""

        def by_name(x: Array) -> dict[str, float]:
            return dict(zip(names, map(float, x), strict=True))

        def differences(x: Array) -> Array:
            return residuals(by_name(x))

        return by_name(least_squares(differences, start, x_scale="jac").x)

    def errors(name: str, c: dict[str, float]) -> Array:
        """Errors of a curve at all loads and slips over the largest force. `name`: "longitudinal" or "lateral"."""
        law, slip, target = (
            (magic_longitudinal, KAPPA, longitudinal_forces)
            if name == "longitudinal"
            else (magic_lateral, alpha, lateral_forces)
        )
        return np.concatenate(
            [
                (law(c, nominal, q * nominal, slip) - target[q]) / m
                for q, m in zip(LOADS, largest_forces[name], strict=True)
            ]
        )

    c = fit(
        ("PCX1", "PDX1", "PDX2", "PEX1", "PEX2", "PKX1", "PKX2"),
        (1.5, peaks["longitudinal"], -0.05, 0.0, 0.0, slopes["longitudinal"], 0.0),
        lambda c: errors("longitudinal", c),
    )
    c |= fit(
        ("PCY1", "PDY1", "PDY2", "PEY1", "PEY2", "PKY1", "PKY2"),
        (1.3, peaks["lateral"], -0.05, 0.0, 0.0, -1.2 * slopes["lateral"], 2.0),
        lambda c: errors("lateral", c),
    )
    moments = {q: _patch_length(tyre, q) * _trail(tyre, q) * lateral_forces[q] for q in LOADS}

    def moment_errors(trail_coefficients: dict[str, float]) -> Array:
        """Errors of the moment at all loads and slips over the largest moment."""
        return np.concatenate(
            [
                (
                    magic_trail(trail_coefficients, nominal, tyre.radius, q * nominal, TANGENT, "MF52")
                    * lateral_forces[q]
                    - m
                )
                / np.abs(m).max()
                for q, m in moments.items()
            ]
        )

    names = ("QBZ1", "QBZ2", "QCZ1", "QDZ1", "QDZ2", "QEZ1")
    c |= fit(names, (8.0, 0.0, 1.2, 0.1, 0.0, -1.0), moment_errors)
    largest_errors = {name: float(np.abs(errors(name, c)).max()) for name in largest_forces}
    largest_errors["moment"] = float(np.abs(moment_errors(c)).max())
    stiffness = tyre.carcass_stiffness
    c["PTX1"] = c["PKX1"] * nominal / stiffness[0] / tyre.radius
    c["PTY2"] = 2.0
    c["PTY1"] = cornering_stiffness(c, nominal, nominal) / stiffness[1] / (tyre.radius * sin(2.0 * atan(0.5)))
    c["QSY1"] = tyre.rolling_resistance
    fitted_tyre = MagicTyre(
        "MF52",
        c,
        tyre.radius,
        tyre.bottoming_radius,
        tyre.stiffness,
        nominal,
        damping=tyre.damping,
        bottoming_stiffness=tyre.bottoming_stiffness,
        reference_friction=tyre.reference_friction,
        friction_factor=tyre.friction_factor,
        combination="ellipse",
        largest_load=2.5 * nominal,
    )
    return fitted_tyre, largest_errors


def tmeasy_of_magic(tyre: MagicTyre) -> tuple[Tyre, dict[str, float]]:
    """Fit TMeasy to a Magic Formula tyre by the curves at pure slip, at one and two nominal loads.

    The nominal load is that of the tyre, or half of the largest load of the coefficients if that is less. Shifts,
    camber, moments other than that of the trail and the influence of the speed are neglected.

    `tyre`: at its nominal pressure. Raises `ValueError`: the pressure is not the nominal one.

    Returns
    -------
    fitted_tyre : Tyre
        Its curves hold on a road of the reference friction.
    errors : dict of str to float
        As in `magic_of_tmeasy`.
    """
    if tyre.pressure != 0.0:
        raise ValueError(f"The pressure of the tyre is {1.0 + tyre.pressure:g} times the nominal one; it must be that.")
    c, nominal_of_file = dict(tyre.coefficients), tyre.nominal_load
    nominal = min(nominal_of_file, 0.5 * tyre.largest_load)
    c["LMUX"], c["LMUY"] = c.get("LMUX", 1.0) * tyre.lmux, c.get("LMUY", 1.0) * tyre.lmuy
    c["LKX"], c["LKY"] = c.get("LKX", 1.0) * tyre.lkx, c.get("LKY", 1.0) * tyre.lky
    alpha = formula_slip(tyre.version, TANGENT)
    longitudinal_forces = {q: magic_longitudinal(c, nominal_of_file, q * nominal, KAPPA) for q in LOADS}
    lateral_forces = {q: magic_lateral(c, nominal_of_file, q * nominal, alpha) for q in LOADS}
    curves = {
        "longitudinal": _fit_both_loads(KAPPA / (1.0 + KAPPA), longitudinal_forces),
        "lateral": _fit_both_loads(TANGENT, lateral_forces),
    }
    # at the nominal load
    stiffness = 0.5 * (tyre.stiffness + sqrt(tyre.stiffness**2 + 4.0 * tyre.progression * nominal))
    trails = {q: magic_trail(c, nominal_of_file, tyre.radius, q * nominal, TANGENT, tyre.version) for q in LOADS}
    shares = {q: trails[q] / (2.0 * sqrt(tyre.radius * q * nominal / stiffness)) for q in LOADS}
    weights = {q: lateral_forces[q] / lateral_forces[q].max() for q in LOADS}
    nominal_trail = _fit_trail(shares[1.0], weights[1.0])
    trail_parameters = nominal_trail, _fit_trail(shares[2.0], weights[2.0], nominal_trail)
    carcass_stiffness = carcass_stiffness_of(tyre, c)
    fitted_tyre = Tyre(
        radius=tyre.radius * c.get("Q_RE0", 1.0),
        bottoming_radius=tyre.bottoming_radius,
        stiffness=stiffness,
        damping=tyre.damping,
        longitudinal=curves["longitudinal"],
        lateral=curves["lateral"],
        trail=(trail_parameters[0][0], trail_parameters[1][0]),
        trail_zero=(trail_parameters[0][1], trail_parameters[1][1]),
        trail_end=(trail_parameters[0][2], trail_parameters[1][2]),
        carcass_stiffness=carcass_stiffness,
        carcass_damping=(tyre.settling * carcass_stiffness[0], tyre.settling * carcass_stiffness[1]),
        nominal_load=nominal,
        reference_friction=tyre.reference_friction,
        bottoming_stiffness=tyre.bottoming_stiffness,
        max_load_factor=min(3.5, tyre.largest_load / nominal, 0.95 * _largest_load(list(curves.values()))),
        rolling_resistance=max(c.get("QSY1", 0.0) * c.get("LMY", 1.0), 0.0),
        friction_factor=tyre.friction_factor,
        bore=tyre.bore,
    )
    largest_errors = {
        "longitudinal": max(
            float(
                np.abs(_tmeasy_curve(fitted_tyre.longitudinal, q, KAPPA / (1.0 + KAPPA)) - longitudinal_forces[q]).max()
                / longitudinal_forces[q].max()
            )
            for q in LOADS
        ),
        "lateral": max(
            float(
                np.abs(_tmeasy_curve(fitted_tyre.lateral, q, TANGENT) - lateral_forces[q]).max()
                / lateral_forces[q].max()
            )
            for q in LOADS
        ),
        "moment": max(
            float(
                np.abs((_patch_length(fitted_tyre, q) * _trail(fitted_tyre, q) - trails[q]) * lateral_forces[q]).max()
            )
            / (float(np.abs(trails[q] * lateral_forces[q]).max()) or 1.0)  # of a tyre without trail
            for q in LOADS
        ),
    }
    return fitted_tyre, largest_errors


def _tmeasy_curve(curve: TyreCurve, q: float, slip: Array) -> Array:
    """Force of TMeasy at q nominal loads over the slips, N."""
    slips = (pair[0] + (pair[1] - pair[0]) * (q - 1.0) for pair in (curve.max_slip, curve.slide_slip))
    slope, peak, sliding = (at_load(pair, q) for pair in (curve.slope, curve.max_force, curve.slide_force))
    peak_slip, sliding_slip = slips
    return tmeasy_force(slope, peak, peak_slip, sliding, sliding_slip, slip)


def _patch_length(tyre: Tyre, q: float) -> float:
    """Length of the contact patch at q nominal loads, m."""
    return 2.0 * sqrt(tyre.radius * q * tyre.nominal_load / tyre.stiffness)


def _trail(tyre: Tyre, q: float) -> Array:
    """Trail of TMeasy over the length of the patch at q nominal loads and the slips `TANGENT`."""
    pairs = (tyre.trail, tyre.trail_zero, tyre.trail_end)
    first, zero, end = (pair[0] + (pair[1] - pair[0]) * (q - 1.0) for pair in pairs)
    return tmeasy_trail(first, zero, end, TANGENT)


CurveParameters = tuple[float, float, float, float, float]
TrailParameters = tuple[float, float, float]


def _fit_curve(slip: Array, force: Array, first: CurveParameters | None = None) -> CurveParameters:
    """Fit slope, largest force, its slip, sliding force and its slip at one load.

    The unknowns are logarithms, so that all values are positive. `first`: the result at the nominal load, which bounds
    the slips so that they stay positive and in order where TMeasy extrapolates them from both loads.
    """
    peak = int(np.argmax(force))
    scale = float(force[peak])

    def parameters(x: Array) -> CurveParameters:
        share, most_at, sliding_share, gap, excess_slope = (float(v) for v in np.exp(x))
        most = share * scale
        return most * (1.02 + excess_slope) / most_at, most, most_at, most * sliding_share, most_at + gap

    low, high = [0.5, 0.01, 0.2, 0.005, 1e-3], [2.0, 2.0, 0.9999, 20.0, 20.0]
    if first is not None:
        gap, sliding_share = first[4] - first[2], first[3] / first[1]
        low[2], high[2] = 0.7 * sliding_share, min(1.4 * sliding_share, 0.9999)
        low[1], high[1], low[3], high[3] = (
            _LEAST_SLIP_RATIO * first[2],
            _LARGEST_SLIP_RATIO * first[2],
            _LEAST_SLIP_RATIO * gap,
            _LARGEST_SLIP_RATIO * gap,
        )
    start = np.clip([1.0, float(slip[peak]), 0.85, 0.5, 1.0], np.multiply(low, 1.01), np.multiply(high, 0.99))

    def differences(x: Array) -> Array:
        return np.asarray((tmeasy_force(*parameters(x), slip) - force) / scale)

    return parameters(least_squares(differences, np.log(start), bounds=(np.log(low), np.log(high))).x)


def _fit_trail(share: Array, weight: Array, first: TrailParameters | None = None) -> TrailParameters:
    """Fit the trail at no slip over the patch length, and the slips of its zero and end; `first` as in `_fit_curve`."""

    def parameters(x: Array) -> TrailParameters:
        zero = float(np.exp(x[1]))
        return float(x[0]), zero, zero + float(np.exp(x[2]))

    low, high = [0.02, 0.01], [3.0, 20.0]
    if first is not None:
        slips = first[1], first[2] - first[1]
        low, high = [_LEAST_SLIP_RATIO * slip for slip in slips], [_LARGEST_SLIP_RATIO * slip for slip in slips]
    start = np.clip([0.2, 0.8], np.multiply(low, 1.01), np.multiply(high, 0.99))
    bounds = [-1.0, *np.log(low)], [1.0, *np.log(high)]
    initial = [float(np.clip(share[0], -0.99, 0.99)), *np.log(start)]

    def differences(x: Array) -> Array:
        return np.asarray((tmeasy_trail(*parameters(x), TANGENT) - share) * weight)

    return parameters(least_squares(differences, initial, bounds=bounds).x)


def _fit_both_loads(slip: Array, force: dict[float, Array]) -> TyreCurve:
    """Fit a curve at one and two nominal loads. `force`: N, by load over the nominal load."""
    first = _fit_curve(slip, force[1.0])
    return TyreCurve(*zip(first, _fit_curve(slip, force[2.0], first), strict=True))


def _largest_load(curves: Sequence[TyreCurve]) -> float:
    """Load, relative to the nominal load, at which an extrapolated force or slip of TMeasy vanishes."""
    limits = [100.0]
    for curve in curves:
        for first, second in (curve.slope, curve.max_force, curve.slide_force):
            difference = first - 0.5 * second
            limits += [(2.0 * first - 0.5 * second) / difference] if difference > 0.0 else []
        slip_differences = tuple(end - at for end, at in zip(curve.slide_slip, curve.max_slip, strict=True))
        for first, second in (curve.max_slip, slip_differences):
            limits += [1.0 + first / (first - second)] if second < first else []
    return min(limits)


def carcass_stiffness_of(tyre: MagicTyre, c: dict[str, float]) -> tuple[float, float]:
    """Longitudinal and lateral carcass stiffness at the nominal load, N/m: slip stiffness over relaxation length."""
    length = c.get("PTY1", 0.0) * sin(2.0 * atan(1.0 / (c.get("PTY2", 0.0) or 1.0))) or 1.0
    lateral_stiffness = cornering_stiffness(c, tyre.nominal_load, tyre.nominal_load) / (length * tyre.radius)
    return tyre.along[1], c.get("LATERAL_STIFFNESS", 0.0) or lateral_stiffness
