"""Connected devices, read by the joystick interface of SDL."""

import ctypes
from dataclasses import dataclass
from typing import Any

from hosts.simulator.devices.reading import Reading
from hosts.simulator.devices.sdl import text

_LOWEST = -32768
_HIGHEST = 32767
_ALL_EVENTS = 0x0, 0xFFFF


@dataclass
class Joystick:
    """An opened device."""

    sdl: Any
    handle: Any
    """Pointer of SDL."""
    instance: int
    """Number that SDL assigns at each connection."""
    guid: str
    """The same for all devices of a model."""
    serial: str
    path: str
    """`serial`, `path`: empty if not known."""
    name: str
    kind: str
    """``wheel``, ``gamepad`` or ``other``."""
    bindings: str
    """Mapping string of SDL for a gamepad."""
    usb: str
    """Numbers of vendor and product, such as ``046d:c24f``."""

    def __post_init__(self) -> None:
        count = (self.sdl.SDL_JoystickNumAxes, self.sdl.SDL_JoystickNumButtons, self.sdl.SDL_JoystickNumHats)
        self._axes, self._buttons, self._hats = (range(max(0, number(self.handle))) for number in count)
        self._known = [False] * len(self._axes)
        self._initial_value = ctypes.c_int16()

    def read(self) -> Reading:
        """The values at the last `Joysticks.update`."""
        sdl, handle = self.sdl, self.handle
        for k in self._axes:
            if not self._known[k]:
                has_initial_state = sdl.SDL_JoystickGetAxisInitialState(handle, k, ctypes.byref(self._initial_value))
                self._known[k] = bool(has_initial_state)
        return Reading(
            tuple([_share(sdl.SDL_JoystickGetAxis(handle, k)) for k in self._axes]),
            tuple(self._known),
            tuple([bool(sdl.SDL_JoystickGetButton(handle, k)) for k in self._buttons]),
            tuple([int(sdl.SDL_JoystickGetHat(handle, k)) for k in self._hats]),
        )

    def close(self) -> None:
        self.sdl.SDL_JoystickClose(self.handle)


class Joysticks:
    """All devices, for use by one thread. `sdl`: initialised."""

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
                refused.append(text(sdl.SDL_JoystickNameForIndex(index)) or "A device without a name")
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
            sdl,
            handle,
            sdl.SDL_JoystickInstanceID(handle),
            text(guid.value),
            text(sdl.SDL_JoystickGetSerial(handle)),
            text(sdl.SDL_JoystickPath(handle)),
            text(sdl.SDL_JoystickName(handle)) or "device without a name",
            "wheel" if wheel else "gamepad" if gamepad else "other",
            text(sdl.SDL_GameControllerMappingForDeviceIndex(index)) if gamepad else "",
            f"{sdl.SDL_JoystickGetVendor(handle):04x}:{sdl.SDL_JoystickGetProduct(handle):04x}",
        )


def _share(value: int) -> float:
    """The share from -1 to 1 of an integer of SDL; both ends are exact."""
    return value / _HIGHEST if value >= 0 else -value / _LOWEST
