"""Engine, converter, automatic gears and open differential."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import pairwise

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import not_negative, positive
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import index, several, size
from mbs.kernel.header import ElementType

OF_SELECTOR = {"reverse_ratio": positive, "engage_speed": not_negative, "engage_time": positive}
"""Numbers that a drive with a selector has besides, with their checks."""


@dataclass(frozen=True)
class AutomaticDrive:
    """Drive of two wheels by an engine with a torque converter and gears that shift automatically.

    Parameters
    ----------
    max_torque, max_power : float
        Of the engine, N m and W: full torque is the lesser of max_torque and max_power/speed.
    efficiency : float
        Of the driveline under power.
    stall_factor, coupling_ratio : float
        Torque ratio of the converter at stall, and the speed ratio from which on it is 1.
    idle_speed, stall_speed, limit_speed : float
        Engine speeds, rad/s: at rest with closed and with open throttle, and where the limiter sets in.
    creep_torque, creep_speed : float
        Torque per wheel with closed throttle at rest, N m, and the wheel speed where it has faded, rad/s.
    drag_torque : float
        Of the engine at its limit speed with closed throttle, N m.
    up_closed, up_open, down_closed, down_open : float
        Shift speeds of the turbine (ratio times mean wheel speed) with closed and open throttle, rad/s.
    dwell, ramp : float
        Least time between shifts and duration of a shift, s.
    ratios : sequence of float
        Total ratio of each gear, first gear first.
    reverse_ratio : float
        Total ratio of reverse; used where there is a selector, as the two next.
    engage_speed : float
        Mean wheel speed, rad/s: while the wheels turn faster against a direction it does not engage, and the drive
        stays in neutral.
    engage_time : float
        In which the torque fades out of one direction, and into the other, s.
    """

    max_torque: float
    max_power: float
    efficiency: float = 0.85
    stall_factor: float = 1.9
    coupling_ratio: float = 0.9
    idle_speed: float = 90.0
    stall_speed: float = 230.0
    limit_speed: float = 600.0
    creep_torque: float = 60.0
    creep_speed: float = 10.0
    drag_torque: float = 20.0
    up_closed: float = 230.0
    up_open: float = 540.0
    down_closed: float = 110.0
    down_open: float = 270.0
    dwell: float = 0.6
    ramp: float = 0.2
    ratios: Sequence[float] = (10.5, 5.9, 4.0)
    reverse_ratio: float = 10.0
    engage_speed: float = 8.0
    engage_time: float = 0.3

    def record(
        self,
        name: str,
        left: Affine,
        right: Affine,
        f: AffineVector,
        g: AffineVector,
        throttle: int,
        gear: int = 1,
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
        gear : int
            Gear at the start, from 1.
        selector : int, optional
            Number of an input: -1 reverse, 0 neutral, 1 drive; without one the drive is in drive.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range, the ratios do not fall, or a gear is left once engaged.
        """
        what = f"the drive '{name}'"
        size(f, (3,), f"The vector f of {what}")
        size(g, (3,), f"The vector g of {what}")
        own = ("ratios", *OF_SELECTOR)
        names = tuple(field.name for field in fields(self) if field.name not in own)
        values = [not_negative(getattr(self, n), f"The {n.replace('_', ' ')} of {what}") for n in names]
        ratios = [positive(r, f"A ratio of {what}") for r in several(self.ratios, f"the ratios of {what}")]
        if not ratios or any(b >= a for a, b in pairwise(ratios)):
            raise ValueError(f"The ratios of {what} are {ratios}; they must fall, with at least one.")
        if not 1 <= gear <= len(ratios):
            raise ValueError(f"The gear of {what} is {gear}; it must be one of 1 to {len(ratios)}.")
        if not 0.0 < self.idle_speed <= self.stall_speed < self.limit_speed:
            raise ValueError(
                f"The speeds {self.idle_speed:g}, {self.stall_speed:g}, {self.limit_speed:g} rad/s of {what} "
                "must rise from idle over stall to limit."
            )
        positive(self.coupling_ratio, f"The coupling ratio of {what}")
        positive(self.creep_speed, f"The creep speed of {what}")
        if self.dwell < self.ramp:
            raise ValueError(f"The dwell {self.dwell:g} s of {what} must not be shorter than its ramp {self.ramp:g} s.")
        self._check_hysteresis(what, ratios)
        more = tuple(
            check(getattr(self, n), f"The {n.replace('_', ' ')} of {what}") for n, check in OF_SELECTOR.items()
        )
        inputs = [index(throttle, f"The input of {what}"), len(ratios)]
        if selector is None:
            more = ()
        else:
            inputs.append(index(selector, f"The selector of {what}"))
        return ElementRecord(
            name,
            ElementType.AUTOMATIC_DRIVE,
            (left, right, *f.components, *g.components),
            (*values, *ratios, *more),
            inputs,
            (float(gear), float(gear), 1e3, 0.0, *((1.0, 1.0) if more else ())),
            (
                Output("engine_speed", "rad/s", "speed of the engine", display_unit="rpm"),
                Output("gear", "1", "gear engaged" + (", -1: reverse, 0: neutral" if more else ""), whole=True),
                Output("wheel_torque", "N m", "torque on each of the two wheels"),
                Output("engine_torque", "N m", "torque of the engine"),
            ),
            (*names, *(f"ratio_{i + 1}" for i in range(len(ratios))), *(OF_SELECTOR if more else ())),
            (*(not_negative for _ in names), *(positive for _ in ratios), *(OF_SELECTOR.values() if more else ())),
        )

    def _check_hysteresis(self, what: str, ratios: Sequence[float]) -> None:
        """A gear just engaged must not be left at once at the same speed."""
        for up, down in ((self.up_closed, self.down_closed), (self.up_open, self.down_open)):
            for low, high in pairwise(ratios):
                if up * high / low <= down:
                    raise ValueError(
                        f"T{what[1:]} shifts up at {up:g} rad/s to {up * high / low:.0f} rad/s in the next gear, "
                        f"where it shifts down again (below {down:g}); lower the down-shift speed."
                    )
