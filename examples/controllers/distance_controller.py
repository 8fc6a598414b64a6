"""Keeps a distance behind a car, by PythonFMU: pythonfmu build -f examples/controllers/distance_controller.py"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

TIME_GAP, STANDSTILL, LENGTH = 1.2, 5.0, 3.0  # s, m, length of the car ahead in m
INPUTS, OUTPUTS = ["x", "speed", "x_ahead", "speed_ahead"], ["throttle", "brake", "gap"]


class DistanceController(Fmi2Slave):
    """A gap that grows with the speed, held by throttle and brake."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in INPUTS + OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality[("output", "input")[name in INPUTS]]))

    def exit_initialization_mode(self):
        self.do_step(0.0, 0.0)

    def do_step(self, current_time, step_size):
        self.gap = self.x_ahead - self.x - LENGTH
        desired_gap = STANDSTILL + TIME_GAP * self.speed
        demand = 0.25 * (self.gap - desired_gap) + 0.8 * (self.speed_ahead - self.speed)  # m/s2
        self.throttle = min(max(0.15 * demand + 0.08, 0.0), 1.0)
        self.brake = min(max(-0.1 * (demand + 0.8), 0.0), 1.0)
        return True
