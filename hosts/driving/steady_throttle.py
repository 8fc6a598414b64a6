"""The throttle that holds a car's speed straight on, found before a run that keeps it."""

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
KEPT = 0.03
"""Share of the speed at the start by which it may change without a note."""
_LONGEST = 30.0  # s, in which the throttle is found
_WINDOW = 1.0  # s, over which speed and throttle are steady
_STEADY = 0.004  # of the throttle
_CLOSE = 0.0005  # of the speed
_ENOUGH = 0.01  # of the speed, of a car whose gearbox hunts


class _Finder:
    """Holds the speed of its first act, and knows when the throttle does not change any more."""

    def __init__(self) -> None:
        self.speed, self.least = math.nan, math.inf
        self._holder: SpeedHolder | None = None
        self._last: deque[tuple[float, float, float]] = deque()

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        if self._holder is None:
            self.speed = observation["speed"]
            self._holder = SpeedHolder(self.speed, gain=1.0, integral_gain=1.0, brakes=False)
        acts = self._holder.act(time, observation)
        self.least = min(self.least, observation["speed"])
        self._last.append((time, observation["speed"], acts[THROTTLE]))
        while time - self._last[0][0] > _WINDOW + 1e-9:
            self._last.popleft()
        return acts

    def off(self) -> float:
        """Share by which the speed has been another in the last second."""
        return max(abs(speed - self.speed) for _, speed, _ in self._last) / self.speed

    def is_steady(self, time: float, observation: Mapping[str, float]) -> bool:
        if time < 2.0 * _WINDOW or abs(observation["speed"] - self.speed) > _CLOSE * self.speed:
            return False
        return bool(np.ptp([x for _, _, x in self._last]) <= _STEADY and self.off() <= _CLOSE)

    @property
    def throttle(self) -> float:
        """Mean throttle over the last second."""
        return sum(x for _, _, x in self._last) / len(self._last)


def with_throttle(drive: Callable[..., Result], fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float) -> Manoeuvre:
    """The manoeuvre with the throttle that holds the speed of its start straight on, as a column that does not change.

    `drive`: `hosts.driving.co_simulation.run`; `fmu`: not yet initialised, and reset afterwards; it is driven with the
    other inputs of the table as they are at 0 s; `step`: communication step, s. Raises `HostError`: the car stands, or
    does not hold its speed.
    """
    refuse_missing([n for n in (THROTTLE, "speed") if n not in fmu.variables], fmu.path.name)
    other_inputs = {n: values[:1] for n, values in manoeuvre.inputs.items() if n != THROTTLE}
    straight = replace(
        manoeuvre,
        time=np.zeros(min(len(manoeuvre.time), 1)),
        inputs=other_inputs,
        stop_time=_LONGEST,
        find_throttle=False,
    )
    finder = _Finder()

    def ends(time: float, observation: Mapping[str, float]) -> bool:
        return not finder.speed > 0.0 or finder.is_steady(time, observation)

    run = drive(fmu, straight, step, finder, until=ends, every=max(1, round(_WINDOW / step)), last=True)
    text, speed = f"The manoeuvre '{manoeuvre.name}' holds the speed of its start", float(run["speed"][-1])
    if run.refusal:
        raise HostError(f"{text}; straight on {run.refusal}.")
    if not finder.speed > 0.0:
        raise HostError(f"{text}, which is {finder.speed:.3g} m/s; give one above 0, as --set {INITIAL_SPEED}=22.22.")
    if finder.off() > _ENOUGH:
        raise HostError(
            f"{text}; straight on the car does not hold {finder.speed:.4g} m/s: after {run.simulated:.3g} s it is at "
            f"{speed:.4g} m/s with a throttle of {finder.throttle:.3g}; start at another speed, as --set "
            f"{INITIAL_SPEED}={max(0.9 * min(speed, finder.speed), 1.0):.3g}."
        )
    if finder.least < 0.5 * finder.speed:  # which has no sign
        raise HostError(
            f"{text}; from {finder.speed:.4g} m/s the car slows down to {finder.least:.3g} m/s before it holds it, as "
            f"one that rolls backwards does; start forwards, as --set {INITIAL_SPEED}={finder.speed:.4g}."
        )
    fmu.reset()
    fmu.messages.clear()
    time = manoeuvre.time if len(manoeuvre.time) else np.zeros(1)
    column = {THROTTLE: np.full(len(time), finder.throttle)}
    return replace(manoeuvre, time=time, inputs={**manoeuvre.inputs, **column}, find_throttle=False)


def with_change_of_speed(result: Result) -> Result:
    """A result that says what became of the speed that its throttle was to hold; above `KEPT` among what was missed."""
    speed, throttle = result["speed"], float(result[THROTTLE][0])
    change = speed / speed[0] - 1.0
    k = int(np.abs(change).argmax())
    message = (
        f"{throttle:.4g}, which holds {speed[0]:.4g} m/s straight on; the speed changes by {100.0 * change[k]:+.2g} %, "
        f"to {speed[k]:.4g} m/s at {result.time[k]:.4g} s"
    )
    if abs(change[k]) <= KEPT:
        return replace(result, notes=[*result.notes, ("throttle", message)])
    until = float(result.time[int((np.abs(change) > KEPT).argmax()) - 1])
    remedy = f"more than {100.0 * KEPT:g} %; up to --stop-time {until:.9g} it is less"
    return replace(result, missed=[*result.missed, ("throttle", f"{message}: {remedy}")])
