"""Steers a car along the x axis, by PythonFMU: pythonfmu build -f examples/controllers/course_holder.py"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

OFFSET, HEADING, YAW_RATE = 0.3, 2.0, 0.2  # steering per m, rad and rad/s
INPUTS = ["y", "yaw", "yaw_rate"]


class CourseHolder(Fmi2Slave):
    """Steers against offset, heading and yaw rate, up to full lock."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in [*INPUTS, "steering"]:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality[("output", "input")[name in INPUTS]]))

    def exit_initialization_mode(self):
        self.do_step(0.0, 0.0)

    def do_step(self, current_time, step_size):
        demand = -OFFSET * self.y - HEADING * self.yaw - YAW_RATE * self.yaw_rate
        self.steering = min(max(demand, -1.0), 1.0)
        return True
