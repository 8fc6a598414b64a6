"""SDL's virtual devices, and what stands in for the car's side."""

import ctypes
import warnings
from collections.abc import Callable, Mapping

import pytest

pytest.importorskip("sdl2dll", reason="SDL is not installed")
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import sdl2

WHEEL = sdl2.SDL_JOYSTICK_TYPE_WHEEL
GAMEPAD = sdl2.SDL_JOYSTICK_TYPE_GAMECONTROLLER
OTHER = sdl2.SDL_JOYSTICK_TYPE_UNKNOWN
ALL_AXES = 0x3F
INPUTS = ("steering", "throttle", "brake", "hand_brake", "selector", "steering_wheel_angle_demand")
ANGLE_MAX = 8.97597901


class VirtualDevice:
    """A device that SDL reads like a real one; SDL's subsystem of joysticks must be running."""

    def __init__(self, kind: int = WHEEL, name: str = "Wheel", axes: int = 4, buttons: int = 12, hats: int = 1) -> None:
        d = sdl2.SDL_VirtualJoystickDesc()
        d.version = sdl2.SDL_VIRTUAL_JOYSTICK_DESC_VERSION
        d.type, d.naxes, d.nbuttons, d.nhats = kind, axes, buttons, hats
        d.vendor_id, d.product_id, d.name = 0x1234, 0x5678, name.encode()
        if kind == GAMEPAD:
            d.axis_mask = ALL_AXES
        index = sdl2.SDL_JoystickAttachVirtualEx(ctypes.byref(d))
        assert index >= 0, sdl2.SDL_GetError()
        self.instance = sdl2.SDL_JoystickGetDeviceInstanceID(index)
        self.handle = sdl2.SDL_JoystickOpen(index)

    def axis(self, number: int, value: float) -> None:
        """Set an axis, from -1 to 1."""
        raw = round(value * (32767 if value >= 0 else 32768))
        assert sdl2.SDL_JoystickSetVirtualAxis(self.handle, number, raw) == 0

    def button(self, number: int, down: bool) -> None:
        assert sdl2.SDL_JoystickSetVirtualButton(self.handle, number, down) == 0

    def hat(self, number: int, bits: int) -> None:
        assert sdl2.SDL_JoystickSetVirtualHat(self.handle, number, bits) == 0

    def pull_out(self) -> None:
        for index in range(sdl2.SDL_NumJoysticks()):
            if sdl2.SDL_JoystickGetDeviceInstanceID(index) == self.instance:
                sdl2.SDL_JoystickClose(self.handle)
                assert sdl2.SDL_JoystickDetachVirtual(index) == 0
                return


def rested(device: VirtualDevice) -> VirtualDevice:
    """A wheel whose pedals rest at the high end, as most do."""
    for k in (1, 2, 3):
        device.axis(k, 1.0)
    return device


class RecordedArbiter:
    """In place of `InputArbiter`: keeps what each source wants last."""

    def __init__(self) -> None:
        self.by_source: dict[str, dict[str, tuple[float, float]]] = {}
        self.left: list[str] = []
        self.listen: Callable[[str, Mapping[str, tuple[float, float]]], None] = lambda source, values: None

    def want(self, source: str, values: Mapping[str, tuple[float, float]]) -> None:
        self.listen(source, values)
        self.by_source.setdefault(source, {}).update(values)

    def gone(self, source: str) -> list[str]:
        self.left.append(source)
        return [name for name, (value, _) in self.by_source.pop(source, {}).items() if value and name != "selector"]

    def value(self, source: str, name: str) -> float | None:
        return self.by_source.get(source, {}).get(name, (None, None))[0]
