"""Driving from pages: the server, the devices of this machine, and the browser."""

from __future__ import annotations

import asyncio
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ali3.extras import missing_module
from ali3.signals import handled, heeded
from ali3.temporary_folder import temporary_folder
from hosts.common.errors import HostError
from hosts.simulator.access_control import AccessControl
from hosts.simulator.aliased_car import AliasedCar
from hosts.simulator.input_arbiter import InputArbiter
from hosts.simulator.server import Server
from hosts.simulator.server_needs import Content
from viewer.open_browser import open_secretly

if TYPE_CHECKING:
    from hosts.simulator.run_report import RunReport
    from hosts.simulator.server_needs import ShownDevices

_TORQUE = "steering_wheel_torque"
_OUTDATED = 0.1
_ANY_ADDRESS = ("0.0.0.0", "::")


@dataclass(frozen=True)
class PageServer:
    """A listening socket for pages, with options."""

    listening: socket.socket
    access: AccessControl
    browser: bool
    """Whether to open a browser."""
    devices: bool
    """Whether to read wheels and gamepads of this machine."""

    @property
    def address(self) -> str:
        """The address that a browser opens."""
        host, port = self.listening.getsockname()[:2]
        if host in _ANY_ADDRESS:
            host = socket.gethostname()
        name = f"[{host}]" if ":" in host else host
        return f"http://{name}:{port}/?token={self.access.token}"


def drive_with_pages(car: AliasedCar, content: Content, page_server: PageServer, report: RunReport) -> None:
    """Serve pages until Ctrl-C. `car`: paused; the first frame of the first page starts it.

    Raises `HostError` if the car has ended.
    """
    arbiter = InputArbiter(car.want, car.inputs)
    server = Server(car, arbiter, content, page_server.access, report.add_event)

    def report_ready() -> None:
        report.show_ready()
        report.show(f"Drive at {page_server.address}")
        if not page_server.access.is_local:
            report.show("Whoever has this address can drive; its traffic is not encrypted.")
        if page_server.browser and not open_secretly(page_server.address, folder):
            report.show("No browser could be opened from here; open the address in one, on this machine.")
        report.show("Ctrl-C ends with the report.")

    def start() -> None:
        report.show_first_frame()
        car.command("run")

    async def work() -> None:
        stop = asyncio.Event()
        with _interrupted_by_signals(asyncio.get_running_loop(), stop):
            await server.run(page_server.listening, stop, report_ready, start)

    with ExitStack() as stack:
        folder = stack.enter_context(temporary_folder())
        if page_server.devices:
            _add_devices(stack, server, arbiter, car)
        asyncio.run(work())


def _add_devices(stack: ExitStack, server: Server, arbiter: InputArbiter, car: AliasedCar) -> None:
    """Add wheels and gamepads, if their packages are installed."""
    try:
        from hosts.simulator.devices import Devices, configuration_folder
    except ModuleNotFoundError as error:
        server.say(f"Wheels and gamepads of this machine are not read. {missing_module(error)}")
        return
    torque = _torque_reader(car) if _TORQUE in car.names else None
    devices: ShownDevices = stack.enter_context(
        Devices(arbiter, car.inputs, car.constants, server.say, configuration_folder(), torque)
    )
    server.devices = devices


def _torque_reader(car: AliasedCar) -> Callable[[], float | None]:
    """A function that returns the torque at the steering wheel, N m; None while the car does not run."""
    index = car.names.index(_TORQUE)

    def torque() -> float | None:
        try:
            state = car.latest()
        except HostError:
            return None
        if not state.running or state.refused or time.perf_counter() - state.wall > _OUTDATED:
            return None
        return float(state.values[index])

    return torque


@contextmanager
def _interrupted_by_signals(loop: asyncio.AbstractEventLoop, stop: asyncio.Event) -> Iterator[None]:
    """A context in which the first Ctrl-C or termination signal sets `stop`, and a second one interrupts."""

    def end(number: signal.Signals, before: Any) -> None:
        if number.name != "SIGHUP":
            signal.signal(number, before)
        loop.call_soon_threadsafe(stop.set)

    with handled(end, heeded()):
        yield
