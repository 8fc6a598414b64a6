"""A kinematics and compliance rig: guides move the chassis of a car whose wheels stand on ice.

The chassis heaves, rolls about the x axis of the design position, or is fixed while the steering moves from lock to
lock; slowly, so that inertia is negligible. All results are slopes at the design position, from the part with motion
in one direction: damper forces there are equal on both sides of the design position.
"""

import numpy as np
from numpy.typing import NDArray

from mbs import Trajectory, compile, simulate
from mbs.common.affine import Affine, AffineVector
from mbs.elements.road import PlaneRoad
from mbs.model.model import Model
from mbs.vehicle import Car

DURATION = 4.0  # s
STEP = 0.002  # s
HEAVE = 0.04  # amplitude, m
ROLL = np.radians(3.0)  # amplitude, rad
FIT_RANGES = {"travel": 0.01, "roll": np.radians(1.0), "angle": 0.5}  # m, rad, rad
WHEELS = {"front": ("FL", "FR"), "rear": ("RL", "RR")}
NEUTRAL = {"drive.creep_torque": 0.0}


def kinematics(car: Car) -> dict[str, float]:
    """Kinematics and stiffnesses of both axles about the design position, in the terms of ISO 8855.

    Keys begin with ``front.`` or ``rear.``. Per wheel travel: ``wheel_rate`` (N/m), ``spring_ratio``, ``bump_steer``
    (rad/m, left wheel, toe-out positive), ``bump_camber`` (rad/m, left wheel, top outwards positive). Per suspension
    roll angle, the roll angle of the chassis minus the roll angle of the axle on its tyres: ``roll_centre_height`` (m),
    ``roll_steer`` (mean steering angle, to the left positive as the left side rises), ``roll_camber`` (left wheel
    against the axle), ``roll_stiffness`` (N m/rad). Without an axle: ``steering_ratio`` straight ahead, ``lock_inner``
    and ``lock_outer`` (rad).
    """
    heave, roll, steer = (simulate_motion(car, kind) for kind in ("heave", "roll", "steer"))
    results: dict[str, float] = {}
    for axle, (left, right) in WHEELS.items():
        z = heave[f"wheel_{left}.travel"]
        track = getattr(car, axle).track
        for name, values in (
            ("wheel_rate", heave[f"wheel_{left}.Fz"]),
            ("spring_ratio", -heave[f"spring_{left}.length"]),
            ("bump_steer", heave[f"wheel_{left}.steer"]),
            ("bump_camber", -heave[f"wheel_{left}.inclination"]),
        ):
            results[f"{axle}.{name}"] = slope(z, values, FIT_RANGES["travel"])
        phi = (roll[f"wheel_{right}.travel"] - roll[f"wheel_{left}.travel"]) / track
        tilt = roll["chassis.roll"] - phi  # roll angle of the axle on its tyres
        shift = 0.5 * (contact_y(roll, left) + contact_y(roll, right))
        moment = 0.5 * track * (roll[f"wheel_{right}.Fz"] - roll[f"wheel_{left}.Fz"])
        for name, values in (
            ("roll_centre_height", -shift),
            ("roll_steer", 0.5 * (roll[f"wheel_{left}.steer"] + roll[f"wheel_{right}.steer"])),
            ("roll_camber", roll[f"wheel_{left}.inclination"] - tilt),
            ("roll_stiffness", moment),
        ):
            results[f"{axle}.{name}"] = slope(phi, values, FIT_RANGES["roll"])
    angle = steer["steering_wheel_angle"]
    mean = 0.5 * (steer["wheel_FL.steer"] + steer["wheel_FR.steer"])
    results["steering_ratio"] = 1.0 / slope(angle, mean, FIT_RANGES["angle"])
    results["lock_inner"], results["lock_outer"] = steer["wheel_FL.steer"][-1], steer["wheel_FR.steer"][-1]
    return results


def simulate_motion(car: Car, motion: str) -> Trajectory:
    """Simulate one slow period of ``heave``, ``roll`` or ``steer``, with the sensors of the car and of
    `_add_wheel_sensors`.
    """
    m = car.model(PlaneRoad(friction=0.0))
    m.start_in_equilibrium = False
    m.equilibrium_parameters = {}
    _drive_chassis(m, car, HEAVE if motion == "heave" else 0.0, float(np.sin(ROLL)) if motion == "roll" else 0.0)
    _add_wheel_sensors(m)
    system = compile(m)
    parameters = {name: v for name, v in NEUTRAL.items() if name in {p["name"] for p in system.meta["parameters"]}}
    times = [0.0, 0.05 * DURATION, 0.95 * DURATION, DURATION]
    inputs = {"steering": (times, [0.0, -1.0, 1.0, 1.0])} if motion == "steer" else None
    return simulate(system, DURATION, STEP, inputs, None, parameters, progress=False, estimate_error=False)


def slope(x: NDArray[np.float64], y: NDArray[np.float64], near: float) -> float:
    """Slope at zero of a cubic fitted to the points with ``|x| < near`` in the middle half of a motion."""
    in_range = np.abs(x) < near
    in_range[: len(x) // 4] = in_range[-(len(x) // 4) :] = False
    return float(np.polyfit(x[in_range], y[in_range], 3)[-2])


def contact_y(run: Trajectory, wheel: str) -> NDArray[np.float64]:
    """Lateral position of a wheel's contact point, m, shape (n,)."""
    y, z, a_y, a_z = (run[f"rig_{wheel}.{name}"] for name in ("y", "z", "ay", "az"))
    return np.asarray(y + z * a_z * a_y / (1.0 - a_z**2))


def _drive_chassis(m: Model, car: Car, heave: float, roll: float) -> None:
    """Prescribe all degrees of freedom of the chassis on the rig. `heave`: amplitude, m; `roll`: sine of the largest
    roll angle.
    """
    chassis = next(body for body in m.bodies if body.name == "chassis")
    t = np.linspace(0.0, DURATION, 81)
    wave = np.sin(2.0 * np.pi * np.clip((t / DURATION - 0.05) / 0.9, 0.0, 1.0))
    still, up, over = (
        m.guide_time(f"rig {name}", (t, size * wave), unit="m")
        for name, size in (("still", 0.0), ("heave", heave), ("roll", roll))
    )
    base = np.array([car.vehicle.reference_point[0], 0.0, 0.0])
    at, ahead, beside = (chassis.point(base + e) for e in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    for name, value, start, guide in (
        ("x", at[0], base[0], still),
        ("y", at[1], 0.0, still),
        ("z", at[2], 0.0, up),
        ("yaw", ahead[1] - at[1], 0.0, still),
        ("pitch", ahead[2] - at[2], 0.0, still),
        ("roll", beside[2] - at[2], 0.0, over),
    ):
        m.drive(f"rig {name}", value + Affine({}, -start), guide)


def _add_wheel_sensors(m: Model) -> None:
    """Add sensors of y and z of the wheel centres, ``rig_FL.y`` (m), and of their axes, ``rig_FL.ay``."""
    axes = {c: AffineVector.constant(e) for c, e in zip("xyz", np.eye(3), strict=True)}
    for spin in m.spins:
        wheel = spin.name.removeprefix("wheel ")
        for c in "yz":
            m.sense_vector(f"rig_{wheel}.{c}", spin.centre, [axes[c]])
            m.sense_vector(f"rig_{wheel}.a{c}", spin.axis, [axes[c]])
