"""A copy of the drive of the prototype in a second FMU."""

from typing import Any

from tests.hosts.systems.partner import Partner
from tests.vehicle.cars_with_ports import SecondDrive, rigid, throttle_at


class DrivePartner(Partner):
    """Computes drive torques from the speeds of the driven wheels alone, with a throttle by schedule."""

    inputs = ("omega_L", "omega_R")
    outputs = ("torque",)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.drive, self.time = SecondDrive(rigid()), 0.0

    def find(self, step: float) -> None:
        self.time += step
        left, right = (self.value[name] for name in self.inputs)
        self.value["torque"] = self.drive.torque(left, right, throttle_at(self.time), step)

    def memory(self) -> Any:
        return self.drive.states, self.time

    def recall(self, memory: Any) -> None:
        self.drive.states, self.time = memory
