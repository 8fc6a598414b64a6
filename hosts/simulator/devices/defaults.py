"""Mappings of devices that nobody has assigned yet, by the kind that SDL reports."""

import re
from collections.abc import Collection

from hosts.simulator.devices.mapping import DeviceMapping, DeviceSettings, InputMapping
from hosts.simulator.devices.reading import Reading

ROTATION = 900.0
"""Degrees of most steering wheels for computers."""
PEDAL_DEAD_ZONE = 0.03
STICK_DEAD_ZONE = 0.08
_SIDE = 0.5
"""An axis that rests beyond this is taken for a pedal that is not pressed."""
_GAMEPAD = {
    "steering": "leftx",
    "throttle": "righttrigger",
    "brake": "lefttrigger",
    "hand_brake": "a",
    "selector drive": "dpup",
    "selector neutral": "dpleft",
    "selector reverse": "dpdown",
}
_BINDING = re.compile(r"([+-]?)a(\d+)(~?)|b(\d+)|h(\d+)\.(\d+)")
_HAT_BITS = {1: "up", 2: "right", 4: "down", 8: "left"}


def default_mapping(kind: str, reading: Reading, bindings: str, inputs: Collection[str]) -> DeviceMapping:
    """A first guess; empty for a device that nothing is known of.

    `kind`: as of `Joystick`; `reading`: as it came: a pedal that rests at the high end of its axis is inverted;
    `bindings`: SDL's table of a gamepad.
    """
    if kind == "gamepad":
        results, settings = _of_gamepad(bindings), DeviceSettings()
    elif kind == "wheel":
        results, settings = _of_wheel(reading), DeviceSettings(rotation=ROTATION)
    elif reading.axes and not reading.buttons:  # pedals by themselves
        results, settings = _pedals(reading, range(len(reading.axes))), DeviceSettings()
    else:
        results, settings = {}, DeviceSettings()
    return DeviceMapping({name: m for name, m in results.items() if name in inputs}, settings)


def _of_wheel(reading: Reading) -> dict[str, InputMapping]:
    count = len(reading.axes)
    results = {"steering": InputMapping("axis 0", inverted=True)} if count else {}
    if count == 2:  # both pedals on one axis
        results["throttle"] = InputMapping("axis 1", True, -1.0, 0.0, PEDAL_DEAD_ZONE)
        results["brake"] = InputMapping("axis 1", False, 0.0, 1.0, PEDAL_DEAD_ZONE)
        return results
    # With four axes the one after the wheel's is mostly the clutch.
    return results | _pedals(reading, range(1 if count == 3 else 2, count))


def _pedals(reading: Reading, axes: range) -> dict[str, InputMapping]:
    results = {}
    for name, k in zip(("throttle", "brake"), axes, strict=False):
        # Most pedals that do not say where they rest do so at the high end.
        inverted = not reading.known[k] or reading.axes[k] > -_SIDE
        results[name] = InputMapping(f"axis {k}", inverted, dead_zone=PEDAL_DEAD_ZONE)
    return results


def _of_gamepad(bindings: str) -> dict[str, InputMapping]:
    table = dict(part.split(":", 1) for part in bindings.split(",") if ":" in part)
    read = {name: _bound(name, table.get(where, "")) for name, where in _GAMEPAD.items()}
    return {name: mapping for name, mapping in read.items() if mapping is not None}


def _bound(name: str, binding: str) -> InputMapping | None:
    """From SDL's words: ``a2`` an axis, ``+a2`` half of it, ``~`` inverted, ``b6`` a button, ``h0.1`` a hat."""
    result = _BINDING.fullmatch(binding)
    if result is None:
        return None
    half, axis, inverted, button, hat, bit = result.groups()
    if axis is None:
        source = f"button {button}" if button is not None else f"hat {hat} {_HAT_BITS.get(int(bit), 'up')}"
        return None if name == "steering" else InputMapping(source)
    if name == "steering":
        return InputMapping(f"axis {axis}", not inverted, dead_zone=STICK_DEAD_ZONE)  # positive is to the left
    low, high = {"+": (0.0, 1.0), "-": (-1.0, 0.0)}.get(half, (-1.0, 1.0))
    if name.startswith("selector"):
        return None
    return InputMapping(f"axis {axis}", (half == "-") != bool(inverted), low, high, PEDAL_DEAD_ZONE)
