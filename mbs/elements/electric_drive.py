"""Electric motor with a fixed ratio and an open differential."""

from __future__ import annotations

from dataclasses import dataclass, fields

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import not_negative, positive
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import index, share, size
from mbs.kernel.header import ElementType

POSITIVE = ("ratio", "limit_speed", "regeneration_speed", "reverse_speed", "engage_time")
EFFICIENCIES = ("efficiency", "gear_efficiency")


@dataclass(frozen=True)
class ElectricDrive:
    """Drive of two wheels by an electric motor: constant torque, then constant power, then the limit speed.

    Speeds and torques are those of the motor where nothing else is said. The throttle sets its part of the largest
    torque at the speed, less the other part of the torque of regeneration. Where a torque works against the motion the
    motor gives electric power. The rotor's inertia belongs to the spins of the wheels, see `reflected_inertia`.

    Parameters
    ----------
    max_torque : float
        N m.
    max_power : float
        Mechanical power, W, above which the torque falls as one over the speed, in both directions of the power.
    ratio : float
        Turns of the motor for one of the wheels in the mean.
    limit_speed : float
        rad/s, from which on the torque fades to zero within 5 %.
    efficiency : float
        Of motor and inverter, above 0, at most 1: battery power is shaft power divided by it under drive, times it in
        regeneration.
    gear_efficiency : float
        Of the gears, above 0, at most 1, in both directions; their loss fades below 5 rad/s.
    regeneration_torque : float
        With closed throttle, N m.
    regeneration_power : float
        Its limit, mechanical, W.
    regeneration_speed : float
        rad/s, below which it fades to zero, so that the car rests at standstill.
    reverse_torque : float
        Factor on max_torque in reverse.
    reverse_speed : float
        Limit speed in reverse, rad/s.
    engage_speed : float
        Mean wheel speed, rad/s: while the wheels turn faster against a direction it does not engage, and the drive
        stays in neutral.
    engage_time : float
        In which the torque fades out of one direction, and into the other, s.
    """

    max_torque: float
    max_power: float
    ratio: float
    limit_speed: float = 1200.0
    efficiency: float = 0.9
    gear_efficiency: float = 0.97
    regeneration_torque: float = 0.0
    regeneration_power: float = 50e3
    regeneration_speed: float = 60.0
    reverse_torque: float = 0.5
    reverse_speed: float = 250.0
    engage_speed: float = 8.0
    engage_time: float = 0.3

    def reflected_inertia(self, rotor_inertia: float) -> float:
        """Inertia for the spin of each wheel, for `Model.armature`, that stands for the rotor.

        It is exact while both wheels turn alike; a difference of their speeds does not turn a real rotor, so that a
        single spinning wheel is somewhat too heavy with it.

        Parameters
        ----------
        rotor_inertia : float
            Of the rotor and what turns with it, about its axis, kg m2.

        Returns
        -------
        float
            rotor_inertia ratio^2 / 2, kg m2.

        Raises
        ------
        ModelError
            A number is not one or outside its range.
        """
        ratio = positive(self.ratio, "The ratio of an electric drive")
        return 0.5 * not_negative(rotor_inertia, "The inertia of a rotor") * ratio * ratio

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
        name : str
            Unique among the elements of a model.
        left, right : Affine
            Absolute spins of the two wheels, rad.
        f, g : AffineVector
            Orthonormal vectors of the frame, f x g to the left.
        throttle : int
            Number of an input, 0 to 1.
        selector : int, optional
            Number of an input: -1 reverse, 0 neutral, 1 drive; without one the drive is in drive.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the drive '{name}'"
        size(f, (3,), f"The vector f of {what}")
        size(g, (3,), f"The vector g of {what}")
        names = tuple(field.name for field in fields(self))
        checks = tuple(positive if n in POSITIVE else share if n in EFFICIENCIES else not_negative for n in names)
        values = [
            check(getattr(self, n), f"The {n.replace('_', ' ')} of {what}")
            for n, check in zip(names, checks, strict=True)
        ]
        inputs = [index(throttle, f"The input of {what}")]
        if selector is not None:
            inputs.append(index(selector, f"The selector of {what}"))
        return ElementRecord(
            name,
            ElementType.ELECTRIC_DRIVE,
            (left, right, *f.components, *g.components),
            values,
            inputs,
            () if selector is None else (1.0, 1.0),
            (
                Output("motor_speed", "rad/s", "speed of the motor", display_unit="rpm"),
                Output("motor_torque", "N m", "torque of the motor"),
                Output("wheel_torque", "N m", "torque on each of the two wheels"),
                Output("electric_power", "W", "power from the battery, negative in regeneration"),
                Output("gear", "1", "direction engaged: -1 reverse, 0 neutral, 1 drive", whole=True),
            ),
            names,
            checks,
        )
