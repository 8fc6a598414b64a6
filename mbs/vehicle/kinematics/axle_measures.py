"""What an axle is at one position: from the wheels' motions, the steering axes and the forces of springs and bars.

Roll centre: the line from a contact centre square to its way, as the chassis rolls, meets the middle plane at a height;
the mean of both sides over the ground. Lateral forces of equal size on both wheels then do not roll the chassis
(J. C. Dixon, "Suspension Geometry and Computation", Wiley; W. Matschinsky, "Road Vehicle Suspensions").

Anti-dive and its like: with s the share of the axle in the longitudinal force, l the wheelbase and h the height of the
centre of mass, s |dx/dz| l/h is the share of the load transfer that goes through the links (W. F. and D. L. Milliken,
"Race Car Vehicle Dynamics", chapter 17). Brakes hold the wheel on its carrier: dx/dz is that of the carrier's point at
the contact centre. The drive's torque is carried by the chassis: dx/dz is that of the wheel's centre.
"""

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import AffineVector
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.kinematics.wheel_loads import OWN, wheel_loads
from mbs.vehicle.kinematics.wheel_motion import WheelMotion, steering_axis, wheel_motion
from mbs.vehicle.linkages.continuation import HEAVE, ROLL
from mbs.vehicle.linkages.linkage import SIDES, Linkage, Position

Array = NDArray[np.float64]


def wheel_measures(linkage: Linkage, at: Position) -> dict[str, float]:
    """Columns of both wheels.

    Returns
    -------
    dict of str to float
        In SI units; what there is not, as the steering axis of a twist beam, is left out.
    """
    found: dict[str, float] = {}
    for k, side in enumerate(SIDES):
        w = wheel_motion(linkage, at, k)
        values = {
            "wheel_travel": float(at.travel[k]),
            "steer_angle": w.steer,
            "toe_angle": -w.side * w.steer,
            "inclination_angle": w.inclination,
            "camber_angle": -w.side * w.inclination,
        }
        axis = steering_axis(linkage, at, k)
        if axis is not None:
            values["caster_angle"], values["kingpin_inclination_angle"] = axis.caster, axis.inclination(w.side)
            for name, centre in (("ground", w.contact), ("wheel_centre", w.centre)):
                ahead, inside = axis.offsets(w, centre)
                values["caster_trail" if name == "ground" else f"caster_offset_at_{name}"] = ahead
                values[f"kingpin_offset_at_{name}"] = inside
        values |= {f"contact_centre_{c}": float(v) for c, v in zip("xyz", w.contact, strict=True)}
        values |= {f"wheel_centre_{c}": float(v) for c, v in zip("xy", w.centre, strict=False)}
        values["spring_length"] = length(linkage, linkage.springs[k], at)
        values["damper_length"] = length(linkage, linkage.dampers[k], at)
        found |= {f"{name}_{side}": value for name, value in values.items()}
    return found


def travel_measures(linkage: Linkage, at: Position, direction: Array) -> dict[str, float]:
    """Columns that belong to a direction of wheel travel, in SI units.

    `direction`: rates of the travels of the left and the right wheel, and of the rack, shape (3,).
    """
    found: dict[str, float] = {}
    wheels = [wheel_motion(linkage, at, k) for k in range(2)]
    loads, slopes = wheel_loads(linkage, at, direction)
    tyre = linkage.data.tyre.stiffness
    for k, (side, w) in enumerate(zip(SIDES, wheels, strict=True)):
        way = direction / direction[k] if direction[k] else OWN[k]
        values = {
            "toe_gradient": -w.side * float(w.steer_rate @ way),
            "camber_gradient": -w.side * float(w.inclination_rate @ way),
            "spring_ratio": -stretch(linkage, linkage.springs[k], at, way),
            "damper_ratio": -stretch(linkage, linkage.dampers[k], at, way),
            "spring_load": float(loads[k]),
        }
        if direction[k]:
            values["wheel_rate"] = rate = float(slopes[k] / direction[k])
            values["ride_rate"] = rate * tyre / (rate + tyre)
        found |= {f"{name}_{side}": value for name, value in values.items()}
    found["roll_centre_height"] = roll_centre_height(wheels)
    if linkage.levers:
        twist = linkage.full(linkage.levers[0])[0] - linkage.full(linkage.levers[1])[0]
        found["anti_roll_bar_ratio"] = 0.5 * float(twist @ at.tangent @ ROLL)
    return found | anti_measures(linkage.car, linkage.name, wheels)


def roll_measures(linkage: Linkage, at: Position) -> dict[str, float]:
    """More columns for opposite travel: what the chassis does as it rolls."""
    left, right = (wheel_motion(linkage, at, k) for k in range(2))
    track, per_angle = linkage.data.track, -2.0 / linkage.data.track  # travel of the right wheel less the left's
    wider = (w.side * (w.contact[1] - w.centre[1]) for w in (left, right))
    on_ground = track + float(sum(wider))  # between the contact centres, at the drawn width as the angle is
    ground = float((left.contact_rise - right.contact_rise) @ ROLL) / on_ground  # its slope, to the left upwards
    steer = 0.5 * float((left.steer_rate + right.steer_rate) @ ROLL)
    lean = 0.5 * float((left.inclination_rate + right.inclination_rate) @ ROLL)
    slopes = wheel_loads(linkage, at, ROLL)[1]
    return {
        "suspension_roll_angle": float(at.travel[1] - at.travel[0]) / track,
        "roll_steer": steer / per_angle,
        "roll_camber": (lean - ground) / per_angle,
        "roll_stiffness": 0.25 * track * on_ground * float(slopes[0] - slopes[1]),
    }


def roll_centre_height(wheels: list[WheelMotion]) -> float:
    """Height of the roll centre over the ground, m. `wheels`: left and right."""
    heights = []
    for w in wheels:
        way = w.fixed_contact_rate @ ROLL
        heights.append(w.contact[2] + w.contact[1] * way[1] / way[2])
    left, right = (w.contact for w in wheels)
    ground = left[2] - left[1] * (right[2] - left[2]) / (right[1] - left[1])
    return float(0.5 * sum(heights) - ground)


def anti_measures(car: CarContent, axle: str, wheels: list[WheelMotion]) -> dict[str, float]:
    """Anti-dive and its like, %.

    `car`: gives the shares, the wheelbase and the height of the centre of mass; `wheels`: left and right.
    """
    lever = 100.0 * car.wheelbase / car.vehicle.reference_point[2]
    forwards = 1.0 if axle == "front" else -1.0
    braked, driven = (np.mean([float(r[0] / r[2]) for r in rates]) for rates in _parallel_ways(wheels))
    found = {"anti_dive" if axle == "front" else "anti_lift": brake_share(car, axle) * forwards * braked * lever}
    if car.drive.wheels == axle:
        found["anti_lift_in_drive" if axle == "front" else "anti_squat"] = forwards * driven * lever
    return {name: float(value) for name, value in found.items()}


def brake_share(car: CarContent, axle: str) -> float:
    """Share of an axle in the braking force on the level road, by the balance of the brakes and the wheels' radii."""
    front = car.brakes.balance / car.front.wheel.centre[2]
    rear = (1.0 - car.brakes.balance) / car.rear.wheel.centre[2]
    return (front if axle == "front" else rear) / (front + rear)


def length(linkage: Linkage, line: AffineVector, at: Position) -> float:
    """Length of a spring or damper, m."""
    D, d = linkage.linear(line)
    return float(np.linalg.norm(D @ at.q + d))


def stretch(linkage: Linkage, line: AffineVector, at: Position, direction: Array) -> float:
    """Rate of that length along a direction.

    `direction`: rates of the travels of the left and the right wheel, and of the rack, shape (3,).
    """
    D, d = linkage.linear(line)
    way = D @ at.q + d
    return float(way @ (D @ (at.tangent @ direction)) / np.linalg.norm(way))


def _parallel_ways(wheels: list[WheelMotion]) -> tuple[list[Array], list[Array]]:
    """Ways in parallel travel of the carriers' points at the contact centres, and of the wheels' centres."""
    return [w.fixed_contact_rate @ HEAVE for w in wheels], [w.centre_rate @ HEAVE for w in wheels]
