"""A slip controller of four brakes, by PythonFMU: pythonfmu build -f examples/controllers/slip_controller.py"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

RADIUS, SLIP = 0.255, 0.12  # m, 1
MAX_TORQUE = {"FL": 650.0, "FR": 650.0, "RL": 450.0, "RR": 450.0}  # N m of each brake
INPUTS, OUTPUTS = ["speed", "on", *(f"omega_{w}" for w in MAX_TORQUE)], [f"torque_{w}" for w in MAX_TORQUE]


class SlipController(Fmi2Slave):
    """Lets a brake go while its wheel slips by more than SLIP, the faster the more; `on` = 0: wheels lock."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in INPUTS + OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality[("output", "input")[name in INPUTS]]))

    def do_step(self, current_time, step_size):
        for wheel, max_torque in MAX_TORQUE.items():
            excess = 1.0 - getattr(self, f"omega_{wheel}") * RADIUS / max(self.speed, 0.5) - SLIP
            slips = self.on and self.speed > 1.5 and excess > 0.0
            rate = -15e3 * min(max(10.0 * excess, 0.3), 3.0) if slips else 3e3 if self.on else 20e3  # N m/s
            torque = getattr(self, f"torque_{wheel}") + step_size * rate
            setattr(self, f"torque_{wheel}", min(max(torque, 0.0), max_torque))
        return True
