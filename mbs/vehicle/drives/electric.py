"""Electric motor with a fixed ratio and an open differential."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from mbs.elements.electric_drive import ElectricDrive
from mbs.model.carried import Spin
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

TIED = (
    "max_torque",
    "max_power",
    "ratio",
    "efficiency",
    "gear_efficiency",
    "regeneration_torque",
    "regeneration_power",
    "regeneration_speed",
)


class Electric(Section):
    """Drive by an electric motor."""

    kind: Literal["electric"]
    """Names this template."""
    wheels: Literal["front", "rear"]
    """Driven wheels."""
    max_torque: Torque
    """Largest torque of the motor."""
    max_power: MotorPower
    """Largest power of the motor at its shaft."""
    ratio: DriveRatio
    """Speed of the motor over the mean speed of the wheels."""
    limit_speed: MotorSpeed
    """Speed of the motor beyond which its torque fades."""
    motor_inertia: RotorInertia
    """Moment of inertia of the motor's rotor and of what turns with it, about its axis. Each driven wheel feels half of
    it times the ratio squared."""
    efficiency: Efficiency = 0.9
    """Efficiency between battery and shaft of the motor, both ways."""
    gear_efficiency: Efficiency = 0.97
    """Efficiency between shaft and wheels, both ways."""
    regeneration_torque: RegenerationTorque = 0.0
    """Torque of the motor that brakes with closed throttle."""
    regeneration_power: MotorPower = 50e3
    """Largest power of it."""
    regeneration_speed: FadeSpeed = 60.0
    """Speed of the motor below which it fades, so that the car rests."""
    reverse_torque: ReverseShare = 0.5
    """Share of the largest torque in reverse."""
    reverse_speed: MotorSpeed = 250.0
    """Speed of the motor beyond which its torque fades in reverse."""
    engage_speed: AngularSpeed = 8.0
    """Speed of the wheels up to which the selector may go to the other direction."""
    engage_time: Time = 0.3
    """Time in which the torque fades out and in when the selector moves."""

    @property
    def torque_ratio(self) -> float:
        """Torque of both driven wheels together over that of the motor."""
        return self.ratio * self.gear_efficiency

    def build(self, b: CarBuilder, spins: Mapping[str, Spin], *, neutral: bool) -> None:
        """Add the drive; its reaction is on the chassis.

        Parameters
        ----------
        spins : mapping of str to Spin
            Of the wheels, by their names.
        """
        own = ("kind", "wheels", "motor_inertia")
        drive = ElectricDrive(**{name: getattr(self, name) for name in type(self).model_fields if name not in own})
        left, right = (spins[self.wheels[0].upper() + side] for side in "LR")
        z, x = b.chassis.drive_axes  # the reaction is about the lateral axis of the chassis (z cross x = y)
        throttle, selector = b.inputs["throttle"].index, b.inputs.get("selector")
        chosen = None if selector is None else selector.index
        element = b.m.add(drive.record("drive", left.coordinate, right.coordinate, z, x, throttle, selector=chosen))
        self.turning_parts(b, spins)
        for name in TIED:
            b.tie(self, name, element, name)

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
