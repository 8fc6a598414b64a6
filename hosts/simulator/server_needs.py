"""What the server needs: the interface of devices, and the content that it sends."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from hosts.common.numbers import Value


class ShownDevices(Protocol):
    """The interface of `hosts.simulator.devices.Devices` for the server."""

    def state(self) -> list[dict[str, Any]]: ...

    def message(self, content: dict[str, Any]) -> None: ...


@dataclass(frozen=True)
class Content:
    """The files and messages that the server sends."""

    page: str
    """HTML."""
    world: Mapping[str, Any]
    """JSON of the drawing of the world, as ``ali3 road --world`` writes it."""
    hello: Mapping[str, Any]
    """The first message to a page."""
    places: Mapping[str, Mapping[str, Value]]
    """Start values by name of the places of the world."""
