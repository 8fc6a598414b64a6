"""Finds the throttle that holds the speed of a car on a straight, before a run with this throttle."""

import math
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from hosts.common.errors import HostError
from hosts.driving.manoeuvre import INITIAL_SPEED, Manoeuvre
from hosts.driving.pilots.pilot import refuse_missing
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu

THROTTLE = "throttle"
SPEED_TOLERANCE = 0.03
"""Largest relative change of the speed without a note."""
_LONGEST_SEARCH = 30.0  # s
_WINDOW = 1.0  # s, in which speed and throttle are steady
_THROTTLE_RANGE = 0.004  # largest range of a steady throttle
_SPEED_ERROR = 0.0005  # largest relative error of a steady speed
_ACCEPTED_SPEED_ERROR = 0.01  # relative, of a car whose gearbox shifts repeatedly


class _ThrottleFinder:
    """A pilot that holds the speed of its first act, and detects a steady throttle."""

    def __init__(self) -> None:
        self.speed, self.lowest = math.nan, math.inf
        self._holder: SpeedHolder | None = None
        self._window: deque[tuple[float, float, float]] = deque()

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        if self._holder is None:
            self.speed = observation["speed"]
            self._holder = SpeedHolder(self.speed, gain=1.0, integral_gain=1.0, brakes=False)
        acts = self._holder.act(time, observation)
        self.lowest = min(self.lowest, observation["speed"])
        self._window.append((time, observation["speed"], acts[THROTTLE]))
        while time - self._window[0][0] > _WINDOW + 1e-9:
            self._window.popleft()
        return acts

    def relative_error(self) -> float:
        """Largest relative error of the speed in the last second."""
        return max(abs(speed - self.speed) for _, speed, _ in self._window) / self.speed

    def is_steady(self, time: float, observation: Mapping[str, float]) -> bool:
        if time < 2.0 * _WINDOW or abs(observation["speed"] - self.speed) > _SPEED_ERROR * self.speed:
            return False
        return bool(
            np.ptp([x for _, _, x in self._window]) <= _THROTTLE_RANGE and self.relative_error() <= _SPEED_ERROR
        )

    @property
    def throttle(self) -> float:
        """Mean throttle over the last second."""
        return sum(x for _, _, x in self._window) / len(self._window)


def with_throttle(drive: Callable[..., Result], fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float) -> Manoeuvre:
    """The manoeuvre with the throttle that holds the speed of its start on a straight, as a constant column.

    `drive`: `hosts.driving.co_simulation.run`; `fmu`: not yet initialised, and reset afterwards; other inputs have the
    values of the first row; `step`: communication step, s. Raises `HostError`: the car stands, or does not hold its
    speed.
    """
    refuse_missing([n for n in (THROTTLE, "speed") if n not in fmu.variables], fmu.path.name)
    other_inputs = {n: values[:1] for n, values in manoeuvre.inputs.items() if n != THROTTLE}
    straight = replace(
        manoeuvre,
        time=np.zeros(min(len(manoeuvre.time), 1)),
        inputs=other_inputs,
        stop_time=_LONGEST_SEARCH,
        find_throttle=False,
    )
    finder = _ThrottleFinder()

    def ends(time: float, observation: Mapping[str, float]) -> bool:
        return not finder.speed > 0.0 or finder.is_steady(time, observation)

    run = drive(fmu, straight, step, finder, until=ends, every=max(1, round(_WINDOW / step)), last=True)
    text, speed = f"The manoeuvre '{manoeuvre.name}' holds the speed of its start", float(run["speed"][-1])
    if run.refusal:
        raise HostError(f"{text}; straight on {run.refusal}.")
    if not finder.speed > 0.0:
        raise HostError(f"{text}, which is {finder.speed:.3g} m/s; give one above 0, as --set {INITIAL_SPEED}=22.22.")
    if finder.relative_error() > _ACCEPTED_SPEED_ERROR:
        raise HostError(
            f"{text}; straight on the car does not hold {finder.speed:.4g} m/s: after {run.simulated:.3g} s it is at "
            f"{speed:.4g} m/s with a throttle of {finder.throttle:.3g}; start at another speed, as --set "
            f"{INITIAL_SPEED}={max(0.9 * min(speed, finder.speed), 1.0):.3g}."
        )
    if finder.lowest < 0.5 * finder.speed:  # the output has no sign
        raise HostError(
            f"{text}; from {finder.speed:.4g} m/s the car slows down to {finder.lowest:.3g} m/s before it holds it, as "
            f"one that rolls backwards does; start forwards, as --set {INITIAL_SPEED}={finder.speed:.4g}."
        )
    fmu.reset()
    fmu.messages.clear()
    time = manoeuvre.time if len(manoeuvre.time) else np.zeros(1)
    column = {THROTTLE: np.full(len(time), finder.throttle)}
    return replace(manoeuvre, time=time, inputs={**manoeuvre.inputs, **column}, find_throttle=False)


def with_change_of_speed(result: Result) -> Result:
    """A result with a note on the change of its speed, which is in `missed` above `SPEED_TOLERANCE`."""
    speed, throttle = result["speed"], float(result[THROTTLE][0])
    change = speed / speed[0] - 1.0
    k = int(np.abs(change).argmax())
    message = (
        f"{throttle:.4g}, which holds {speed[0]:.4g} m/s straight on; the speed changes by {100.0 * change[k]:+.2g} %, "
        f"to {speed[k]:.4g} m/s at {result.time[k]:.4g} s"
    )
    if abs(change[k]) <= SPEED_TOLERANCE:
        return replace(result, notes=[*result.notes, ("throttle", message)])
    until = float(result.time[int((np.abs(change) > SPEED_TOLERANCE).argmax()) - 1])
    remedy = f"more than {100.0 * SPEED_TOLERANCE:g} %; up to --stop-time {until:.9g} it is less"
    return replace(result, missed=[*result.missed, ("throttle", f"{message}: {remedy}")])
