# ruff: noqa: B905
"""The slave of an FMU: a car with the names, units, signs and frames of other programs.

A single-track car with linear tyres, a roll angle that follows the lateral acceleration, and pedals; what is told
of it is chosen by `STYLE`, which is replaced when the FMU is built.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

STYLE = "ours"
MASS = 1200.0  # kg
INERTIA = 1800.0  # kg m2
FRONT = 1.1  # m, from the centre of mass to the axle
REAR = 1.4  # m
STIFFNESS_FRONT = 70000.0  # N/rad
STIFFNESS_REAR = 90000.0  # N/rad
LOCK = 8.0  # rad, largest angle of the steering wheel
RATIO = 16.0  # steering wheel to road wheels
PRESSURE = 12e6  # Pa
ROLL_PER_AY = 0.006  # rad s2/m
ROLL_TIME = 0.15  # s
POINT = (-0.35, 0.0, 0.25)  # of the reference frames that are not the centre of mass, from it
SUBSTEP = 0.001  # s
GRAVITY = 9.80665


class Car:
    """Motion of the centre of mass over a flat road; ISO 8855, SI."""

    def __init__(self):
        self.x = self.y = self.yaw = self.vy = self.wz = self.roll = self.wx = 0.0
        self.vx = 20.0
        self.steering = self.throttle = self.brake = 0.0

    def rates(self, state):
        """Rates of x, y, yaw, vx, vy, wz, roll and roll rate."""
        _, _, yaw, vx, vy, wz, roll, wx = state
        steer = self.steering * LOCK / RATIO
        v = max(vx, 1.0)
        front = -STIFFNESS_FRONT * (math.atan2(vy + FRONT * wz, v) - steer)
        rear = -STIFFNESS_REAR * math.atan2(vy - REAR * wz, v)
        push = 4000.0 * self.throttle - (9000.0 * self.brake if vx > 0.05 else 0.0) - 0.4 * vx * vx
        ax, ay = (push - front * math.sin(steer)) / MASS, (front * math.cos(steer) + rear) / MASS
        turn = (FRONT * front * math.cos(steer) - REAR * rear) / INERTIA
        sway = (ROLL_PER_AY * ay - roll) / ROLL_TIME**2 - 1.4 * wx / ROLL_TIME
        c, s = math.cos(yaw), math.sin(yaw)
        return (vx * c - vy * s, vx * s + vy * c, wz, ax + wz * vy, ay - wz * vx, turn, wx, sway)

    @property
    def state(self):
        return (self.x, self.y, self.yaw, self.vx, self.vy, self.wz, self.roll, self.wx)

    def advance(self, h):
        """Integrate over `h`, s, by Heun's method with steps of about `SUBSTEP`, s."""
        n = max(1, round(h / SUBSTEP))
        for _ in range(n):
            s = self.state
            k1 = self.rates(s)
            k2 = self.rates(tuple(a + h / n * b for a, b in zip(s, k1)))
            s = tuple(a + 0.5 * h / n * (b + c) for a, b, c in zip(s, k1, k2))
            self.x, self.y, self.yaw, self.vx, self.vy, self.wz, self.roll, self.wx = s
            self.vx = max(self.vx, 0.0)

    def motion(self):
        """Axes in the earth's; velocity, acceleration, angular velocity and its rate in those of the rolled body."""
        _, _, _, dvx, dvy, turn, _, sway = self.rates(self.state)
        level = (dvx - self.wz * self.vy, dvy + self.wz * self.vx, 0.0)
        c, s, cr, sr = math.cos(self.yaw), math.sin(self.yaw), math.cos(self.roll), math.sin(self.roll)
        axes = ((c, s, 0.0), (-s * cr, c * cr, sr), (s * sr, -c * sr, cr))

        def rolled(v):
            return (v[0], v[1] * cr + v[2] * sr, -v[1] * sr + v[2] * cr)

        rate = (self.wx, self.wz * sr, self.wz * cr)
        # The angular velocity is roll rate along x and wz along the vertical; its rate in the body's own axes.
        change = (sway, turn * sr + self.wz * cr * self.wx, turn * cr - self.wz * sr * self.wx)
        return axes, rolled((self.vx, self.vy, 0.0)), rolled(level), rate, change


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def plus(*vectors):
    return tuple(sum(v) for v in zip(*vectors))


def to_earth(axes, v):
    return tuple(sum(axes[k][j] * v[k] for k in range(3)) for j in range(3))


def quaternion(yaw, roll):
    """Unit quaternion, scalar first."""
    cy, sy, cr, sr = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(roll / 2), math.sin(roll / 2)
    return (cy * cr, cy * sr, sy * sr, sy * cr)


def quaternion_rate(q, w):
    """Half of the quaternion times the angular velocity in body axes."""
    v = q[1:]
    vector = plus(tuple(q[0] * x for x in w), cross(v, w))
    return (-0.5 * sum(a * b for a, b in zip(v, w)), *(0.5 * x for x in vector))


def outputs_of(style, car):
    """All outputs of a style by name, and their units."""
    axes, v, a, w, dw = car.motion()
    position = (car.x, car.y, 0.5)
    deg = math.pi / 180.0
    angle = car.steering * LOCK
    moved = plus(v, cross(w, POINT))
    moved_a = plus(a, cross(dw, POINT), cross(w, cross(w, POINT)))
    place = plus(position, to_earth(axes, POINT))
    wrapped = math.remainder(car.yaw, 2.0 * math.pi)
    slip = math.atan2(v[1], v[0]) if math.hypot(v[0], v[1]) >= 0.1 else 0.0
    speed = math.sqrt(sum(x * x for x in v))
    if style == "ours":
        outputs = dict(zip(("chassis.x", "chassis.y", "chassis.z"), position))
        outputs |= {"chassis.yaw": car.yaw, "chassis.pitch": 0.0, "chassis.roll": car.roll}
        for name, vector in (("v", v), ("a", a), ("w", w)):
            outputs |= {f"chassis.{name}{axis}": x for axis, x in zip("xyz", vector)}
        return outputs | {"speed": speed, "sideslip": slip, "steering_wheel_angle": angle}
    if style == "carmaker":
        outputs = dict(zip(("Car.tx", "Car.ty", "Car.tz"), position))
        outputs |= {
            "Car.Yaw": car.yaw,
            "Car.Pitch": 0.0,
            "Car.Roll": car.roll,
            "Car.v": speed,
            "Car.SideSlipAngle": slip,
        }
        outputs |= dict(zip(("Car.vx", "Car.vy", "Car.vz", "Car.ax", "Car.ay", "Car.az"), (*v, *a)))
        return outputs | dict(zip(("Car.RollVel", "Car.PitchVel", "Car.YawRate"), w)) | {"VC.Steer.Ang": angle}
    if style == "carsim":
        outputs = dict(zip(("XCG_TM", "YCG_TM", "ZCG_TM"), position))
        outputs |= {
            "Yaw": car.yaw / deg,
            "Pitch": 0.0,
            "Roll": car.roll / deg,
            "Beta": slip / deg,
            "Steer_SW": angle / deg,
        }
        # Along axes that do not roll, as CarSim has them.
        c, s = math.cos(car.roll), math.sin(car.roll)
        outputs |= dict(zip(("Vx", "Vy", "Vz"), (3.6 * v[0], 3.6 * (c * v[1] - s * v[2]), 3.6 * (s * v[1] + c * v[2]))))
        outputs |= dict(zip(("AVx", "AVy", "AVz"), (x / deg for x in w)))
        level = (a[0], c * a[1] - s * a[2], s * a[1] + c * a[2])
        return outputs | dict(zip(("Ax", "Ay", "Az"), (x / GRAVITY for x in level)))
    q = quaternion(car.yaw, car.roll)
    if style == "chrono":
        outputs = {f"ref_frame.pos.{axis}": x for axis, x in zip("xyz", place)}
        outputs |= {f"ref_frame.pos_dt.{axis}": x for axis, x in zip("xyz", to_earth(axes, moved))}
        outputs |= {f"ref_frame.rot.e{k}": x for k, x in enumerate(q)}
        return outputs | {f"ref_frame.rot_dt.e{k}": x for k, x in enumerate(quaternion_rate(q, w))}
    if style == "osi":
        base = "moving_object.base."
        outputs = {
            base + "orientation.yaw": wrapped,
            base + "orientation.pitch": 0.0,
            base + "orientation.roll": car.roll,
        }
        fields = (("position", place), ("velocity", to_earth(axes, moved)), ("acceleration", to_earth(axes, moved_a)))
        for name, vector in fields:
            outputs |= {f"{base}{name}.{axis}": x for axis, x in zip("xyz", vector)}
        rate = to_earth(axes, w)
        return outputs | {f"{base}orientation_rate.{name}": x for name, x in zip(("roll", "pitch", "yaw"), rate)}
    assert style == "vehicle_interfaces"
    outputs = {f"chassis.body.Q[{k + 1}]": x for k, x in enumerate((*q[1:], q[0]))}
    for name, vector in (("r_0", position), ("v_0", to_earth(axes, v)), ("a_0", to_earth(axes, a)), ("w_a", w)):
        outputs |= {f"chassis.body.{name}[{k + 1}]": x for k, x in enumerate(vector)}
    return outputs | {"controlBus.chassisBus.longitudinalVelocity": v[0]}


# Name of an input, and what it is in terms of steering, throttle and brake from -1 or 0 to 1.
PEDALRY = "host_vehicle_data.vehicle_powertrain.pedalry.pedal_position_"
DRIVER = "controlBus.driverBus."
INPUTS = {
    "ours": (("steering", 1.0), ("throttle", 1.0), ("brake", 1.0)),
    "carmaker": (("DM.Steer.Ang", LOCK), ("DM.Gas", 1.0), ("DM.Brake", 1.0)),
    "carsim": (("IMP_STEER_SW", LOCK * 180.0 / math.pi), ("IMP_THROTTLE_ENGINE", 1.0), ("IMP_PCON_BK", PRESSURE / 1e6)),
    "chrono": (("steering", 1.0), ("throttle", 1.0), ("braking", 1.0)),
    "osi": (
        ("host_vehicle_data.vehicle_steering_wheel.angle", LOCK),
        (PEDALRY + "acceleration", 1.0),
        (PEDALRY + "brake", 1.0),
    ),
    "vehicle_interfaces": (
        (DRIVER + "steeringWheelAngle", LOCK),
        (DRIVER + "acceleratorPedalPosition", 1.0),
        (DRIVER + "brakePedalPosition", 1.0),
    ),
}


class ForeignCar(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.car, self.kept = Car(), (None, {})
        for ours, (theirs, largest) in zip(("steering", "throttle", "brake"), INPUTS[STYLE]):
            self.register_variable(
                Real(
                    theirs,
                    start=0.0,
                    causality=Fmi2Causality.input,
                    getter=lambda n=ours, m=largest: m * getattr(self.car, n),
                    setter=lambda x, n=ours, m=largest: setattr(self.car, n, x / m),
                )
            )
        for name in outputs_of(STYLE, self.car):
            self.register_variable(Real(name, causality=Fmi2Causality.output, getter=lambda n=name: self.output(n)))
        self.register_variable(
            Real(
                "initial.speed",
                start=20.0,
                causality=Fmi2Causality.parameter,
                variability=Fmi2Variability.fixed,
                getter=lambda: self.car.vx,
                setter=lambda x: setattr(self.car, "vx", x),
            )
        )

    def output(self, name):
        now = (self.car.state, self.car.steering, self.car.throttle, self.car.brake)
        if self.kept[0] != now:
            self.kept = (now, outputs_of(STYLE, self.car))
        return self.kept[1][name]

    def do_step(self, current_time, step_size):
        self.car.advance(step_size)
        return True
