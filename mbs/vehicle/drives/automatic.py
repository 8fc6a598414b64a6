"""Engine, torque converter, automatic gears and differential."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal

from pydantic import Field

from mbs.elements.automatic_drive import AutomaticDrive
from mbs.model.carried_parts import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import new_port
from mbs.vehicle.quantities import (
    AngularSpeed,
    CreepTorque,
    Fraction,
    Locking,
    MotorPower,
    Ratio,
    RatioFactor,
    SmallTorque,
    Time,
    Torque,
    WheelSpeed,
)
from mbs.vehicle.section import Section


class Automatic(Section, of=AutomaticDrive):
    """Drive by an engine with a torque converter and gears that shift automatically."""

    kind: Literal["automatic"]
    """Names this template."""
    wheels: Literal["front", "rear"]
    """Driven wheels."""
    max_torque: Torque
    max_power: MotorPower
    efficiency: Fraction
    stall_factor: Ratio
    creep_torque: CreepTorque
    ratios: Annotated[tuple[Ratio, ...], Field(min_length=1, max_length=12)]
    ratio_factor: RatioFactor = 1.0
    """Factor on all ratios, reverse among them, as a final drive has it."""
    reverse_ratio: Ratio = AutomaticDrive.reverse_ratio
    engage_speed: WheelSpeed = AutomaticDrive.engage_speed
    engage_time: Time = AutomaticDrive.engage_time
    coupling_ratio: Fraction = AutomaticDrive.coupling_ratio
    idle_speed: AngularSpeed = AutomaticDrive.idle_speed
    stall_speed: AngularSpeed = AutomaticDrive.stall_speed
    limit_speed: AngularSpeed = AutomaticDrive.limit_speed
    creep_speed: AngularSpeed = AutomaticDrive.creep_speed
    drag_torque: SmallTorque = AutomaticDrive.drag_torque
    up_closed: AngularSpeed = AutomaticDrive.up_closed
    up_open: AngularSpeed = AutomaticDrive.up_open
    down_closed: AngularSpeed = AutomaticDrive.down_closed
    down_open: AngularSpeed = AutomaticDrive.down_open
    dwell: Time = AutomaticDrive.dwell
    ramp: Time = AutomaticDrive.ramp
    locking: Locking = AutomaticDrive.locking

    def faults(self) -> Iterator[str]:
        """Yield faults of the order of gears and speeds."""
        for field, fault in self.element(AutomaticDrive).faults():
            yield f"{self.key(field)} {fault}."

    @property
    def torque_ratio(self) -> float:
        """Torque of both driven wheels together per torque of the engine, at rest in first gear."""
        return self.ratios[0] * self.ratio_factor * self.stall_factor * self.efficiency

    def build(self, b: CarBuilder, spins: Mapping[str, Spin], *, neutral: bool) -> None:
        """Add the drive, whose reaction is on the chassis. `spins`: spins of the wheels, by name."""
        drive = self.element(
            AutomaticDrive,
            ratios=tuple(self.ratio_factor * ratio for ratio in self.ratios),
            reverse_ratio=self.ratio_factor * self.reverse_ratio,
            creep_torque=0.0 if neutral else self.creep_torque,
        )
        left, right = (spins[self.wheels[0].upper() + side].coordinate for side in "LR")
        z, x = b.chassis.drive_axes  # the reaction is about the lateral axis of the chassis (z cross x = y)
        inputs = b.inputs["throttle"].index, 1, b.inputs["selector"].index
        request = clutch = None
        if b.ports.gear is not None:
            text = "requested forward gear; 0: the drive shifts by itself"
            request = new_port(b, "gear_request", 0.0, float(len(self.ratios)), "1", text, whole=True).index
        if b.ports.clutch is not None:
            text = "clutch pedal: 0 released, 1 pressed, where nothing of the drive's torque is left"
            clutch = new_port(b, "clutch", 0.0, 1.0, "1", text).index
        element = b.m.add(drive.record("drive", left, right, z, x, *inputs, request, clutch))
        b.tie_numbers(self, element)
        for k, ratio in enumerate(self.ratios):
            b.tie(self, "ratio_factor", element, f"ratio_{k + 1}", ratio)
        b.tie(self, "ratio_factor", element, "reverse_ratio", self.reverse_ratio)
        b.m.equilibrium_parameters = {self.key("creep_torque"): 0.0}

    def turning_parts(self, b: CarBuilder, spins: Mapping[str, Spin]) -> None:
        """Add nothing: the inertia of this drive is neglected."""

    def outputs(self, b: CarBuilder) -> None:
        """Add the outputs of the drive."""
        b.m.sense_element("engine_speed", "drive", "engine_speed", description="speed of the engine")
        b.m.sense_element("gear", "drive", "gear", description="gear engaged")
        b.m.sense_element("drive_torque", "drive", "wheel_torque", description=f"torque on each {self.wheels} wheel")
