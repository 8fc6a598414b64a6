"""Fits the Magic Formula to TMeasy by their steady curves at pure slip, and gives the errors."""

from collections.abc import Callable, Mapping
from math import atan, sin

import numpy as np
from scipy.optimize import least_squares

from mbs.elements.load_laws import force_at_load
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre, TyreCurve
from mbs.tyre_files.pure_curves import (
    LOADS,
    LONGITUDINAL_SLIPS,
    TANGENTS,
    TMEASY_SLIPS,
    Array,
    cornering_stiffness,
    formula_slip,
    magic_lateral,
    magic_longitudinal,
    magic_trail,
    tmeasy_forces,
    trail_at_load,
)

_Errors = Callable[[dict[str, float]], Array]
_MAX_LOAD_RATIO = 2.5  # up to which a fitted Magic Formula holds


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
        "longitudinal": _force_errors(magic_longitudinal, nominal, tyre.longitudinal, LONGITUDINAL_SLIPS, TMEASY_SLIPS),
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
    targets = [(r * nominal, tmeasy_forces(curve, r, tmeasy_slip), force_at_load(curve.max_force, r)) for r in LOADS]

    def errors(c: dict[str, float]) -> Array:
        return np.concatenate([(law(c, nominal, load, slip) - target) / largest for load, target, largest in targets])

    return errors


def _moment_errors(tyre: Tyre) -> _Errors:
    """Function of coefficients: errors of the moment at all loads and slips, relative to the largest at each load."""
    nominal, targets = tyre.nominal_load, []
    for r in LOADS:
        force = tmeasy_forces(tyre.lateral, r, TANGENTS)
        moment = trail_at_load(tyre, r) * force
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
