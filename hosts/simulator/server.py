"""The server between car and pages: frames of numbers to them, requests and commands from them.

It shares memory with the process of the car; neither waits for the other.
"""

import asyncio
import contextlib
import json
import logging
import socket
import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.simulator import protocol
from hosts.simulator.access_control import AccessControl
from hosts.simulator.aliased_car import AliasedCar
from hosts.simulator.connected_page import ConnectedPage
from hosts.simulator.input_arbiter import InputArbiter
from hosts.simulator.server_needs import Content, ShownDevices
from hosts.simulator.web import BACKLOG, MAX_PAGES, Web

FRAME_PERIOD = 1 / 120
"""Shortest time between frames of a page, s."""
NEW_START_PERIOD = 0.25
"""Shortest time between commands that move the car, s."""
_NEW_STARTS = ("reset", "rewind", "upright")
_PUMP_PERIOD = 0.05
_POLICY_VIOLATION = 1008
_CAR_ENDED = 1011  # of RFC 6455: the server cannot go on
_ANSWER_TIMEOUT = 120  # s, for a world over a slow connection
_MAX_REASON_LENGTH = 120  # a close frame takes 123 bytes


class Server:
    """Serves pages.

    `tell`: called with kind and text of events, for the terminal. `devices`: shown to pages; None without devices.
    """

    def __init__(
        self,
        car: AliasedCar,
        arbiter: InputArbiter,
        content: Content,
        access: AccessControl,
        tell: Callable[[str, str], None],
    ) -> None:
        self._car = car
        self._arbiter = arbiter
        self._tell = tell
        self.devices: ShownDevices | None = None
        self._places = content.places
        self._web = Web(access, content.page, content.world)
        self._hello = _text("hello", version=protocol.VERSION, **content.hello)
        self._pages: dict[int, ConnectedPage] = {}
        self._page_count = 0
        self._last_new_start = -NEW_START_PERIOD
        self._paused_without_pages = False
        self._first_frame: Callable[[], None] | None = None
        self._messages: deque[str] = deque(maxlen=100)

    def say(self, text: str) -> None:
        """Send a message to the terminal and all pages, from any thread."""
        self._messages.append(text)

    async def run(
        self,
        listening: socket.socket,
        stop: asyncio.Event,
        ready: Callable[[], None] = lambda: None,
        first_frame: Callable[[], None] | None = None,
    ) -> None:
        """Serve until `stop` is set.

        Parameters
        ----------
        listening : socket
            See `hosts.simulator.web.listening_socket`.
        ready : callable
            Called when pages can come.
        first_frame : callable, optional
            Called when the first frame has been sent.

        Raises
        ------
        HostError
            The car has ended.
        """
        self._first_frame = first_frame
        logger = logging.getLogger(__name__)
        logger.setLevel(logging.CRITICAL + 1)  # requests that are not HTTP are not logged
        self._web.watch(listening)
        async with serve(
            self._serve_page,
            sock=listening,
            backlog=BACKLOG,
            process_request=lambda connection, request: self._web.answer(connection, request, len(self._pages)),
            create_connection=self._web.connection_type(),
            compression=None,
            max_size=protocol.MAX_MESSAGE_SIZE,
            max_queue=32,
            open_timeout=_ANSWER_TIMEOUT,
            close_timeout=1,
            server_header=None,
            logger=logger,
        ):
            ready()
            tasks = [asyncio.create_task(self._pump()), asyncio.create_task(stop.wait())]
            try:
                finished, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                for task in finished:
                    task.result()
            except HostError as error:  # the reason for the pages
                for page in list(self._pages.values()):
                    await page.connection.close(_CAR_ENDED, str(error)[:_MAX_REASON_LENGTH])
                raise
            finally:
                self._web.end_strangers()
                for task in tasks:
                    task.cancel()

    async def _serve_page(self, connection: ServerConnection) -> None:
        """Serve one page until it is closed."""
        if len(self._pages) >= MAX_PAGES:  # several pages connected at the same time
            await connection.close(_POLICY_VIOLATION, "Too many pages are connected.")
            return
        self._page_count += 1
        page = self._pages[self._page_count] = ConnectedPage(self._page_count, connection)
        page.texts.append(self._hello)
        self._resume()
        if self.devices is not None:
            page.texts.append(_text("devices", devices=self.devices.state()))
        feed = asyncio.create_task(self._feed(page))
        ending: list[asyncio.Task[None]] = []

        def heard() -> None:
            """Count a WebSocket frame; a message may consist of many empty ones."""
            try:
                page.heard()
            except HostError as error:
                if not ending:
                    ending.append(asyncio.create_task(self._close_page(page, error)))

        connection.heard = heard  # type: ignore[attr-defined]
        try:
            async for data in connection:
                await self._receive(page, data)
        except ConnectionClosed:
            pass
        except HostError as error:
            await self._close_page(page, error)
        finally:
            feed.cancel()
            del self._pages[page.number]
            self._release_inputs(page, "was closed")
            if page.watched:
                self._pause_without_pages()

    async def _close_page(self, page: ConnectedPage, error: HostError) -> None:
        """Close the connection of a page that violates a limit."""
        self._tell("told", f"Page {page.number} is closed: {error}")
        await page.connection.close(_POLICY_VIOLATION, str(error)[:_MAX_REASON_LENGTH])

    def _pause_without_pages(self) -> None:
        """Pause the car if no page is left."""
        with contextlib.suppress(HostError):  # the car may have ended
            if not self._pages and self._car.latest().running:
                self._car.command("pause")
                self._paused_without_pages = True
                self._tell("told", "Paused: the last page is gone; the car drives on when one comes back.")

    def _resume(self) -> None:
        if self._paused_without_pages:
            self._paused_without_pages = False
            with contextlib.suppress(HostError):
                self._car.command("run")

    async def _receive(self, page: ConnectedPage, data: str | bytes) -> None:
        """Read and execute a message of a page; a refusal is sent back."""
        try:
            message = protocol.read_message(data, self._car.inputs)
        except HostError as error:
            page.malformed()
            page.texts.append(_text("refused", text=str(error)))
            return
        try:
            await self._execute(page, message)
        except HostError as error:
            page.texts.append(_text("refused", text=str(error)))

    async def _execute(self, page: ConnectedPage, message: protocol.Message) -> None:
        if isinstance(message, protocol.Seen):
            page.saw(message.count)
        elif isinstance(message, protocol.Want):
            self._arbiter.want(page.source(message.source), message.values)
        elif isinstance(message, protocol.Order):
            self._check_rate(message.name)
            self._car.command(message.name, message.value)
        elif isinstance(message, protocol.Place):
            place = self._place_values(message.name)
            self._check_rate("reset")
            self._car.restart(place)
        elif isinstance(message, protocol.Report):
            page.texts.append(_text("report", **self._car.step_times().report()))
        elif self.devices is None:
            raise HostError("This simulator was started without devices.")
        elif isinstance(message, protocol.WatchDevices):
            page.watches_devices = message.on
            page.texts.append(_text("devices", devices=self.devices.state()))
        else:
            await asyncio.to_thread(self.devices.message, message.content)

    def _place_values(self, name: str) -> Mapping[str, Value]:
        if name not in self._places:
            raise HostError(f"The world has no place {name[:40]!r}; it has {', '.join(self._places) or 'none'}.")
        return self._places[name]

    def _check_rate(self, name: str) -> None:
        if name not in _NEW_STARTS:
            return
        now = time.monotonic()
        if now - self._last_new_start < NEW_START_PERIOD:
            raise HostError(f"'{name}' came less than {NEW_START_PERIOD:g} s after the one before; it is ignored.")
        self._last_new_start = now

    async def _feed(self, page: ConnectedPage) -> None:
        """Send texts and frames to a page; only this task waits for a page that does not read."""
        last_sent: object = None
        with contextlib.suppress(ConnectionClosed, HostError):  # `_pump` reports the end of the car
            while True:
                while page.texts:
                    await page.connection.send(page.texts.popleft())
                if page.takes_more:
                    moment = self._car.latest()
                    state = (moment.count, moment.epoch, moment.running, moment.refused, moment.behind, moment.speed)
                    if state != last_sent:
                        last_sent = state
                        page.sent(moment.count)
                        await page.connection.send(protocol.frame(moment, self._car.step))
                        if self._first_frame is not None:
                            callback, self._first_frame = self._first_frame, None
                            callback()
                await asyncio.sleep(FRAME_PERIOD)

    async def _pump(self) -> None:
        """Send events of the car and devices to all pages, and release inputs of pages that stall."""
        device_states: list[dict[str, Any]] = []
        while True:
            for event in self._car.events():
                self._report_all(event.kind, event.time, event.text)
            while self._messages:
                self._report_all("told", self._car.latest().time, self._messages.popleft())
            for page in list(self._pages.values()):
                if page.stalls():
                    self._release_inputs(page, "no longer sends messages")
            device_states = self._show_devices(device_states)
            await asyncio.sleep(_PUMP_PERIOD)

    def _show_devices(self, before: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """Send changed states of devices to pages that watch them, and added or removed devices to all pages."""
        if self.devices is None or not self._pages:
            return before
        state = self.devices.state()
        if state != before:
            devices_changed = [device.get("id") for device in state] != [device.get("id") for device in before]
            text = _text("devices", devices=state)
            for page in self._pages.values():
                if devices_changed or page.watches_devices:
                    page.texts.append(text)
        return state

    def _release_inputs(self, page: ConnectedPage, reason: str) -> None:
        released = [name for source in sorted(page.sources) for name in self._arbiter.gone(source)]
        if released:
            self._report_all(
                "told", self._car.latest().time, f"Page {page.number} {reason}: {', '.join(released)} let go."
            )

    def _report_all(self, kind: str, seconds: float, text: str) -> None:
        """Send an event to the terminal and all pages."""
        self._tell(kind, text)
        for page in self._pages.values():
            page.texts.append(_text("event", kind=kind, time=seconds, text=text))


def _text(type_: str, **content: Any) -> str:
    return json.dumps({"type": type_, **content}, allow_nan=False)
