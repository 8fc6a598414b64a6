"""Data of the prototype car of the paper (section 3.4): two seats, steel tubing and parts of old cars, 597 kg.

SI units. Earth axes in the reference configuration: x forward, y left, z up; origin on level ground under the centre of
the front axle, car in static equilibrium. Points are those of the left side; the right side mirrors y.

Published [P] in J. Cuadrado, M. Gonzalez, R. Gutierrez, M. A. Naya, "Real-time MBS formulations: towards virtual
engineering": total mass, springs and dampers, tyre radii and vertical stiffness, kerb, speed, duration, step.
Everything else is assumed [A]: no hardpoints, masses of parts or inertias of the real car are public; the set was
chosen so that every published number holds at once.
"""

from __future__ import annotations

from typing import Any

GRAVITY = 9.81
TOTAL_MASS = 597.0  # [P]
WHEELBASE = 2.300  # [A]
LENGTH, WIDTH = 3.2, 1.5  # outline without mirrors, centred on the origin of the vehicle axes [A]
REFERENCE_POINT = (-1.3046, 0.0, 0.3530)  # centre of mass of the whole car, origin of the vehicle axes [A]

FLOOR_CENTRE = (-1.100, 0.0, 0.160)  # node of the frame that carries the floating frame [A]

CHASSIS: dict[str, Any] = {  # frame, engine, driver, equipment [A]
    "mass": 476.0,
    "com": (-1.3321, 0.0, 0.3769),
    "inertia": ((77.9, 0.0, 14.6), (0.0, 420.9, 0.0), (14.6, 0.0, 457.7)),
}
ACCELEROMETERS = {  # at the corners of the chassis base [A]
    "FL": (0.45, 0.28, 0.19),
    "FR": (0.45, -0.28, 0.19),
    "RL": (-2.65, 0.30, 0.20),
    "RR": (-2.65, -0.30, 0.20),
}

FRONT = {  # double wishbones, coil-overs on the lower ones [A]
    "lower_pivot_front": (0.1500, 0.3000, 0.1650),
    "lower_pivot_rear": (-0.1500, 0.3000, 0.1650),
    "upper_pivot_front": (0.1300, 0.3500, 0.3720),
    "upper_pivot_rear": (-0.1300, 0.3500, 0.3720),
    "lower_ball_joint": (0.0050, 0.6000, 0.1500),
    "upper_ball_joint": (-0.0150, 0.5750, 0.3850),
    "tie_rod_inner": (-0.1457, 0.3109, 0.2100),  # at the end of the rack
    "tie_rod_outer": (-0.1250, 0.5720, 0.2032),
    "spring_lower": (0.0000, 0.5000, 0.1750),  # on the lower wishbone
    "spring_upper": (0.0000, 0.3800, 0.7850),  # on the chassis
    "wheel_centre": (0.0000, 0.6700, 0.2489),
}
FRONT_SPRING: dict[str, Any] = {"stiffness": 12360.0, "free_length": 0.750, "damping": 1000.0}  # [P]
FRONT_BODIES = {  # [A]
    "lower_wishbone": {"mass": 3.0, "com": (0.000, 0.420, 0.160), "inertia": (0.030, 0.025, 0.050)},
    "upper_wishbone": {"mass": 2.0, "com": (-0.005, 0.440, 0.377), "inertia": (0.012, 0.012, 0.022)},
    "upright": {"mass": 9.0, "com": (-0.005, 0.605, 0.255), "inertia": (0.060, 0.050, 0.050)},
}
FRONT_WHEEL = {"mass": 15.0, "spin_inertia": 0.55, "diametral_inertia": 0.32}  # [A]

REAR = {  # lower arm, strut, toe link; driven wheels [A]
    "lower_pivot_front": (-2.1200, 0.3000, 0.1900),
    "lower_pivot_rear": (-2.3800, 0.3000, 0.1900),
    "lower_ball_joint": (-2.3000, 0.5900, 0.1600),  # lower end of the spring; the strut axis goes on to its top
    "toe_link_inner": (-2.4800, 0.3000, 0.2000),
    "toe_link_outer": (-2.4300, 0.5850, 0.1716),
    "strut_top": (-2.3000, 0.4550, 0.9270),
    "wheel_centre": (-2.3000, 0.6600, 0.2623),
}
REAR_SPRING: dict[str, Any] = {"stiffness": 10595.0, "free_length": 0.916, "damping": 1000.0}  # [P]
REAR_BODIES = {  # [A]
    "lower_arm": {"mass": 3.5, "com": (-2.265, 0.430, 0.177), "inertia": (0.035, 0.020, 0.050)},
    "upright": {"mass": 12.0, "com": (-2.300, 0.585, 0.300), "inertia": (0.180, 0.160, 0.060)},
}
REAR_WHEEL = {"mass": 16.0, "spin_inertia": 0.70, "diametral_inertia": 0.40}  # [A]

RACK_TRAVEL = 0.060  # m each way; about 27 deg at the outer and 33 deg at the inner wheel [A]
RACK_PER_TURN = 0.042  # m per turn of the steering wheel [A]
# rad, mean of both wheels at RACK_TRAVEL; the standing car turns them by 0.5246 to 0.5256
FRONT_WHEEL_ANGLE_MAX = 0.525
RACK_FREQUENCY = 10.0  # Hz, of the follower between input and rack [A]

DRIVELINE: dict[str, Any] = {  # simple automatic, open differential [A]
    "max_torque": 110.0,
    "max_power": 50.0e3,
    "efficiency": 0.85,
    "stall_factor": 1.9,
    "creep_torque": 60.0,
    "ratios": (10.5, 5.9, 4.0),
}
BRAKE_TORQUE = {"front": 650.0, "rear": 450.0}  # N m per wheel at full pedal [A]
DRAG_AREA = 0.8  # m2 [A]
AIR_DENSITY = 1.2
