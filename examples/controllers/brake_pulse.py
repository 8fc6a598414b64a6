"""Brakes a car for a while, by PythonFMU: pythonfmu build -f examples/controllers/brake_pulse.py"""

from math import pi, sin

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

BEGIN, LAST, BRAKE, THROTTLE = 1.0, 2.5, 0.4, 0.05  # s, s, pedals


class BrakePulse(Fmi2Slave):
    """The pedals of a driver ahead: a little throttle, and once the brake, in a squared sine."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.brake, self.throttle = 0.0, THROTTLE
        for name in ("brake", "throttle"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        phase = min(max((current_time + step_size - BEGIN) / LAST, 0.0), 1.0)
        self.brake = BRAKE * sin(pi * phase) ** 2
        return True
