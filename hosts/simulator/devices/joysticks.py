"""Connected joysticks, wheels and gamepads, read through the joystick interface of SDL."""

import ctypes
from dataclasses import dataclass
from typing import Any

from hosts.simulator.devices.reading import Reading
from hosts.simulator.devices.sdl import text

_MIN_AXIS = -32768
_MAX_AXIS = 32767
_ALL_EVENTS = 0x0, 0xFFFF  # SDL_FIRSTEVENT, SDL_LASTEVENT
_NAMELESS = "device without a name"


@dataclass
class Joystick:
    """An opened device."""

    sdl: Any
    """Library of SDL."""
    handle: Any
    """Pointer to SDL_Joystick."""
    instance: int
    """Number that SDL assigns at each connection."""
    guid: str
    """The same for all devices of a model."""
    serial: str
    """Serial number; empty if not known."""
    path: str
    """Path of the port; empty if not known."""
    name: str
    kind: str
    """``wheel``, ``gamepad`` or ``other``."""
    bindings: str
    """Mapping string of SDL for a gamepad."""
    usb: str
    """USB vendor and product id, hexadecimal, such as ``046d:c24f``."""

    def __post_init__(self) -> None:
        counters = (self.sdl.SDL_JoystickNumAxes, self.sdl.SDL_JoystickNumButtons, self.sdl.SDL_JoystickNumHats)
        self._axes, self._buttons, self._hats = (range(max(0, count(self.handle))) for count in counters)
        self._has_axis_value = [False] * len(self._axes)
        self._initial_value = ctypes.c_int16()  # required by SDL, not used

    def read(self) -> Reading:
        """Read the values at the last `Joysticks.update`."""
        sdl, handle = self.sdl, self.handle
        for k in self._axes:  # an axis that has not moved since its connection may not have a value yet
            if not self._has_axis_value[k]:
                has_initial_state = sdl.SDL_JoystickGetAxisInitialState(handle, k, ctypes.byref(self._initial_value))
                self._has_axis_value[k] = bool(has_initial_state)
        return Reading(
            tuple([_normalised(sdl.SDL_JoystickGetAxis(handle, k)) for k in self._axes]),
            tuple(self._has_axis_value),
            tuple([bool(sdl.SDL_JoystickGetButton(handle, k)) for k in self._buttons]),
            tuple([int(sdl.SDL_JoystickGetHat(handle, k)) for k in self._hats]),
        )

    def close(self) -> None:
        """Close the device."""
        self.sdl.SDL_JoystickClose(self.handle)


class Joysticks:
    """All connected devices, for use by one thread. `sdl`: the initialised library."""

    def __init__(self, sdl: Any) -> None:
        self._sdl = sdl
        self._devices_by_instance: dict[int, Joystick] = {}
        self._refused: set[int] = set()

    def update(self) -> tuple[list[Joystick], list[Joystick], list[str]]:
        """Read the values of all devices, and find those that were connected or disconnected.

        Returns
        -------
        added, removed : list of Joystick
            The caller closes removed ones.
        refused : list of str
            Names of connected devices that cannot be opened.
        """
        sdl = self._sdl
        sdl.SDL_JoystickUpdate()
        sdl.SDL_FlushEvents(*_ALL_EVENTS)  # unread events would fill the queue of SDL
        present = {sdl.SDL_JoystickGetDeviceInstanceID(k): k for k in range(sdl.SDL_NumJoysticks())}
        removed = [self._devices_by_instance.pop(i) for i in [*self._devices_by_instance] if i not in present]
        self._refused &= present.keys()
        added, refused = [], []
        for instance, index in present.items():
            if instance < 0 or instance in self._devices_by_instance or instance in self._refused:
                continue
            joystick = self._open_device(index)
            if joystick is None:
                self._refused.add(instance)
                refused.append(text(sdl.SDL_JoystickNameForIndex(index)) or f"A {_NAMELESS}")
            else:
                self._devices_by_instance[instance] = joystick
                added.append(joystick)
        return added, removed, refused

    def close(self) -> None:
        """Close all devices."""
        for joystick in self._devices_by_instance.values():
            joystick.close()
        self._devices_by_instance.clear()

    def _open_device(self, index: int) -> Joystick | None:
        sdl = self._sdl
        handle = sdl.SDL_JoystickOpen(index)
        if not handle:
            return None
        guid = ctypes.create_string_buffer(33)
        sdl.SDL_JoystickGetGUIDString(sdl.SDL_JoystickGetGUID(handle), guid, 33)
        gamepad = bool(sdl.SDL_IsGameController(index))
        wheel = sdl.SDL_JoystickGetType(handle) == sdl.SDL_JOYSTICK_TYPE_WHEEL
        return Joystick(
            sdl=sdl,
            handle=handle,
            instance=sdl.SDL_JoystickInstanceID(handle),
            guid=text(guid.value),
            serial=text(sdl.SDL_JoystickGetSerial(handle)),
            path=text(sdl.SDL_JoystickPath(handle)),
            name=text(sdl.SDL_JoystickName(handle)) or _NAMELESS,
            kind="wheel" if wheel else "gamepad" if gamepad else "other",
            bindings=text(sdl.SDL_GameControllerMappingForDeviceIndex(index)) if gamepad else "",
            usb=f"{sdl.SDL_JoystickGetVendor(handle):04x}:{sdl.SDL_JoystickGetProduct(handle):04x}",
        )


def _normalised(value: int) -> float:
    """Axis value of SDL, scaled to -1 to 1, exactly at both ends."""
    return value / _MAX_AXIS if value >= 0 else -value / _MIN_AXIS
