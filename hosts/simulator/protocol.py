"""The protocol between server and page: binary frames of numbers to the page, checked messages from it."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ali3.json_reading import json_of
from hosts.common.errors import HostError

if TYPE_CHECKING:
    from hosts.simulator.car import CarState

VERSION = 1
MAGIC = 0x31463341
"""The bytes ``A3F1``, little endian."""
HEADER = struct.Struct("<4I10d")
RUNNING = 1
REFUSED = 2
BEHIND = 4
LARGEST_MESSAGE = 4096
"""Bytes of a message of a page."""
SOURCES = ("keys", "gamepad", "touch")
COMMANDS = ("run", "pause", "step", "speed", "reset", "rewind", "upright")
DEVICE_MESSAGES = ("assign", "assign by moving", "calibrate", "reset mapping", "device settings", "test force")
"""Types of messages that go to the devices as they are."""
_MOST_INPUTS = 64
_LARGEST = 1e9


def frame(moment: CarState, step: float) -> bytes:
    """A moment as a page reads it: a header of 96 bytes and the values as float64, little endian.

    `step`: communication step, s.
    """
    flags = RUNNING * moment.running + REFUSED * moment.refused + BEHIND * moment.behind
    values = np.asarray(moment.values, "<f8")
    header = HEADER.pack(
        MAGIC,
        moment.epoch & 0xFFFFFFFF,
        flags,
        len(values),
        moment.count,
        moment.time,
        moment.speed,
        moment.wall,
        moment.cost,
        moment.worst,
        moment.lateness,
        moment.missed,
        step / moment.speed,
        moment.saved,
    )
    return header + values.tobytes()


@dataclass(frozen=True)
class Want:
    """A page requests values of inputs."""

    source: str
    values: dict[str, tuple[float, float]]


@dataclass(frozen=True)
class Order:
    """A command for the car."""

    name: str
    value: float


@dataclass(frozen=True)
class Seen:
    """The page acknowledges a frame."""

    count: float


@dataclass(frozen=True)
class Place:
    """A new start at a place of the world."""

    name: str


@dataclass(frozen=True)
class Report:
    """The page asks for the step times."""


@dataclass(frozen=True)
class WatchDevices:
    """The page shows devices, or does no longer."""

    on: bool


@dataclass(frozen=True)
class ForDevices:
    """A request to devices, which check its content."""

    content: dict[str, Any]


Message = Want | Order | Seen | Place | Report | WatchDevices | ForDevices


def read_message(data: str | bytes, inputs: Collection[str]) -> Message:
    """A message of a page, checked. Raises `HostError`: it is no such message; with the reason."""
    if not isinstance(data, str):
        raise HostError("A message is text; this one is binary.")
    try:
        result = json_of(data.encode("utf-8", "surrogatepass"), HostError, "A message")
    except HostError:
        raise HostError("A message is a JSON object; this one cannot be read.") from None
    if not isinstance(result, dict):
        raise HostError("A message is a JSON object; this one is none.")
    kind = result.get("type")
    reader = _READERS.get(kind) if isinstance(kind, str) else None
    if reader is None:
        raise HostError(f"A message has the type {_short(kind)}; known are {', '.join(_READERS)}.")
    return reader(result, inputs)


def _want(message: dict[str, Any], inputs: Collection[str]) -> Want:
    source, values = message.get("source"), message.get("values")
    if source not in SOURCES:
        raise HostError(f"The source of a request is {_short(source)}; it must be {', '.join(SOURCES)}.")
    if not isinstance(values, dict) or len(values) > _MOST_INPUTS:
        raise HostError(f"The values of a request must be an object of at most {_MOST_INPUTS} inputs.")
    results = {}
    for name, pair in values.items():
        if name not in inputs:
            raise HostError(f"The car has no input {_short(name)}; it has {', '.join(inputs) or 'none'}.")
        if not isinstance(pair, list) or len(pair) != 2:
            raise HostError(f"The request for {name} is {_short(pair)}; it must be [value, rate].")
        value = _number(pair[0], f"The value for {name}")
        rate = math.inf if pair[1] is None else _number(pair[1], f"The rate for {name}")
        if not rate > 0.0:
            raise HostError(f"The rate for {name} is {rate:g}; it must be positive.")
        results[name] = (value, rate)
    return Want(str(source), results)


def _order(message: dict[str, Any], inputs: Collection[str]) -> Order:
    name = message.get("name")
    if name not in COMMANDS:
        raise HostError(f"There is no command {_short(name)}; known are {', '.join(COMMANDS)}.")
    return Order(str(name), _number(message.get("value", 0.0), f"The value of {name}"))


def _seen(message: dict[str, Any], inputs: Collection[str]) -> Seen:
    return Seen(_number(message.get("count"), "The count of a frame that was seen", 2.0**53))


def _place(message: dict[str, Any], inputs: Collection[str]) -> Place:
    return Place(_text(message.get("name"), "The name of a place"))


def _report(message: dict[str, Any], inputs: Collection[str]) -> Report:
    return Report()


def _watch(message: dict[str, Any], inputs: Collection[str]) -> WatchDevices:
    on = message.get("on")
    if not isinstance(on, bool):
        raise HostError(f"'on' is {_short(on)}; it must be true or false.")
    return WatchDevices(on)


def _for_devices(message: dict[str, Any], inputs: Collection[str]) -> ForDevices:
    return ForDevices(message)


_READERS: dict[str, Callable[[dict[str, Any], Collection[str]], Message]] = {
    "want": _want,
    "command": _order,
    "seen": _seen,
    "place": _place,
    "report": _report,
    "watch devices": _watch,
} | dict.fromkeys(DEVICE_MESSAGES, _for_devices)


def _number(value: Any, what: str, largest: float = _LARGEST) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= largest:
        raise HostError(f"{what} is {_short(value)}; it must be a number of at most {largest:g}.")
    return float(value)


def _text(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise HostError(f"{what} is {_short(value)}; it must be a text.")
    return value


def _short(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."
