"""What the server needs: a car, devices, and what it hands out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from hosts.common.numbers import Value

if TYPE_CHECKING:
    from hosts.simulator.car import Event, Moment
    from hosts.simulator.step_times import StepTimes


class DrivenCar(Protocol):
    """What the server needs of a car; see `hosts.simulator.car.Car`."""

    @property
    def inputs(self) -> tuple[str, ...]: ...

    @property
    def step(self) -> float: ...

    def command(self, name: str, value: float = 0.0) -> None: ...

    def restart(self, changes: Mapping[str, Value]) -> None: ...

    def latest(self) -> Moment: ...

    def events(self) -> list[Event]: ...

    def step_times(self) -> StepTimes: ...


class ShownDevices(Protocol):
    """What the server needs of devices; see `hosts.simulator.devices.Devices`."""

    def state(self) -> list[dict[str, Any]]: ...

    def message(self, content: dict[str, Any]) -> None: ...


@dataclass(frozen=True)
class Content:
    """What the server hands out."""

    page: str
    """HTML."""
    world: Mapping[str, Any]
    """JSON of the drawing of the world, as ``ali3 road --world`` writes it."""
    hello: Mapping[str, Any]
    """The first message to a page."""
    places: Mapping[str, Mapping[str, Value]]
    """Start values by name of the places of the world."""
