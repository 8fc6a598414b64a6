"""Default mappings of devices, by the kind that SDL reports."""

import re
from collections.abc import Collection

from hosts.simulator.devices.mapping import DeviceMapping, DeviceSettings, InputMapping
from hosts.simulator.devices.reading import Reading

ROTATION = 900.0
"""Rotation of most steering wheels for computers from end to end, degrees."""
PEDAL_DEAD_ZONE = 0.03
STICK_DEAD_ZONE = 0.08
_REST_BEYOND = 0.5
"""Magnitude at rest beyond which an axis counts as a released pedal."""
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
    """The default mapping; empty for an unknown kind of device.

    `kind`: see `Joystick`; `reading`: values at rest: a pedal that rests at the high end of its axis is inverted;
    `bindings`: the mapping string of SDL for a gamepad; `inputs`: those that devices can drive.
    """
    if kind == "gamepad":
        mappings, settings = _gamepad_mapping(bindings), DeviceSettings()
    elif kind == "wheel":
        mappings, settings = _wheel_mapping(reading), DeviceSettings(rotation=ROTATION)
    elif reading.axes and not reading.buttons:  # separate pedals
        mappings, settings = _pedal_mapping(reading, range(len(reading.axes))), DeviceSettings()
    else:
        mappings, settings = {}, DeviceSettings()
    return DeviceMapping({name: m for name, m in mappings.items() if name in inputs}, settings)


def _wheel_mapping(reading: Reading) -> dict[str, InputMapping]:
    count = len(reading.axes)
    results = {"steering": InputMapping("axis 0", inverted=True)} if count else {}
    if count == 2:  # both pedals on one axis
        results["throttle"] = InputMapping("axis 1", True, -1.0, 0.0, PEDAL_DEAD_ZONE)
        results["brake"] = InputMapping("axis 1", False, 0.0, 1.0, PEDAL_DEAD_ZONE)
        return results
    # With four axes the second one is mostly the clutch.
    return results | _pedal_mapping(reading, range(1 if count == 3 else 2, count))


def _pedal_mapping(reading: Reading, axes: range) -> dict[str, InputMapping]:
    results = {}
    for name, k in zip(("throttle", "brake"), axes, strict=False):
        # Most pedals with an unknown rest rest at the high end.
        inverted = not reading.known[k] or reading.axes[k] > -_REST_BEYOND
        results[name] = InputMapping(f"axis {k}", inverted, dead_zone=PEDAL_DEAD_ZONE)
    return results


def _gamepad_mapping(bindings: str) -> dict[str, InputMapping]:
    table = dict(entry.split(":", 1) for entry in bindings.split(",") if ":" in entry)
    mappings = {name: _mapping_of_binding(name, table.get(element, "")) for name, element in _GAMEPAD.items()}
    return {name: mapping for name, mapping in mappings.items() if mapping is not None}


def _mapping_of_binding(name: str, binding: str) -> InputMapping | None:
    """The mapping of an SDL binding: ``a2`` axis, ``+a2`` half axis, ``~`` inverted, ``b6`` button, ``h0.1`` hat."""
    match = _BINDING.fullmatch(binding)
    if match is None:
        return None
    half, axis, inverted, button, hat, bit = match.groups()
    if axis is None:
        source = f"button {button}" if button is not None else f"hat {hat} {_HAT_BITS.get(int(bit), 'up')}"
        return None if name == "steering" else InputMapping(source)
    if name == "steering":
        return InputMapping(f"axis {axis}", not inverted, dead_zone=STICK_DEAD_ZONE)  # positive is to the left
    low, high = {"+": (0.0, 1.0), "-": (-1.0, 0.0)}.get(half, (-1.0, 1.0))
    if name.startswith("selector"):
        return None
    return InputMapping(f"axis {axis}", (half == "-") != bool(inverted), low, high, PEDAL_DEAD_ZONE)
