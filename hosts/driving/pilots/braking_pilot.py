"""A pilot that drives as another one does and then brakes with the steering fixed."""

import math
from collections.abc import Callable, Mapping

from hosts.driving.ground_marks import Mark, line_across, marks_of
from hosts.driving.pilots.pilot import Pilot


class Braking:
    """Drives as another pilot, then fixes the steering, releases the throttle and presses the brake.

    Parameters
    ----------
    before : Pilot
        Drives until then, with all inputs of this pilot.
    begins : callable
        Function of time and observation; braking begins at the first time at which it is true.
    pedal : float
        Brake, 0 to 1.
    rise_time : float
        From the first movement of the pedal to `pedal`, s.
    gear : mapping of str to tuple of float
        Inputs with their values before and while braking, such as a selector that goes to neutral.

    Attributes
    ----------
    onset : float
        Time of the first movement of the pedal, s; NaN while it has not begun.
    """

    def __init__(
        self,
        before: Pilot,
        begins: Callable[[float, Mapping[str, float]], bool],
        pedal: float,
        rise_time: float,
        gear: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        self.before = before
        self.begins = begins
        self.pedal = pedal
        self.rise_time = rise_time
        self.gear = dict(gear or {})
        self.onset = math.nan
        self._pose: tuple[float, float, float] | None = None
        self._fixed_inputs: dict[str, float] = {}
        self._last = 0.0

    @property
    def marks(self) -> list[Mark]:
        """Marks of the other pilot, and a line where braking begins."""
        return marks_of(self.before) + ([] if self._pose is None else [line_across(*self._pose)])

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        step, self._last = time - self._last, time
        if math.isnan(self.onset):
            if not self._fixed_inputs or not self.begins(time, observation):
                self._fixed_inputs = dict(self.before.act(time, observation))
                return {"brake": 0.0, **self._fixed_inputs, **{name: values[0] for name, values in self.gear.items()}}
            self.onset = time
            if {"chassis.x", "chassis.y", "chassis.yaw"} <= set(observation):
                self._pose = observation["chassis.x"], observation["chassis.y"], observation["chassis.yaw"]
        # The input is held over the next step, whose mean pedal is that at its middle.
        share = (time + 0.5 * step - self.onset) / self.rise_time if self.rise_time > 0.0 else 1.0
        pedals = {"throttle": 0.0, "brake": self.pedal * min(share, 1.0)}
        return {**self._fixed_inputs, **pedals, **{name: values[1] for name, values in self.gear.items()}}
