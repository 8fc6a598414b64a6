"""A pilot that holds a speed, or follows one that changes, with throttle and brake."""

import math
from collections.abc import Callable, Mapping


class SpeedHolder:
    """PI control of the pedals, with the acceleration of the wanted speed fed forward.

    Parameters
    ----------
    speed : float or callable
        Wanted, m/s; or a function of the time in s.
    gain : float
        Pedal per m/s.
    integral_gain : float
        Pedal per m.
    acceleration_gain : float
        Pedal per m/s2 of the wanted speed.
    brakes : bool
        Whether the brake is used; else a car that is too fast rolls.
    pedal : float, optional
        Of its first act, at the wanted speed; negative: of the brake. Default, and
        without an integral: what the acceleration asks for.
    sliding : float, optional
        Slip of both wheels of an axle from which on the throttle is eased, to none at twice this slip; default: never.
        A car that does not report the slips of its wheels is driven as by default.

    Notes
    -----
    The integral waits while a pedal is at its stop or the throttle is eased. `speed` must be an output of the car.
    """

    def __init__(
        self,
        speed: float | Callable[[float], float],
        gain: float = 0.3,
        integral_gain: float = 0.1,
        acceleration_gain: float = 0.1,
        brakes: bool = True,
        pedal: float | None = None,
        sliding: float = math.inf,
    ) -> None:
        self.speed = speed
        self.gain = gain
        self.integral_gain = integral_gain
        self.acceleration_gain = acceleration_gain
        self._lowest = -1.0 if brakes else 0.0
        self._integral = 0.0
        self._first = pedal if integral_gain else None
        self._time = 0.0
        self._sliding = sliding
        self._axles: list[list[str]] | None = None if sliding < math.inf else []

    def wanted(self, time: float) -> float:
        """Speed that is wanted at a time, m/s."""
        return self.speed(time) if callable(self.speed) else self.speed

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """See `hosts.driving.pilots.pilot.Pilot.act`; throttle and brake."""
        step, self._time = time - self._time, time
        error, forward = self.wanted(time) - observation["speed"], 0.0
        if callable(self.speed):
            # The communication step that is coming is as long as the last one.
            ahead = step or 1e-3
            forward = self.acceleration_gain * (self.wanted(time + ahead) - self.wanted(time)) / ahead
        if self._first is not None:
            self._integral, self._first = (self._first - forward) / self.integral_gain, None
        pedal = self.gain * error + self.integral_gain * self._integral + forward
        throttle_factor = self._left(observation)
        if self._lowest < pedal < 1.0 and throttle_factor == 1.0:
            self._integral += step * error
        pedals = {"throttle": throttle_factor * min(max(pedal, 0.0), 1.0)}
        return pedals if self._lowest == 0.0 else pedals | {"brake": min(max(-pedal, 0.0), 1.0)}

    def _left(self, observation: Mapping[str, float]) -> float:
        """The part of the throttle that an axle which slides leaves."""
        if self._axles is None:
            slips = [n for n in observation if n.startswith("wheel_") and n.endswith(("L.slip", "R.slip"))]
            sides = {n.removesuffix("L.slip").removesuffix("R.slip") for n in slips}
            self._axles = [[n for n in slips if n in (f"{a}L.slip", f"{a}R.slip")] for a in sorted(sides)]
        slip = max((min(observation[n] for n in axle) for axle in self._axles), default=0.0)
        return min(max(2.0 - slip / self._sliding, 0.0), 1.0)
