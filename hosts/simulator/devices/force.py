"""The force of a motor from the torque of the steering wheel of the car."""

import math

from hosts.simulator.devices.mapping import DeviceSettings

FULL = 32767
"""Level of the largest constant force; a positive one turns the wheel to the left."""
RISE = 0.5
"""Rise time of the force when the car starts to run, s, so that there is no jerk."""


class ForceLaw:
    """The control law of the force: gain, low-pass filter and saturation."""

    def __init__(self) -> None:
        self._filtered_torque = 0.0
        self._running_time = 0.0

    def level(self, torque: float | None, settings: DeviceSettings, step: float) -> int:
        """The next level.

        Parameters
        ----------
        torque : float or None
            Of the driver's hands on the car's steering wheel, positive to the left, N m. None or not finite: the car
            does not run.
        step : float
            Time since the last call, s.

        Returns
        -------
        int
            From -`FULL` to `FULL`; 0 while the car does not run.
        """
        if torque is None or not math.isfinite(torque):
            self._filtered_torque = self._running_time = 0.0
            return 0
        self._running_time += step
        filter_gain = 1.0 - math.exp(-step / settings.smoothing) if settings.smoothing > 0.0 else 1.0
        self._filtered_torque += filter_gain * (torque - self._filtered_torque)
        rise = min(1.0, self._running_time / RISE)
        # The motor acts against the torque of the hands.
        relative_force = -self._filtered_torque * rise * settings.force / settings.full_torque
        if settings.force_inverted:
            relative_force = -relative_force
        return round(FULL * max(-1.0, min(1.0, relative_force)))
