"""From the torque of the car's steering wheel to the force of a motor."""

import math

from hosts.simulator.devices.mapping import DeviceSettings

FULL = 32767
"""Level of a constant force at which the motor gives all it can; positive turns the wheel to the left."""
RISE = 0.5
"""Seconds in which the force comes up when the car starts to run, so that nothing hits the hands."""


class ForceLaw:
    """Level of the force, step by step: gain, smoothing, saturation."""

    def __init__(self) -> None:
        self._smooth = 0.0
        self._running = 0.0

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
            self._smooth = self._running = 0.0
            return 0
        self._running += step
        share = 1.0 - math.exp(-step / settings.smoothing) if settings.smoothing > 0.0 else 1.0
        self._smooth += share * (torque - self._smooth)
        rise = min(1.0, self._running / RISE)
        # What the hands feel is the opposite of what they give.
        felt = -self._smooth * rise * settings.force / settings.full_torque
        if settings.force_inverted:
            felt = -felt
        return round(FULL * max(-1.0, min(1.0, felt)))
