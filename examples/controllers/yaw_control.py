"""Keeps a car from spinning by its brakes, by PythonFMU: pythonfmu build -f examples/controllers/yaw_control.py"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

WHEELBASE, STEERED, UNDERSTEER = 1.68, 0.5, 0.0015  # m, rad of the front wheels at full lock, rad s2/m
GRIP, FREE = 8.0, 0.05  # m/s2 that the road holds, rad/s of yaw that are left alone
GAIN, MAX_TORQUE = 4000.0, 650.0  # N m per rad/s, N m of a brake
INPUTS, OUTPUTS = ["speed", "yaw_rate", "steering", "on"], ["torque_FL", "torque_FR"]


class YawControl(Fmi2Slave):
    """Brakes the front wheel outside the turn while the car yaws more than it is steered to; `on` = 0: never."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in INPUTS + OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality[("output", "input")[name in INPUTS]]))

    def do_step(self, current_time, step_size):
        reference_yaw_rate = self.speed * STEERED * self.steering / (WHEELBASE + UNDERSTEER * self.speed**2)
        yaw_rate_limit = GRIP / max(self.speed, 1.0)
        error = self.yaw_rate - min(
            max(reference_yaw_rate, -yaw_rate_limit), yaw_rate_limit
        )  # positive: turned too far to the left
        torque = self.on * min(GAIN * max(abs(error) - FREE, 0.0), MAX_TORQUE)
        self.torque_FL, self.torque_FR = (torque, 0.0) if error < 0.0 else (0.0, torque)
        return True
