"""Electric motor with a fixed ratio and an open differential."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.reals import NotNegative, Positive, Share, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.elements.record_checks import index
from mbs.elements.wheel_signals import carrier_signals
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class ElectricDrive:
    """Drive of two wheels by an electric motor: constant torque, then constant power, then the limit speed.

    Speeds and torques are those of the motor where nothing else is said. The throttle sets its part of the largest
    torque at the speed, less the other part of the torque of regeneration. Where a torque works against the motion the
    motor gives electric power. The rotor's inertia belongs to the spins of the wheels, see `Model.armature`.
    """

    max_torque: NotNegative
    """N m."""
    max_power: NotNegative
    """Mechanical power, W, above which the torque falls as one over the speed, in both directions of the power."""
    ratio: Positive
    """Turns of the motor for one of the wheels in the mean."""
    limit_speed: Positive = 1200.0
    """rad/s, from which on the torque fades to zero within 5 %."""
    efficiency: Share = 0.9
    """Fraction of motor and inverter, above 0, at most 1; battery power is shaft power divided by it under drive, times
    it in regeneration."""
    gear_efficiency: Share = 0.97
    """Fraction of the gears, above 0, at most 1, in both directions; their loss fades below 5 rad/s."""
    regeneration_torque: NotNegative = 0.0
    """With closed throttle, N m."""
    regeneration_power: NotNegative = 50e3
    """Its limit, mechanical, W."""
    regeneration_speed: Positive = 60.0
    """rad/s, below which it fades to zero, so that the car rests at standstill."""
    reverse_torque: NotNegative = 0.5
    """Factor on max_torque in reverse."""
    reverse_speed: Positive = 250.0
    """Limit speed in reverse, rad/s."""
    engage_speed: NotNegative = 8.0
    """Mean wheel speed, rad/s; while the wheels turn faster against a direction it does not engage, and the drive stays
    in neutral."""
    engage_time: Positive = 0.3
    """In which the torque fades out of one direction, and into the other, s."""

    def record(
        self,
        name: str,
        left: Affine,
        right: Affine,
        f: AffineVector,
        g: AffineVector,
        throttle: int,
        selector: int | None = None,
    ) -> ElementRecord:
        """The force element; the frame carries the reaction.

        Parameters
        ----------
        left, right : Affine
            Absolute spins of the two wheels, rad.
        f, g : AffineVector
            Orthonormal vectors of the frame, f x g to the left.
        throttle : int
            Number of an input, 0 to 1.
        selector : int, optional
            Number of an input: -1 reverse, 0 neutral, 1 drive; without one the drive is in drive.
        """
        what = f"the drive '{name}'"
        inputs = [index(throttle, f"The input of {what}")]
        if selector is not None:
            inputs.append(index(selector, f"The selector of {what}"))
        return ElementRecord(
            name,
            ElementType.ELECTRIC_DRIVE,
            (left, right, *carrier_signals(f, g, what)),
            *columns(reals_of(self, what)),
            inputs,
            () if selector is None else (1.0, 1.0),
            (
                Output("motor_speed", "rad/s", "speed of the motor", display_unit="rpm"),
                Output("motor_torque", "N m", "torque of the motor"),
                Output("wheel_torque", "N m", "torque on each of the two wheels"),
                Output("electric_power", "W", "power from the battery, negative in regeneration"),
                Output("gear", "1", "direction engaged: -1 reverse, 0 neutral, 1 drive", whole=True),
                *(Output(f"{side}_power", "W", f"power on the {side} wheel") for side in ("left", "right")),
            ),
        )
