"""A pilot that holds a speed, or follows one that changes, with throttle and brake."""

import math
from collections.abc import Callable, Mapping


class SpeedHolder:
    """PI control of the pedals, with feedforward of the acceleration of the target speed.

    Parameters
    ----------
    speed : float or callable
        Target, m/s, or a function of the time, s.
    gain : float
        Pedal per m/s.
    integral_gain : float
        Pedal per m.
    acceleration_gain : float
        Pedal per m/s2 of the target speed.
    brakes : bool
        Whether the brake is used.
    pedal : float, optional
        Of the first act, at the target speed; negative: of the brake. By default, and without an integral, that of the
        feedforward.
    sliding : float, optional
        Slip of both wheels of an axle from which on the throttle is reduced, to zero at twice this slip. By default,
        and without outputs of slips, it is not reduced.

    Notes
    -----
    The integral is constant while a pedal is at its stop or the throttle is reduced. `speed` must be an output.
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

    def target_speed(self, time: float) -> float:
        """Target speed at a time, m/s."""
        return self.speed(time) if callable(self.speed) else self.speed

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """See `hosts.driving.pilots.pilot.Pilot.act`; throttle and brake."""
        step, self._time = time - self._time, time
        error, forward = self.target_speed(time) - observation["speed"], 0.0
        if callable(self.speed):
            # The next communication step is as long as the last one.
            ahead = step or 1e-3
            forward = self.acceleration_gain * (self.target_speed(time + ahead) - self.target_speed(time)) / ahead
        if self._first is not None:
            self._integral, self._first = (self._first - forward) / self.integral_gain, None
        pedal = self.gain * error + self.integral_gain * self._integral + forward
        throttle_factor = self._throttle_factor(observation)
        if self._lowest < pedal < 1.0 and throttle_factor == 1.0:
            self._integral += step * error
        pedals = {"throttle": throttle_factor * min(max(pedal, 0.0), 1.0)}
        return pedals if self._lowest == 0.0 else pedals | {"brake": min(max(-pedal, 0.0), 1.0)}

    def _throttle_factor(self, observation: Mapping[str, float]) -> float:
        """The factor of the throttle at the slips of the axles, 0 to 1."""
        if self._axles is None:
            slips = [n for n in observation if n.startswith("wheel_") and n.endswith(("L.slip", "R.slip"))]
            sides = {n.removesuffix("L.slip").removesuffix("R.slip") for n in slips}
            self._axles = [[n for n in slips if n in (f"{a}L.slip", f"{a}R.slip")] for a in sorted(sides)]
        slip = max((min(observation[n] for n in axle) for axle in self._axles), default=0.0)
        return min(max(2.0 - slip / self._sliding, 0.0), 1.0)
