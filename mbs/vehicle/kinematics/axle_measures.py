"""Kinematic measures of an axle at one position: wheel angles, ratios, wheel rates, roll centre, anti-dive.

Roll centre: intersection of the middle plane with the line through a contact centre, perpendicular to its velocity as
the chassis rolls; the height above the ground is the mean of both sides. Equal lateral forces then do not roll the
chassis (J. C. Dixon, "Suspension Geometry and Computation", Wiley; W. Matschinsky, "Road Vehicle Suspensions").

Anti-dive, anti-lift, anti-squat: with the fraction s of the longitudinal force on the axle, the wheelbase l and the
height h of the centre of mass, s |dx/dz| l/h is the fraction of the load transfer in the links (W. F. and D. L.
Milliken, "Race Car Vehicle Dynamics", chapter 17). Under braking dx/dz is taken of the carrier's point at the contact
centre, as the brake holds the wheel on its carrier; under drive it is taken of the wheel centre, as the chassis carries
the torque.
"""

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.kinematics.wheel_loads import SINGLE, wheel_loads
from mbs.vehicle.kinematics.wheel_motion import WheelMotion, steering_axis, wheel_motion
from mbs.vehicle.linkages.continuation import HEAVE, ROLL
from mbs.vehicle.linkages.linkage import SIDES, Linkage, Position

Array = NDArray[np.float64]


def wheel_measures(linkage: Linkage, position: Position) -> dict[str, float]:
    """Angles, positions and lengths at both wheels, by column name.

    Returns
    -------
    dict of str to float
        In SI units; without the columns of the steering axis if there is none, as on a twist beam.
    """
    measures: dict[str, float] = {}
    for k, side in enumerate(SIDES):
        w = wheel_motion(linkage, position, k)
        values = {
            "wheel_travel": float(position.travel[k]),
            "steer_angle": w.steer,
            "toe_angle": -w.side * w.steer,
            "inclination_angle": w.inclination,
            "camber_angle": -w.side * w.inclination,
        }
        axis = steering_axis(linkage, position, k)
        if axis is not None:
            values["caster_angle"], values["kingpin_inclination_angle"] = axis.caster, axis.inclination(w.side)
            for name, centre in (("ground", w.contact), ("wheel_centre", w.centre)):
                caster, kingpin = axis.offsets(w, centre)
                values["caster_trail" if name == "ground" else f"caster_offset_at_{name}"] = caster
                values[f"kingpin_offset_at_{name}"] = kingpin
        values |= {f"contact_centre_{c}": float(v) for c, v in zip("xyz", w.contact, strict=True)}
        values |= {f"wheel_centre_{c}": float(v) for c, v in zip("xy", w.centre, strict=False)}
        values["spring_length"] = linkage.length(linkage.springs[k], position.q)[0]
        values["damper_length"] = linkage.length(linkage.dampers[k], position.q)[0]
        measures |= {f"{name}_{side}": value for name, value in values.items()}
    return measures


def travel_measures(linkage: Linkage, position: Position, direction: Array) -> dict[str, float]:
    """Gradients, ratios, loads and rates along a direction of wheel travel, by column name, in SI units.

    `direction`: rates of the travels of the left and the right wheel, and of the rack, shape (3,).
    """
    measures: dict[str, float] = {}
    wheels = [wheel_motion(linkage, position, k) for k in range(2)]
    loads, slopes = wheel_loads(linkage, position, direction)
    tyre = linkage.data.tyre.stiffness
    for k, (side, w) in enumerate(zip(SIDES, wheels, strict=True)):
        scaled = direction / direction[k] if direction[k] else SINGLE[k]
        values = {
            "toe_gradient": -w.side * float(w.steer_rate @ scaled),
            "camber_gradient": -w.side * float(w.inclination_rate @ scaled),
            "spring_ratio": -float(linkage.length(linkage.springs[k], position.q)[1] @ position.tangent @ scaled),
            "damper_ratio": -float(linkage.length(linkage.dampers[k], position.q)[1] @ position.tangent @ scaled),
            "spring_load": float(loads[k]),
        }
        if direction[k]:
            values["wheel_rate"] = rate = float(slopes[k] / direction[k])
            values["ride_rate"] = rate * tyre / (rate + tyre)
        measures |= {f"{name}_{side}": value for name, value in values.items()}
    measures["roll_centre_height"] = roll_centre_height(wheels)
    if linkage.levers:
        twist = linkage.full(linkage.levers[0])[0] - linkage.full(linkage.levers[1])[0]
        measures["anti_roll_bar_ratio"] = 0.5 * float(twist @ position.tangent @ ROLL)
    return measures | anti_measures(linkage.car, linkage.name, wheels)


def roll_measures(linkage: Linkage, position: Position) -> dict[str, float]:
    """Roll angle, roll steer, roll camber and roll stiffness of the chassis, by column name, in SI units."""
    left, right = (wheel_motion(linkage, position, k) for k in range(2))
    # roll angle per travel of the left wheel, with the opposite travel of the right one
    track, roll_per_travel = linkage.data.track, -2.0 / linkage.data.track
    offsets = (w.side * (w.contact[1] - w.centre[1]) for w in (left, right))
    contact_track = track + float(sum(offsets))  # between the contact centres
    # positive: the ground rises to the left
    ground_slope = float((left.contact_rise - right.contact_rise) @ ROLL) / contact_track
    steer = 0.5 * float((left.steer_rate + right.steer_rate) @ ROLL)
    inclination = 0.5 * float((left.inclination_rate + right.inclination_rate) @ ROLL)
    slopes = wheel_loads(linkage, position, ROLL)[1]
    return {
        "suspension_roll_angle": float(position.travel[1] - position.travel[0]) / track,
        "roll_steer": steer / roll_per_travel,
        "roll_camber": (inclination - ground_slope) / roll_per_travel,
        "roll_stiffness": 0.25 * track * contact_track * float(slopes[0] - slopes[1]),
    }


def roll_centre_height(wheels: list[WheelMotion]) -> float:
    """Height of the roll centre above the ground, m. `wheels`: left and right."""
    heights = []
    for w in wheels:
        rate = w.fixed_contact_rate @ ROLL
        heights.append(w.contact[2] + w.contact[1] * rate[1] / rate[2])
    left, right = (w.contact for w in wheels)
    ground = left[2] - left[1] * (right[2] - left[2]) / (right[1] - left[1])
    return float(0.5 * sum(heights) - ground)


def anti_measures(car: CarContent, axle: str, wheels: list[WheelMotion]) -> dict[str, float]:
    """Anti-dive or anti-lift under braking, and anti-squat or anti-lift under drive on a driven axle, %.

    `wheels`: left and right.
    """
    lever = 100.0 * car.wheelbase / car.vehicle.reference_point[2]
    sign = 1.0 if axle == "front" else -1.0
    braked, driven = (np.mean([float(r[0] / r[2]) for r in rates]) for rates in _heave_rates(wheels))
    measures = {"anti_dive" if axle == "front" else "anti_lift": brake_fraction(car, axle) * sign * braked * lever}
    if car.drive.wheels == axle:
        measures["anti_lift_in_drive" if axle == "front" else "anti_squat"] = sign * driven * lever
    return {name: float(value) for name, value in measures.items()}


def brake_fraction(car: CarContent, axle: str) -> float:
    """Fraction of the braking force on an axle on a level road, from brake balance and wheel radii."""
    front = car.brakes.balance / car.front.wheel.centre[2]
    rear = (1.0 - car.brakes.balance) / car.rear.wheel.centre[2]
    return (front if axle == "front" else rear) / (front + rear)


def _heave_rates(wheels: list[WheelMotion]) -> tuple[list[Array], list[Array]]:
    """Displacement rates in heave of the carrier points at the contact centres, and of the wheel centres."""
    return [w.fixed_contact_rate @ HEAVE for w in wheels], [w.centre_rate @ HEAVE for w in wheels]
