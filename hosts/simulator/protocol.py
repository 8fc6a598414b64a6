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
MAX_MESSAGE_SIZE = 4096
"""Largest size of a message of a page, bytes."""
SOURCES = ("keys", "gamepad", "touch")
COMMANDS = ("run", "pause", "step", "speed", "reset", "rewind", "upright")
DEVICE_MESSAGES = ("assign", "assign by moving", "calibrate", "reset mapping", "device settings", "test force")
"""Types of messages that are passed on to the devices."""
_MAX_INPUTS = 64
_MAX_NUMBER = 1e9


def frame(state: CarState, step: float) -> bytes:
    """The binary frame of a state: a header of 96 bytes and the values as float64, little endian.

    `step`: communication step, s.
    """
    flags = RUNNING * state.running + REFUSED * state.refused + BEHIND * state.behind
    values = np.asarray(state.values, "<f8")
    header = HEADER.pack(
        MAGIC,
        state.epoch & 0xFFFFFFFF,
        flags,
        len(values),
        state.count,
        state.time,
        state.speed,
        state.wall,
        state.cost,
        state.worst,
        state.lateness,
        state.missed,
        step / state.speed,
        state.saved,
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
    """The page requests the step times."""


@dataclass(frozen=True)
class WatchDevices:
    """The page begins or ends to show devices."""

    on: bool


@dataclass(frozen=True)
class ForDevices:
    """A request to the devices, which check its content."""

    content: dict[str, Any]


Message = Want | Order | Seen | Place | Report | WatchDevices | ForDevices


def read_message(data: str | bytes, inputs: Collection[str]) -> Message:
    """The checked message of a page. Raises `HostError` with the reason if it is not valid."""
    if not isinstance(data, str):
        raise HostError("A message is text; this one is binary.")
    try:
        message = json_of(data.encode("utf-8", "surrogatepass"), HostError, "A message")
    except HostError:
        raise HostError("A message is a JSON object; this one cannot be read.") from None
    if not isinstance(message, dict):
        raise HostError("A message is a JSON object; this one is none.")
    kind = message.get("type")
    reader = _READERS.get(kind) if isinstance(kind, str) else None
    if reader is None:
        raise HostError(f"A message has the type {_short(kind)}; known are {', '.join(_READERS)}.")
    return reader(message, inputs)


def _read_want(message: dict[str, Any], inputs: Collection[str]) -> Want:
    source, values = message.get("source"), message.get("values")
    if source not in SOURCES:
        raise HostError(f"The source of a request is {_short(source)}; it must be {', '.join(SOURCES)}.")
    if not isinstance(values, dict) or len(values) > _MAX_INPUTS:
        raise HostError(f"The values of a request must be an object of at most {_MAX_INPUTS} inputs.")
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


def _read_order(message: dict[str, Any], inputs: Collection[str]) -> Order:
    name = message.get("name")
    if name not in COMMANDS:
        raise HostError(f"There is no command {_short(name)}; known are {', '.join(COMMANDS)}.")
    return Order(str(name), _number(message.get("value", 0.0), f"The value of {name}"))


def _read_seen(message: dict[str, Any], inputs: Collection[str]) -> Seen:
    return Seen(_number(message.get("count"), "The count of a frame that was seen", 2.0**53))


def _read_place(message: dict[str, Any], inputs: Collection[str]) -> Place:
    return Place(_text(message.get("name"), "The name of a place"))


def _read_report(message: dict[str, Any], inputs: Collection[str]) -> Report:
    return Report()


def _read_watch(message: dict[str, Any], inputs: Collection[str]) -> WatchDevices:
    on = message.get("on")
    if not isinstance(on, bool):
        raise HostError(f"'on' is {_short(on)}; it must be true or false.")
    return WatchDevices(on)


def _read_for_devices(message: dict[str, Any], inputs: Collection[str]) -> ForDevices:
    return ForDevices(message)


_READERS: dict[str, Callable[[dict[str, Any], Collection[str]], Message]] = {
    "want": _read_want,
    "command": _read_order,
    "seen": _read_seen,
    "place": _read_place,
    "report": _read_report,
    "watch devices": _read_watch,
} | dict.fromkeys(DEVICE_MESSAGES, _read_for_devices)


def _number(value: Any, subject: str, largest: float = _MAX_NUMBER) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= largest:
        raise HostError(f"{subject} is {_short(value)}; it must be a number of at most {largest:g}.")
    return float(value)


def _text(value: Any, subject: str) -> str:
    if not isinstance(value, str):
        raise HostError(f"{subject} is {_short(value)}; it must be a text.")
    return value


def _short(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."
