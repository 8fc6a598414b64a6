"""Engine, converter, automatic gears and differential."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import not_negative, positive
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import Integer, input_index
from mbs.elements.reals import NotNegative, Positive, Real, each_real, reals_of
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import number_list
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class AutomaticDrive(Element):
    """Drive of two wheels by an engine with a torque converter and gears that shift automatically.

    The speed of the turbine is the ratio times the mean speed of the wheels; the speed of the engine, which has no
    inertia, is ``sqrt(w_s^2 + w_t^2)`` of stall and turbine speed. Its torque is ``min(T_max, P_max/w)`` times a linear
    factor of the converter. Gears shift between steps, by speed or by request, and blend over the ramp; a clutch behind
    the converter transmits at most the part of the largest torque that its pedal leaves, and slips beyond. Both wheels
    have equal torques, the carrier their reaction. Ratio of reverse, speed and time to engage are used only with a
    selector.
    """

    max_torque: NotNegative
    """Torque of the engine, N m; full torque is the lesser of it and of the power divided by the speed."""
    max_power: NotNegative
    """Power of the engine, W."""
    efficiency: NotNegative = 0.85
    """Efficiency of the driveline under power."""
    stall_factor: NotNegative = 1.9
    """Torque ratio of the converter at stall."""
    coupling_ratio: Positive = 0.9
    """Speed ratio of the converter above which its torque ratio is 1."""
    idle_speed: NotNegative = 90.0
    """Engine speed at rest with closed throttle, rad/s."""
    stall_speed: NotNegative = 230.0
    """Engine speed at rest with open throttle, rad/s."""
    limit_speed: NotNegative = 600.0
    """Engine speed at which the limiter sets in, rad/s."""
    creep_torque: NotNegative = 60.0
    """Torque per driven wheel at rest with closed throttle, the selector in drive, N m; 0: neutral."""
    creep_speed: Positive = 10.0
    """Wheel speed at which the creep torque has faded, rad/s."""
    drag_torque: NotNegative = 20.0
    """Torque of the engine at its limit speed with closed throttle, N m."""
    up_closed: Annotated[float, Real(not_negative, noun="upshift speed with closed throttle")] = 230.0
    """Speed of the turbine at which it shifts up with closed throttle, rad/s."""
    up_open: Annotated[float, Real(not_negative, noun="upshift speed with open throttle")] = 540.0
    """Speed of the turbine at which it shifts up with open throttle, rad/s."""
    down_closed: Annotated[float, Real(not_negative, noun="downshift speed with closed throttle")] = 110.0
    """Speed of the turbine at which it shifts down with closed throttle, rad/s."""
    down_open: Annotated[float, Real(not_negative, noun="downshift speed with open throttle")] = 270.0
    """Speed of the turbine at which it shifts down with open throttle, rad/s."""
    dwell: Annotated[float, Real(not_negative, noun="time between shifts")] = 0.6
    """Least time between shifts, s."""
    ramp: Annotated[float, Real(not_negative, noun="shift duration")] = 0.2
    """Duration of a shift, s."""
    locking: Annotated[float, Real(not_negative, noun="locking share")] = 0.0
    """Share of the torque by which the slower driven wheel can have more than the faster; 0: open differential."""
    ratios: Sequence[float] = (10.5, 5.9, 4.0)
    """Total ratio of each gear, first gear first."""
    reverse_ratio: Positive = 10.0
    """Total ratio of reverse."""
    engage_speed: NotNegative = 8.0
    """Mean speed of the wheels up to which a direction against their motion engages, rad/s; beyond, the drive stays in
    neutral."""
    engage_time: Positive = 0.3
    """Time in which the torque fades out of one direction, and into the other, s."""

    _noun = "a drive"
    _signals = (("left", 1), ("right", 1), ("f", 3), ("g", 3))
    _integers = (
        input_index("throttle", "the input"),
        Integer("gears", least=1, numbers=("total ratio",)),
        input_index("selector", optional=True),
        input_index("request", missing=True, optional=True),
        input_index("clutch", optional=True),
    )
    _states = (1.0, 1.0, 1e3, 0.0)
    _outputs = (
        Output("engine_speed", "rad/s", "speed of the engine", display_unit="rpm"),
        Output("gear", "1", "gear engaged", whole=True),
        Output("wheel_torque", "N m", "torque on each of the two wheels, the mean if the differential locks"),
        Output("engine_torque", "N m", "torque of the engine"),
        *(Output(f"{side}_power", "W", f"power on the {side} wheel") for side in ("left", "right")),
        *(Output(f"{side}_torque", "N m", f"torque on the {side} wheel") for side in ("left", "right")),
    )
    _first_optional = "reverse_ratio"
    _optional_states = (1.0, 1.0)

    def faults(self) -> Iterator[tuple[str, str]]:
        """Each field whose gears or speeds are not in order, with a description of the fault."""
        ratios = list(self.ratios)
        if not ratios or any(b >= a for a, b in pairwise(ratios)):
            yield "ratios", f"are {ratios}; they must fall from the first gear, with at least one"
            return
        if not 0.0 < self.idle_speed <= self.stall_speed < self.limit_speed:
            speeds = f"stall_speed {self.stall_speed:g} and limit_speed {self.limit_speed:g}"
            yield "idle_speed", f"is {self.idle_speed:g} rad/s, {speeds}; they must rise in this order, from above 0"
        if self.dwell < self.ramp:
            yield "dwell", f"is {self.dwell:g} s; it must not be less than ramp, {self.ramp:g} s"
        for throttle in ("closed", "open"):
            up, down = getattr(self, f"up_{throttle}"), getattr(self, f"down_{throttle}")
            least = max((low / high for low, high in pairwise(ratios)), default=0.0) * down
            if up <= least and len(ratios) > 1:
                yield (
                    f"up_{throttle}",
                    f"is {up:g} rad/s; it must be more than {least:.4g} rad/s, or the drive shifts down again at once, "
                    f"below down_{throttle} of {down:g} rad/s",
                )

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
        request: int | None = None,
        clutch: int | None = None,
    ) -> ElementRecord:
        """Make the record of the element for the kernel; the frame carries the reaction.

        Parameters
        ----------
        throttle : int
            Number of an input, 0 to 1.
        gear : int
            Gear at the start, from 1.
        selector : int, optional
            Number of an input: -1 reverse, 0 neutral, 1 drive; without one the drive is in drive.
        request : int, optional
            Number of an input that requests a forward gear, from 1; 0: automatic shifting. Needs a selector.
        clutch : int, optional
            Number of an input, the pedal of a clutch behind the converter, 0 released to 1 pressed: it transmits at
            most the part 1 - pedal of the largest torque that the drive has in its gear. Needs a selector.

        Raises
        ------
        ModelError
            The ratios do not fall, or a gear is left as soon as it is engaged.
        """
        label = self._label(name)
        ratios = [positive(r, f"A ratio of {label}") for r in number_list(self.ratios, f"the ratios of {label}")]
        for number, input_name in ((request, "request of gears"), (clutch, "clutch")):
            if number is not None and selector is None:
                raise ModelError(f"T{label[1:]} has a {input_name} and no selector; give it one.")
        reals_of(self, label)
        nouns = {field: noun for field, _, noun in each_real(type(self))}
        for field, fault in self.faults():
            raise ModelError(f"The {nouns.get(field, field)} of {label} {fault}.")
        record = self._record(
            name,
            (left, right, *carrier_signals(f, g, label)),
            (throttle, len(ratios), selector, request, clutch),
            appended={f"ratio_{i + 1}": (ratio, positive) for i, ratio in enumerate(ratios)},
        )
        if not 1 <= gear <= len(ratios):
            raise ModelError(f"The gear of {label} is {gear}; it must be one of 1 to {len(ratios)}.")
        outputs = list(self._outputs)
        if selector is not None:
            outputs[1] = replace(outputs[1], description="gear engaged, -1: reverse, 0: neutral")
        return replace(record, states=(float(gear), float(gear), *record.states[2:]), outputs=outputs)
