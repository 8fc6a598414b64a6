"""Electric motor with a fixed ratio and an open differential."""

from collections.abc import Mapping
from typing import Literal

from mbs.elements.electric_drive import ElectricDrive
from mbs.model.carried_parts import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import (
    AngularSpeed,
    DriveRatio,
    Efficiency,
    FadeSpeed,
    MotorPower,
    MotorSpeed,
    RegenerationTorque,
    ReverseShare,
    RotorInertia,
    Time,
    Torque,
)
from mbs.vehicle.section import Section


class Electric(Section, of=ElectricDrive):
    """Drive by an electric motor."""

    kind: Literal["electric"]
    """Names this template."""
    wheels: Literal["front", "rear"]
    """Driven wheels."""
    max_torque: Torque
    max_power: MotorPower
    ratio: DriveRatio
    limit_speed: MotorSpeed
    motor_inertia: RotorInertia
    """Moment of inertia of the motor's rotor and of what turns with it, about its axis. Each driven wheel feels half of
    it times the ratio squared."""
    efficiency: Efficiency = ElectricDrive.efficiency
    gear_efficiency: Efficiency = ElectricDrive.gear_efficiency
    regeneration_torque: RegenerationTorque = ElectricDrive.regeneration_torque
    regeneration_power: MotorPower = ElectricDrive.regeneration_power
    regeneration_speed: FadeSpeed = ElectricDrive.regeneration_speed
    reverse_torque: ReverseShare = ElectricDrive.reverse_torque
    reverse_speed: MotorSpeed = ElectricDrive.reverse_speed
    engage_speed: AngularSpeed = ElectricDrive.engage_speed
    engage_time: Time = ElectricDrive.engage_time

    @property
    def torque_ratio(self) -> float:
        """Torque of both driven wheels together per torque of the motor."""
        return self.ratio * self.gear_efficiency

    def build(self, b: CarBuilder, spins: Mapping[str, Spin], *, neutral: bool) -> None:
        """Add the drive, whose reaction is on the chassis. `spins`: spins of the wheels, by name."""
        drive = self.element(ElectricDrive)
        left, right = (spins[self.wheels[0].upper() + side] for side in "LR")
        z, x = b.chassis.drive_axes  # the reaction is about the lateral axis of the chassis (z cross x = y)
        throttle, selector = b.inputs["throttle"].index, b.inputs.get("selector")
        selector_index = None if selector is None else selector.index
        element = b.m.add(
            drive.record("drive", left.coordinate, right.coordinate, z, x, throttle, selector=selector_index)
        )
        self.turning_parts(b, spins)
        b.tie_numbers(self, element)

    def turning_parts(self, b: CarBuilder, spins: Mapping[str, Spin]) -> None:
        """Add the inertia of the rotor to the driven wheels."""
        for spin in (spins[self.wheels[0].upper() + side] for side in "LR"):
            rotor = b.m.armature(f"rotor at {spin.name}", spin, inertia=0.5 * self.motor_inertia, ratio=self.ratio)
            b.tie(self, "ratio", rotor, "ratio")

    def outputs(self, b: CarBuilder) -> None:
        """Add the outputs of the drive."""
        for name, output, text in (
            ("motor_speed", "motor_speed", "speed of the motor"),
            ("motor_torque", "motor_torque", "torque of the motor at its shaft"),
            ("gear", "gear", "selector engaged: -1 reverse, 0 neutral, 1 drive"),
            ("drive_torque", "wheel_torque", f"torque on each {self.wheels} wheel"),
            ("electric_power", "electric_power", "power from the battery; negative: regeneration"),
        ):
            b.m.sense_element(name, "drive", output, description=text)
