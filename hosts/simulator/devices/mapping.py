"""Mappings of axes and buttons of a device to inputs of the car."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from hosts.common.errors import HostError
from hosts.simulator.devices.reading import Reading, Source

CENTRED = ("steering",)
"""Inputs from -1 to 1; those of `PEDALS` are from 0 to 1."""
ANGLE = "steering_wheel_angle_demand"
"""Input of a car without `steering`, rad."""
PEDALS = ("throttle", "brake", "hand_brake")
SELECTOR = {"selector drive": 1.0, "selector neutral": 0.0, "selector reverse": -1.0}
"""Values of the input `selector` by name of the mapping of a button."""
MIN_AXIS_RANGE = 0.05
"""Smallest distance between the ends of an axis."""
MAX_DEAD_ZONE = 0.9


def drivable(inputs: Collection[str]) -> list[str]:
    """Inputs of a car that devices can drive, by their names in mappings."""
    steering = ["steering"] if {"steering", ANGLE} & {*inputs} else []
    return steering + [name for name in PEDALS if name in inputs] + (list(SELECTOR) if "selector" in inputs else [])


@dataclass(frozen=True)
class InputMapping:
    """The mapping of a source (axis or button) to an input."""

    source: str
    """Such as ``axis 0``, ``button 5`` or ``hat 0 up``."""
    inverted: bool = False
    """Whether the input increases as the axis decreases."""
    low: float = -1.0
    """Lower end of the axis, from -1 to 1; half an axis has 0 and 1, or -1 and 0."""
    high: float = 1.0
    """Upper end of the axis, likewise."""
    dead_zone: float = 0.0
    """Fraction of the range without effect, on both sides of the centre or at the rest of a pedal."""
    centre: float | None = None
    """Rest of an axis of the steering; None: halfway between the ends."""

    def value(self, name: str, reading: Reading) -> float | None:
        """The value of an input for a reading. `name`: name of the input.

        Result: from -1 to 1 for `CENTRED` inputs, otherwise from 0 to 1, exactly at the ends of the axis; None if the
        device reports no value.
        """
        source = Source.read(self.source)
        position = source.position(reading)
        if position is None:
            return None
        if source.kind != "axis":
            return 1.0 - position if self.inverted else position
        return self._centred(position) if name in CENTRED else self._pedal(position)

    def _centred(self, position: float) -> float:
        centre = 0.5 * (self.low + self.high) if self.centre is None else self.centre
        travel = self.high - centre if position >= centre else centre - self.low
        position = max(-1.0, min(1.0, (position - centre) / travel))
        magnitude = max(0.0, abs(position) - self.dead_zone) / (1.0 - self.dead_zone)
        return math.copysign(magnitude, -position if self.inverted else position) if magnitude else 0.0

    def _pedal(self, position: float) -> float:
        travel = self.high - position if self.inverted else position - self.low
        position = max(0.0, min(1.0, travel / (self.high - self.low)))
        return max(0.0, position - self.dead_zone) / (1.0 - self.dead_zone)


@dataclass(frozen=True)
class DeviceSettings:
    """Settings of a device as a whole."""

    rotation: float = 0.0
    """Rotation of the wheel from end to end, degrees, by which the steering wheel of the car turns too; 0: the ends of
    the axis are full steering."""
    force: float = 0.5
    """Factor of the force."""
    full_torque: float = 10.0
    """Torque of the steering wheel of the car for the largest force with `force` 1, N m."""
    force_inverted: bool = False
    """Whether the motor acts in the other direction."""
    smoothing: float = 0.01
    """Time constant of the force, s."""
    damper: float = 0.1
    """Share of the largest damping, always active."""
    spring: float = 0.1
    """Share of the largest centring spring, active while the car does not run."""


_RANGES = {
    "rotation": (0.0, 3600.0),
    "force": (0.0, 5.0),
    "full_torque": (0.1, 100.0),
    "smoothing": (0.0, 1.0),
    "damper": (0.0, 1.0),
    "spring": (0.0, 1.0),
}


@dataclass(frozen=True)
class DeviceMapping:
    """All stored settings of a device."""

    inputs: dict[str, InputMapping] = field(default_factory=dict)
    settings: DeviceSettings = DeviceSettings()

    def with_input(self, name: str, mapping: InputMapping | None) -> DeviceMapping:
        """A copy with another mapping of an input, or without one."""
        inputs = {k: v for k, v in self.inputs.items() if k != name}
        return replace(self, inputs=inputs if mapping is None else {**inputs, name: mapping})


def read_input(name: str, table: object) -> InputMapping:
    """The mapping of an input from a table of its fields; missing ones have their defaults.

    Raises `HostError` if a field is unknown or has an invalid value.
    """
    label = f"The mapping of '{name}'"
    if name not in (*CENTRED, *PEDALS, *SELECTOR):
        raise HostError(f"'{name}' cannot be driven by a device; {_list_text([*CENTRED, *PEDALS, *SELECTOR])} can.")
    fields = _checked_fields(label, table, asdict(InputMapping("")))
    if "source" not in fields:
        raise HostError(f"{label} has no source; it needs one such as “axis 2”.")
    source = Source.read(fields["source"])
    if source.kind != "axis" and name in CENTRED:
        raise HostError(f"{label} has the source “{source}”; '{name}' needs an axis.")
    if source.kind == "axis" and name in SELECTOR:
        raise HostError(f"{label} has the source “{source}”; '{name}' needs a button or a hat.")
    for number in ("low", "high", "centre"):
        if fields.get(number) is not None:
            fields[number] = _checked_number(label, number, fields[number], -1.0, 1.0)
    if "dead_zone" in fields:
        fields["dead_zone"] = _checked_number(label, "dead_zone", fields["dead_zone"], 0.0, MAX_DEAD_ZONE)
    _check_bool(label, fields, "inverted")
    mapping = InputMapping(**fields)
    if mapping.high - mapping.low < MIN_AXIS_RANGE:
        raise HostError(
            f"{label} has low = {mapping.low:g} and high = {mapping.high:g}; high must be larger by {MIN_AXIS_RANGE}."
        )
    margin = 0.2 * MIN_AXIS_RANGE
    if mapping.centre is not None and not mapping.low + margin <= mapping.centre <= mapping.high - margin:
        raise HostError(
            f"{label} has centre = {mapping.centre:g}, which is not between {mapping.low:g} and {mapping.high:g}."
        )
    return mapping


def read_settings(table: object, base: DeviceSettings | None = None) -> DeviceSettings:
    """Settings from a table; missing ones are those of `base`.

    Raises `HostError` if a field is unknown or has an invalid value.
    """
    subject, base = "The settings of the device", base or DeviceSettings()
    fields = _checked_fields(subject, table, asdict(base))
    _check_bool(subject, fields, "force_inverted")
    for name in fields:
        if name in _RANGES:
            fields[name] = _checked_number(subject, name, fields[name], *_RANGES[name])
    return replace(base, **fields)


def _checked_fields(subject: str, table: object, known: Mapping[str, object]) -> dict[str, Any]:
    if not isinstance(table, Mapping):
        raise HostError(f"{subject} is {table!r}; it must be a table.")
    for name in table:
        if name not in known:
            raise HostError(f"{subject} has '{name}', which is none of {_list_text(list(known))}.")
    return dict(table)


def _checked_number(subject: str, name: str, value: object, low: float, high: float) -> float:
    if isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high:
        return float(value)
    raise HostError(f"{subject} has {name} = {value!r}; it must be a number from {low:g} to {high:g}.")


def _check_bool(subject: str, fields: Mapping[str, object], name: str) -> None:
    if not isinstance(fields.get(name, False), bool):
        raise HostError(f"{subject} has {name} = {fields[name]!r}; it must be true or false.")


def _list_text(names: list[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
