"""Electric motor with a fixed ratio and an open differential."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from mbs.elements.electric_drive import ElectricDrive
from mbs.model.spin import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import (
    DriveRatio,
    Efficiency,
    Factor,
    MotorSpeed,
    MotorTorque,
    Power,
    RegenerationTorque,
    RotorInertia,
    Time,
    WheelSpeed,
)
from mbs.vehicle.section import Section

_NOT_OF_THE_ELEMENT = ("kind", "wheels", "rotor_inertia")


class Electric(Section):
    """Drive by an electric motor; its reaction is on the chassis."""

    kind: Literal["electric"]
    """Names this template."""
    wheels: Literal["front", "rear"]
    """Driven wheels."""
    max_torque: MotorTorque
    """Largest torque of the motor."""
    max_power: Power
    """Mechanical power of the motor, above which its torque falls as one over the speed."""
    ratio: DriveRatio
    """Turns of the motor for one of the wheels in the mean."""
    rotor_inertia: RotorInertia
    """Inertia of rotor and gears as it is at each driven wheel: half of the rotor's times the square of the ratio."""
    limit_speed: MotorSpeed
    """Speed of the motor from which on its torque fades to zero."""
    efficiency: Efficiency = 0.9
    """Efficiency of motor and inverter."""
    gear_efficiency: Efficiency = 0.97
    """Efficiency of the gears."""
    regeneration_torque: RegenerationTorque = 0.0
    """Torque of the motor against the motion with closed throttle."""
    regeneration_power: Power = 50e3
    """Limit of the mechanical power of regeneration."""
    regeneration_speed: MotorSpeed = 60.0
    """Speed of the motor below which regeneration fades to zero."""
    reverse_torque: Factor = 0.5
    """Factor on the largest torque in reverse."""
    reverse_speed: MotorSpeed = 250.0
    """Limit speed in reverse."""
    engage_speed: WheelSpeed = 8.0
    """Mean speed of the wheels above which a direction against the motion does not engage."""
    engage_time: Time = 0.3
    """Time in which the torque fades out of one direction, and into the other."""

    def build(self, b: CarBuilder, spins: Mapping[str, Spin], *, neutral: bool) -> None:
        """Add the drive; its reaction is on the chassis.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        spins : mapping of str to Spin
            Of the wheels, by their names.
        neutral : bool
            Whether the car is guided; without throttle a motor at rest has no torque, so that it makes no difference.
        """
        values = {name: getattr(self, name) for name in type(self).model_fields if name not in _NOT_OF_THE_ELEMENT}
        driven = {name: spin for name, spin in spins.items() if name[0] == self.wheels[0].upper()}
        for name, spin in driven.items():
            b.m.armature(f"rotor {name}", spin, inertia=self.rotor_inertia)
        left, right = (spin.coordinate for spin in driven.values())
        z, x = b.chassis.drive_axes  # the reaction is about the lateral axis of the chassis (z cross x = y)
        inputs = b.inputs["throttle"].index, b.inputs["selector"].index
        element = b.m.add(ElectricDrive(**values).record("drive", left, right, z, x, *inputs))
        for name in values:
            quantity = self.quantity(name)
            if quantity is not None and quantity.change is not None:
                b.tie(self, name, element, name)

    def outputs(self, b: CarBuilder) -> None:
        """Add the outputs of the drive.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        """
        m = b.m
        m.sense_element("motor_speed", "drive", "motor_speed", description="speed of the motor")
        m.sense_element("motor_torque", "drive", "motor_torque", description="torque of the motor")
        m.sense_element(
            "electric_power", "drive", "electric_power", description="power from the battery, negative in regeneration"
        )
        m.sense_element("gear", "drive", "gear", description="direction engaged: -1 reverse, 0 neutral, 1 drive")
        m.sense_element("drive_torque", "drive", "wheel_torque", description=f"torque on each {self.wheels} wheel")
