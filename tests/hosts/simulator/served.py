"""A server in a thread of the test, and a car that needs no FMU."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np

from hosts.common.errors import HostError
from hosts.simulator.access_control import AccessControl
from hosts.simulator.input_arbiter import InputArbiter
from hosts.simulator.server import Server
from hosts.simulator.server_needs import Content
from hosts.simulator.web import listening_socket
from tests.hosts.simulator.pages import PATIENCE

INPUTS = ("steering", "throttle", "brake", "hand_brake", "selector")
WORLD = {"name": "yard", "roads": [], "scenery": []}
PLACES = {"start": {"initial.x": 1.0, "initial.y": 2.0, "initial.yaw": 0.5}}


class FakeCar:
    """Answers as a car does; its steps are those of the clock."""

    inputs = INPUTS
    step = 0.002

    def __init__(self, count: int = 5) -> None:
        self.wanted: dict[str, tuple[float, float]] = {}
        self.wishes: list[dict[str, tuple[float, float]]] = []
        self.orders: list[Any] = []
        self.told: list[Any] = []
        self.running = True
        self._begin = time.monotonic()
        self._values = np.arange(count, dtype=float)

    def want(self, values: Any) -> None:
        self.wanted.update(values)
        self.wishes.append(dict(values))

    def command(self, name: str, value: float = 0.0) -> None:
        if name == "speed" and not 0.05 <= value <= 1.0:
            raise HostError(f"The speed is {value:g}; it must be from 0.05 to 1.")
        self.orders.append((name, value))

    def restart(self, changes: Any) -> None:
        self.orders.append(("restart", dict(changes)))

    def latest(self) -> Any:
        count = int((time.monotonic() - self._begin) / self.step) if self.running else 7
        names = ("cost", "worst", "lateness", "saved")
        return SimpleNamespace(
            count=count,
            time=count * self.step,
            epoch=3,
            running=self.running,
            refused=False,
            behind=True,
            speed=0.5,
            wall=12.5,
            missed=2,
            values=self._values,
            **dict(zip(names, (1e-4, 2e-4, 3e-4, 30.0), strict=True)),
        )

    def events(self) -> list[Any]:
        pending, self.told = self.told, []
        return pending

    def step_times(self) -> Any:
        return SimpleNamespace(report=lambda: {"steps": 11, "median": 1e-4})


@contextmanager
def serving(car: Any, access: AccessControl | None = None, address: str = "127.0.0.1") -> Iterator[Any]:
    """A server that runs; yields its port, hands, and what it told."""
    arbiter, notices = InputArbiter(car.want, car.inputs), []
    hello = {"columns": [*car.inputs, "speed"], "step": car.step, "recording": ""}
    content = Content("<!DOCTYPE html><title>page</title>", WORLD, hello, PLACES)
    access = access or AccessControl.of(address)
    server = Server(car, arbiter, content, access, lambda kind, text: notices.append(text))
    listening: socket.socket = listening_socket(address, 0)
    port = listening.getsockname()[1]
    ready, error = threading.Event(), []
    ends: dict[str, Any] = {}

    async def work() -> None:
        ends["stop"], ends["loop"] = asyncio.Event(), asyncio.get_running_loop()
        await server.run(listening, ends["stop"], ready.set)

    def thread() -> None:
        try:
            asyncio.run(work())
        except Exception as found:
            error.append(found)
            ready.set()

    running = threading.Thread(target=thread)
    running.start()
    try:
        assert ready.wait(PATIENCE)
        key = f"?token={access.token}"
        url = f"ws://127.0.0.1:{port}/drive{key}"
        yield SimpleNamespace(server=server, port=port, arbiter=arbiter, told=notices, key=key, url=url, error=error)
    finally:
        if not error:
            ends["loop"].call_soon_threadsafe(ends["stop"].set)
        running.join(PATIENCE)
    assert not running.is_alive()
