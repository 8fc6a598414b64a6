"""Engine, torque converter, automatic gears and differential."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field

from mbs.elements.automatic_drive import AutomaticDrive
from mbs.model.carried import Spin
from mbs.vehicle.builder import CarBuilder
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


class Automatic(Section):
    """Drive by an engine with a torque converter and gears that shift automatically."""

    kind: Literal["automatic"]
    """Names this template."""
    wheels: Literal["front", "rear"]
    """Driven wheels."""
    max_torque: Torque
    """Torque of the engine; full torque is the lesser of it and of the power over the speed."""
    max_power: MotorPower
    """Power of the engine."""
    efficiency: Fraction
    """Efficiency of the driveline under power."""
    stall_factor: Ratio
    """Torque ratio of the converter at stall."""
    creep_torque: CreepTorque
    """Torque per driven wheel at rest with closed throttle, the selector in drive; 0: neutral."""
    ratios: Annotated[tuple[Ratio, ...], Field(min_length=1, max_length=12)]
    """Total ratio of each gear, first gear first."""
    ratio_factor: RatioFactor = 1.0
    """Factor on all ratios, reverse among them, as a final drive has it."""
    reverse_ratio: Ratio = 10.0
    """Total ratio of reverse."""
    engage_speed: WheelSpeed = 8.0
    """Mean speed of the wheels above which a direction against the motion does not engage."""
    engage_time: Time = 0.3
    """Time in which the torque fades out of one direction, and into the other."""
    coupling_ratio: Fraction = 0.9
    """Speed ratio of the converter from which on its torque ratio is 1."""
    idle_speed: AngularSpeed = 90.0
    """Engine speed at rest with closed throttle."""
    stall_speed: AngularSpeed = 230.0
    """Engine speed at rest with open throttle."""
    limit_speed: AngularSpeed = 600.0
    """Engine speed where the limiter sets in."""
    creep_speed: AngularSpeed = 10.0
    """Wheel speed where the creep torque has faded."""
    drag_torque: SmallTorque = 20.0
    """Torque of the engine at its limit speed with closed throttle."""
    up_closed: AngularSpeed = 230.0
    """Speed of the turbine at which it shifts up with closed throttle."""
    up_open: AngularSpeed = 540.0
    """Speed of the turbine at which it shifts up with open throttle."""
    down_closed: AngularSpeed = 110.0
    """Speed of the turbine at which it shifts down with closed throttle."""
    down_open: AngularSpeed = 270.0
    """Speed of the turbine at which it shifts down with open throttle."""
    dwell: Time = 0.6
    """Least time between shifts."""
    ramp: Time = 0.2
    """Duration of a shift."""
    locking: Locking = 0.0
    """Share of the torque by which the slower driven wheel can have more than the faster; 0: open differential."""

    def faults(self) -> Iterator[str]:
        """Gears and speeds are in order."""
        ratios = list(self.ratios)
        if any(b >= a for a, b in pairwise(ratios)):
            yield f"{self.key('ratios')} is {ratios}; they must fall from first gear on."
            return
        if not self.idle_speed <= self.stall_speed < self.limit_speed:
            yield (
                f"{self.key('idle_speed')}, stall_speed and limit_speed are {self.idle_speed:g}, {self.stall_speed:g} "
                f"and {self.limit_speed:g} rad/s; they must rise."
            )
        if self.dwell < self.ramp:
            yield f"{self.key('dwell')} is {self.dwell:g} s; it must not be less than ramp, {self.ramp:g} s."
        for throttle in ("closed", "open"):
            up, down = getattr(self, f"up_{throttle}"), getattr(self, f"down_{throttle}")
            least = max((low / high for low, high in pairwise(ratios)), default=0.0) * down
            if up <= least and len(ratios) > 1:
                yield (
                    f"{self.key(f'up_{throttle}')} is {up:g} rad/s; it must be more than {least:.4g} rad/s, or the "
                    f"drive shifts down again at once, below down_{throttle} of {down:g} rad/s."
                )

    @property
    def torque_ratio(self) -> float:
        """Torque of both driven wheels together over that of the engine, at rest in first gear."""
        return self.ratios[0] * self.ratio_factor * self.stall_factor * self.efficiency

    def build(self, b: CarBuilder, spins: Mapping[str, Spin], *, neutral: bool) -> None:
        """Add the drive; its reaction is on the chassis.

        Parameters
        ----------
        spins : mapping of str to Spin
            Of the wheels, by their names.
        """
        own = ("kind", "wheels", "ratio_factor")
        values = {name: getattr(self, name) for name in type(self).model_fields if name not in own}
        values["ratios"] = tuple(self.ratio_factor * ratio for ratio in self.ratios)
        values["reverse_ratio"] = self.ratio_factor * self.reverse_ratio
        drive = AutomaticDrive(**(values | {"creep_torque": 0.0} if neutral else values))
        left, right = (spins[self.wheels[0].upper() + side].coordinate for side in "LR")
        z, x = b.chassis.drive_axes  # the reaction is about the lateral axis of the chassis (z cross x = y)
        inputs = b.inputs["throttle"].index, 1, b.inputs["selector"].index
        request = None
        if b.ports.gear is not None:
            text = "forward gear that is asked for; 0: as the drive shifts by itself"
            request = b.port("gear_request", 0.0, float(len(self.ratios)), "1", text, whole=True).index
        clutch = None
        if b.ports.clutch is not None:
            text = "clutch pedal: 0 released, 1 pressed, where nothing of the drive's torque is left"
            clutch = b.port("clutch", 0.0, 1.0, "1", text).index
        element = b.m.add(drive.record("drive", left, right, z, x, *inputs, request, clutch))
        for name in ("max_torque", "max_power", "locking"):
            b.tie(self, name, element, name)
        for k, ratio in enumerate(self.ratios):
            b.tie(self, "ratio_factor", element, f"ratio_{k + 1}", ratio)
        b.tie(self, "ratio_factor", element, "reverse_ratio", self.reverse_ratio)
        b.tie(self, "creep_torque", element, "creep_torque", value=drive.creep_torque)
        b.m.equilibrium_parameters = {self.key("creep_torque"): 0.0}

    def turning_parts(self, b: CarBuilder, spins: Mapping[str, Spin]) -> None:
        """Nothing: the inertia of this drive is neglected."""

    def outputs(self, b: CarBuilder) -> None:
        """Add the outputs of the drive."""
        b.m.sense_element("engine_speed", "drive", "engine_speed", description="speed of the engine")
        b.m.sense_element("gear", "drive", "gear", description="gear engaged")
        b.m.sense_element("drive_torque", "drive", "wheel_torque", description=f"torque on each {self.wheels} wheel")
