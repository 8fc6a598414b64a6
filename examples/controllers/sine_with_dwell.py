"""Steers a sine with dwell of ISO 19365, by PythonFMU: pythonfmu build -f examples/controllers/sine_with_dwell.py"""

from math import pi, sin

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

FREQUENCY, DWELL, START = 0.7, 0.5, 0.5  # Hz, s at the second peak, s


class SineWithDwell(Fmi2Slave):
    """One period from START that waits at its second peak; positive to the left, first to the left."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.amplitude, self.steering = 0.3, 0.0
        parameter = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
        self.register_variable(Real("amplitude", **parameter))
        self.register_variable(Real("steering", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        t, peak = current_time + step_size - START, 0.75 / FREQUENCY
        t = t if t < peak else max(peak, t - DWELL)
        self.steering = self.amplitude * sin(2.0 * pi * FREQUENCY * t) if 0.0 < t < 1.0 / FREQUENCY else 0.0
        return True
