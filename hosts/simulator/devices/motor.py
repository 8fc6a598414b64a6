"""The motor of a device, moved by the haptic interface of SDL."""

import ctypes
from typing import Any

from hosts.common.errors import HostError
from hosts.simulator.devices.sdl import last_error

_MAX_COEFFICIENT = 32767
_FULL_SATURATION = 0xFFFF
_STEERING_AXIS_SINCE = (2, 0, 14)
_CONDITIONS = {"damper": "SDL_HAPTIC_DAMPER", "spring": "SDL_HAPTIC_SPRING"}


class Motor:
    """The motor of a device, for use by one thread.

    `joystick`: joystick of SDL; it must stay open until the motor is closed. Raises `HostError` if the motor has no
    constant force or cannot be opened.
    """

    def __init__(self, sdl: Any, joystick: Any) -> None:
        self._sdl = sdl
        self._haptic = sdl.SDL_HapticOpenFromJoystick(joystick)
        if not self._haptic:
            raise HostError(f"its motor cannot be opened: SDL says “{last_error(sdl)}”")
        self._effects: dict[str, tuple[int, Any]] = {}
        self._levels: dict[str, int] = {}
        try:
            self._capabilities = int(sdl.SDL_HapticQuery(self._haptic))
            if not self._capabilities & sdl.SDL_HAPTIC_CONSTANT:
                raise HostError("its motor has no constant force")
            if self._capabilities & sdl.SDL_HAPTIC_GAIN:
                sdl.SDL_HapticSetGain(self._haptic, 100)
            if self._capabilities & sdl.SDL_HAPTIC_AUTOCENTER:
                sdl.SDL_HapticSetAutocenter(self._haptic, 0)  # else the device centres itself
            self._start_effect("constant", self._constant_effect(0))
        except HostError:
            self.close()
            raise

    def push(self, level: int) -> None:
        """Set the constant force. `level`: number from -32767 to 32767, positive to the left.

        Raises `HostError` if the device refuses it.
        """
        if self._levels.get("constant") == level:
            return
        self._update_effect("constant", self._constant_effect(level))
        self._levels["constant"] = level

    def condition(self, kind: str, level: float) -> bool:
        """Set a damper or a centring spring; False if the device has none.

        `kind`: ``damper`` or ``spring``; `level`: fraction of the largest coefficient, 0 to 1. Raises `HostError` if
        the device refuses it.
        """
        number = getattr(self._sdl, _CONDITIONS[kind])
        if not self._capabilities & number:
            return False
        coefficient = round(_MAX_COEFFICIENT * max(0.0, min(1.0, level)))
        if self._levels.get(kind, 0) == coefficient:
            return True
        effect = self._condition_effect(number, coefficient)
        if kind in self._effects:
            self._update_effect(kind, effect)
        else:
            self._start_effect(kind, effect)
        self._levels[kind] = coefficient
        return True

    def close(self) -> None:
        """Stop and close the motor, without raising an error."""
        if not self._haptic:
            return
        sdl, haptic = self._sdl, self._haptic
        if "constant" in self._effects:
            number, _ = self._effects["constant"]
            sdl.SDL_HapticUpdateEffect(haptic, number, ctypes.byref(self._constant_effect(0)))
        for number, _ in self._effects.values():
            sdl.SDL_HapticStopEffect(haptic, number)
            sdl.SDL_HapticDestroyEffect(haptic, number)
        self._effects.clear()
        sdl.SDL_HapticStopAll(haptic)
        sdl.SDL_HapticClose(haptic)
        self._haptic = None

    def _start_effect(self, kind: str, effect: Any) -> None:
        sdl = self._sdl
        number = sdl.SDL_HapticNewEffect(self._haptic, ctypes.byref(effect))
        if number < 0:
            raise HostError(f"its motor refuses a {kind} force: SDL says “{last_error(sdl)}”")
        self._effects[kind] = number, effect
        if sdl.SDL_HapticRunEffect(self._haptic, number, 1) < 0:
            raise HostError(f"its motor does not start a {kind} force: SDL says “{last_error(sdl)}”")

    def _update_effect(self, kind: str, effect: Any) -> None:
        number, _ = self._effects[kind]
        if self._sdl.SDL_HapticUpdateEffect(self._haptic, number, ctypes.byref(effect)) < 0:
            raise HostError(f"its motor refuses a {kind} force: SDL says “{last_error(self._sdl)}”")
        self._effects[kind] = number, effect

    def _constant_effect(self, level: int) -> Any:
        effect = self._sdl.SDL_HapticEffect()
        effect.type = self._sdl.SDL_HAPTIC_CONSTANT
        self._set_direction(effect.constant.direction)
        effect.constant.length = self._sdl.SDL_HAPTIC_INFINITY
        effect.constant.level = level
        return effect

    def _condition_effect(self, number: int, coefficient: int) -> Any:
        effect = self._sdl.SDL_HapticEffect()
        effect.type = number
        self._set_direction(effect.condition.direction)
        effect.condition.length = self._sdl.SDL_HAPTIC_INFINITY
        for k in range(3):
            effect.condition.right_sat[k] = effect.condition.left_sat[k] = _FULL_SATURATION
            effect.condition.right_coeff[k] = effect.condition.left_coeff[k] = coefficient
        return effect

    def _set_direction(self, direction: Any) -> None:
        """Set the direction from which a force comes: a positive one from the right pushes to the left."""
        version = self._sdl.SDL_version()
        self._sdl.SDL_GetVersion(ctypes.byref(version))
        if (version.major, version.minor, version.patch) >= _STEERING_AXIS_SINCE:
            direction.type = self._sdl.SDL_HAPTIC_STEERING_AXIS
        else:
            direction.type = self._sdl.SDL_HAPTIC_CARTESIAN
            direction.dir[0] = 1
