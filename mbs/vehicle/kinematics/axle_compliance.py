"""Compliance of the axles: toe, camber and displacements per force at the contact centres, at fixed wheel heights.

The mean position of the suspension joints of the chassis is fixed, and so is the angle of the steering wheel. Links are
rigid and joints ideal, so only a flexible frame or the torsion bar of a steering column are compliant.

Small motions that all constraints allow are q = V z. With the multipliers lam of the constraints, Phi_q' lam = Q at the
drawing, their stiffness is V' (H - dQ/dq) V with H = sum lam_k Phi_k,qq: of springs, frame and the preload of links.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import instance_of
from mbs.common.errors import ModelError
from mbs.vehicle.car import Car
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.kinematics.held_car import HeldCar, HeldWheel

Array = NDArray[np.float64]

DIRECTIONS = {"same": 1.0, "opposed": -1.0}
"""Load of the right wheel per load of the left one, both in vehicle axes."""
LOADS = ("lateral_force", "longitudinal_force", "drive_force", "aligning_torque")
"""Loads on the carrier: forces along y and x at the contact centre, along x at the wheel centre, moment about z."""


@dataclass(frozen=True)
class Compliance:
    """Displacements and angles of the left wheel of an axle per load on both wheels."""

    fidelity: Fidelity
    freedoms: int
    """Number of independent small motions with fixed wheels and steering; 0: all values are zero."""
    values: dict[str, dict[str, float]]
    """By axle, of those with links; names as ``lateral_force.same.steer_angle``: the load, its sense on the right
    wheel, and the response: steer_angle and inclination_angle, rad per N or per N m, contact_y and centre_x, m per N or
    per N m. Of the axle ``wheel_rate`` and ``roll_wheel_rate``, N/m, with all compliances in series."""
    sentence: str
    """Reason why all values are zero; otherwise empty."""


def compliance(car: Car, fidelity: Fidelity | int | str | None = None) -> Compliance:
    """Compliance of the axles with links at the drawing, in SI units.

    Parameters
    ----------
    fidelity : Fidelity, int or str, optional
        Of the chassis; by default its flexible frame with all static modes, if the car has one.

    Raises
    ------
    ModelError
        The car has no frame for the fidelity, or no axle with links.
    """
    instance_of(Car, car, "The car of compliance()", "a Car of mbs.vehicle.load()")
    chosen = compliance_fidelity(car, fidelity)
    if not car.linked_axles:
        car.front.suspension.require_links()
    held_car = HeldCar(car, chosen)
    V, flexibility = held_car.flexibility(held_car.wheel_rows())
    values = {axle: _responses(held_car, axle, V, flexibility) for axle in car.linked_axles}
    free, springs = held_car.flexibility(np.zeros((0, len(held_car.q))))
    for axle, responses in values.items():
        responses |= _wheel_rates(held_car, axle, free, springs)
    return Compliance(chosen, V.shape[1], values, "" if V.shape[1] else _rigid_sentence(car, chosen))


def compliance_fidelity(car: Car, fidelity: Fidelity | int | str | None) -> Fidelity:
    """The fidelity at which compliance is computed.

    `fidelity`: a member, its number, also as text, or its name; None: the most accurate one of the car. Raises
    `ModelError` if there is none, or the car has no frame for it.
    """
    offered = tuple(car.fidelities())
    if fidelity is None:
        return Fidelity.DYNAMIC if Fidelity.DYNAMIC in offered else Fidelity.RIGID
    chosen = Fidelity.of(int(fidelity) if isinstance(fidelity, str) and fidelity.isdecimal() else fidelity)
    if chosen not in offered and (chosen is Fidelity.RIGID or len(offered) == 1):
        why = f": its frame does not fit it. {car.misfit}" if car.misfit else "."
        raise ModelError(f"The car '{car.name}' has fidelity 0 only, not {chosen.value}{why}")
    return chosen


def _rigid_sentence(car: Car, fidelity: Fidelity) -> str:
    """Sentence on why all compliances are zero."""
    if fidelity is not Fidelity.RIGID:
        reason = f"at fidelity {fidelity.value} the chassis is {fidelity.description}"
    elif car.misfit:
        reason = f"the chassis is rigid, because its frame does not fit the car ({car.misfit})"
    elif car.chassis.frame is None:
        reason = "the chassis is rigid: the car's file has no frame"
    else:
        reason = "the chassis is rigid at fidelity 0"
    return (
        f"Toe and camber do not give under forces at the contact centres: links and joints are rigid, and {reason}. "
        "All compliances are exactly zero."
    )


def _responses(held_car: HeldCar, axle: str, V: Array, flexibility: Array) -> dict[str, float]:
    """Responses of the left wheel of an axle by load, sense and name."""
    left, right = (held_car.wheels[axle[0].upper() + side] for side in "LR")
    responses = {}
    for load in LOADS:
        for sense, sign in DIRECTIONS.items():
            displacement = V @ (flexibility @ (V.T @ (_unit_load(left, load) + sign * _unit_load(right, load))))
            for name, row in _response_rows(left).items():
                responses[f"{load}.{sense}.{name}"] = float(row @ displacement) + 0.0
    return responses


def _unit_load(wheel: HeldWheel, load: str) -> Array:
    """Generalised force of a unit load on a wheel carrier, shape (nq,)."""
    unit_loads = {
        "lateral_force": wheel.contact[1],
        "longitudinal_force": wheel.contact[0],
        "drive_force": wheel.centre[0],
        "aligning_torque": wheel.turn[2],
    }
    return np.asarray(unit_loads[load])


def _response_rows(wheel: HeldWheel) -> dict[str, Array]:
    """Rows of the responses of a wheel by coordinates, shape (nq,)."""
    return {
        "steer_angle": -wheel.axis[0],
        "inclination_angle": wheel.axis[2],
        "contact_y": wheel.contact[1],
        "centre_x": wheel.centre[0],
    }


def _wheel_rates(held_car: HeldCar, axle: str, V: Array, flexibility: Array) -> dict[str, float]:
    """Load of a wheel per rise of its contact centre, N/m, for equal and for opposite loads of both wheels."""
    left, right = (held_car.wheels[axle[0].upper() + side] for side in "LR")
    rates = {}
    for name, sign in (("wheel_rate", 1.0), ("roll_wheel_rate", -1.0)):
        displacement = V @ (flexibility @ (V.T @ (left.contact[2] + sign * right.contact[2])))
        rates[name] = 1.0 / float(left.contact[2] @ displacement)
    return rates
