"""Force feedback: the force of a motor from the torque of the steering wheel, and the thread that moves it."""

import math
import threading
import time
from collections.abc import Callable
from typing import Any

from hosts.common.errors import HostError
from hosts.simulator.devices.mapping import DeviceSettings
from hosts.simulator.devices.motor import Motor

PERIOD = 0.008
"""Period of updates, s; motors on USB take about 125 values per second."""
PULSE = 0.3
"""Force of a test, relative to the largest force."""
_PULSE_TIME = 0.4  # s
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


class ForceFeedback:
    """Moves the motor of a device in a thread until it is stopped or fails.

    Parameters
    ----------
    sdl : module
        The initialised library.
    joystick : pointer
        Pointer to SDL_Joystick, open until `stop` has returned True.
    torque : callable
        Torque of the driver's hands on the car's steering wheel, N m, positive to the left; None while the car does not
        run.
    settings : callable
        Returns the present settings of the device.
    fail : callable
        Called with the reason if the force ends by itself.
    """

    def __init__(
        self,
        sdl: Any,
        joystick: Any,
        torque: Callable[[], float | None],
        settings: Callable[[], DeviceSettings],
        fail: Callable[[str], None],
    ) -> None:
        self._sdl, self._joystick = sdl, joystick
        self._torque, self._settings, self._fail = torque, settings, fail
        self._end = threading.Event()
        self._pulse_until = 0.0
        self.works = False
        """Whether the motor moves."""
        self.level = 0
        """Present level of the constant force."""
        self._thread = threading.Thread(target=self._run, name="force feedback", daemon=True)
        self._thread.start()

    def pulse(self) -> None:
        """Push to the left briefly, independently of the car."""
        self._pulse_until = time.monotonic() + _PULSE_TIME

    def stop(self, timeout: float) -> bool:
        """Stop the motor. Returns whether the thread has ended within `timeout` s."""
        self._end.set()
        self._thread.join(timeout)
        return not self._thread.is_alive()

    def _run(self) -> None:
        """Run in the thread, which opens the motor and closes it."""
        try:
            motor = Motor(self._sdl, self._joystick)
        except HostError as error:
            self._fail(str(error))
            return
        self.works = True
        reason = ""
        try:
            self._move(motor)
        except HostError as error:
            reason = str(error)
        except Exception as error:  # after any error of `torque` the motor must be stopped
            reason = f"{type(error).__name__}: {error}"
        finally:
            self.works, self.level = False, 0
            motor.close()
        if reason and not self._end.is_set():
            self._fail(reason)

    def _move(self, motor: Motor) -> None:
        """Set the forces every `PERIOD` until the end."""
        law = ForceLaw()
        last = time.monotonic()
        while not self._end.is_set():
            now = time.monotonic()
            settings, torque = self._settings(), self._torque()
            level = law.level(torque, settings, now - last)
            last = now
            if now < self._pulse_until:
                level = round(PULSE * FULL) * (-1 if settings.force_inverted else 1)
            motor.push(level)
            self.level = level
            motor.condition("damper", settings.damper)
            motor.condition("spring", settings.spring if torque is None else 0.0)
            time.sleep(max(0.0, PERIOD - (time.monotonic() - now)))
