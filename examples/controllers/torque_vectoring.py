"""Turns a car by torques of hub motors, by PythonFMU: pythonfmu build -f examples/controllers/torque_vectoring.py"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

WHEELBASE, STEERED, UNDERSTEER = 1.68, 0.5, 0.0015  # m, rad of the front wheels at full lock, rad s2/m
GAIN, MAX_TORQUE = 1500.0, 250.0  # N m per rad/s and of each motor
INPUTS, OUTPUTS = ["speed", "yaw_rate", "steering", "demand", "on"], ["torque_RL", "torque_RR"]


class TorqueVectoring(Fmi2Slave):
    """More torque to the wheel outside the turn, while the car yaws less than a neutral one would; `on` = 0: equal."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in INPUTS + OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality[("output", "input")[name in INPUTS]]))

    def exit_initialization_mode(self):
        self.do_step(0.0, 0.0)

    def do_step(self, current_time, step_size):
        reference_yaw_rate = self.speed * STEERED * self.steering / (WHEELBASE + UNDERSTEER * self.speed**2)
        yaw_torque = self.on * GAIN * (reference_yaw_rate - self.yaw_rate)
        for name, sign in (("torque_RL", -1.0), ("torque_RR", 1.0)):
            setattr(self, name, min(max(0.5 * self.demand + sign * yaw_torque, -MAX_TORQUE), MAX_TORQUE))
        return True
