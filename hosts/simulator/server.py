"""The server between car and pages: frames of numbers to them, requests and commands from them.

It shares memory with the car's process; neither waits for the other.
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
from hosts.simulator.web import BACKLOG, MOST_PAGES, Web

FRAME_PERIOD = 1 / 120
"""Frames of a page are at least so far apart, s."""
NEW_START_PERIOD = 0.25
"""Commands that put the car elsewhere are taken at most so often, s."""
_NEW_STARTS = ("reset", "rewind", "upright")
_PUMP_PERIOD = 0.05
_POLICY_VIOLATION = 1008
_CAR_ENDED = 1011  # of RFC 6455: the server cannot go on
_ANSWER_TIMEOUT = 120  # s, for a world over a slow line
_LONGEST_REASON = 120  # a close frame takes 123 bytes


class Server:
    """Serves pages.

    `tell`: takes kind and text of what happens, for the terminal. `devices`: what pages see of them; None: the
    simulator has none.
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
        self._served = 0
        self._last_new_start = -NEW_START_PERIOD
        self._left_alone = False
        self._first_frame: Callable[[], None] | None = None
        self._said: deque[str] = deque(maxlen=100)

    def say(self, text: str) -> None:
        """A sentence for the terminal and all pages; may be called from any thread."""
        self._said.append(text)

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
        logger.setLevel(logging.CRITICAL + 1)  # what others send that is no HTTP is not worth a line
        self._web.watch(listening)
        async with serve(
            self._talk,
            sock=listening,
            backlog=BACKLOG,
            process_request=lambda connection, request: self._web.answer(connection, request, len(self._pages)),
            create_connection=self._web.connection_type(),
            compression=None,
            max_size=protocol.LARGEST_MESSAGE,
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
            except HostError as error:  # pages are told why, before they lose the server
                for page in list(self._pages.values()):
                    await page.connection.close(_CAR_ENDED, str(error)[:_LONGEST_REASON])
                raise
            finally:
                self._web.end_strangers()
                for task in tasks:
                    task.cancel()

    async def _talk(self, connection: ServerConnection) -> None:
        """All that happens with one page."""
        if len(self._pages) >= MOST_PAGES:  # several came at once
            await connection.close(_POLICY_VIOLATION, "Too many pages are connected.")
            return
        self._served += 1
        page = self._pages[self._served] = ConnectedPage(self._served, connection)
        page.texts.append(self._hello)
        self._came_back()
        if self.devices is not None:
            page.texts.append(_text("devices", devices=self.devices.state()))
        feed = asyncio.create_task(self._feed(page))
        ending: list[asyncio.Task[None]] = []

        def heard() -> None:
            """Count a frame, of which a message may have any number without a byte."""
            try:
                page.heard()
            except HostError as error:
                if not ending:
                    ending.append(asyncio.create_task(self._end(page, error)))

        connection.heard = heard  # type: ignore[attr-defined]
        try:
            async for data in connection:
                await self._take(page, data)
        except ConnectionClosed:
            pass
        except HostError as error:
            await self._end(page, error)
        finally:
            feed.cancel()
            del self._pages[page.number]
            self._let_go(page, "was closed")
            if page.watched:
                self._left()

    async def _end(self, page: ConnectedPage, error: HostError) -> None:
        """End the connection of a page that does what it must not."""
        self._tell("told", f"Page {page.number} is closed: {error}")
        await page.connection.close(_POLICY_VIOLATION, str(error)[:_LONGEST_REASON])

    def _left(self) -> None:
        """With nobody who sees it the car stands."""
        with contextlib.suppress(HostError):  # a car that has ended stands
            if not self._pages and self._car.latest().running:
                self._car.command("pause")
                self._left_alone = True
                self._tell("told", "Paused: the last page is gone; the car drives on when one comes back.")

    def _came_back(self) -> None:
        if self._left_alone:
            self._left_alone = False
            with contextlib.suppress(HostError):
                self._car.command("run")

    async def _take(self, page: ConnectedPage, data: str | bytes) -> None:
        """What a page says; a sentence goes back where it is refused."""
        try:
            message = protocol.read_message(data, self._car.inputs)
        except HostError as error:
            page.malformed()
            page.texts.append(_text("refused", text=str(error)))
            return
        try:
            await self._do(page, message)
        except HostError as error:
            page.texts.append(_text("refused", text=str(error)))

    async def _do(self, page: ConnectedPage, message: protocol.Message) -> None:
        if isinstance(message, protocol.Seen):
            page.saw(message.count)
        elif isinstance(message, protocol.Want):
            self._arbiter.want(page.source(message.source), message.values)
        elif isinstance(message, protocol.Order):
            self._check_pace(message.name)
            self._car.command(message.name, message.value)
        elif isinstance(message, protocol.Place):
            place = self._place(message.name)
            self._check_pace("reset")
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

    def _place(self, name: str) -> Mapping[str, Value]:
        if name not in self._places:
            raise HostError(f"The world has no place {name[:40]!r}; it has {', '.join(self._places) or 'none'}.")
        return self._places[name]

    def _check_pace(self, name: str) -> None:
        if name not in _NEW_STARTS:
            return
        now = time.monotonic()
        if now - self._last_new_start < NEW_START_PERIOD:
            raise HostError(f"'{name}' came less than {NEW_START_PERIOD:g} s after the one before; it is ignored.")
        self._last_new_start = now

    async def _feed(self, page: ConnectedPage) -> None:
        """Texts and frames to a page; whoever does not read waits here alone."""
        last_sent: object = None
        with contextlib.suppress(ConnectionClosed, HostError):  # a car that has ended is seen by the pump
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
        """Events of the car and devices to all pages; pages that stall let go."""
        device_states: list[dict[str, Any]] = []
        while True:
            for event in self._car.events():
                self._report_all(event.kind, event.time, event.text)
            while self._said:
                self._report_all("told", self._car.latest().time, self._said.popleft())
            for page in list(self._pages.values()):
                if page.stalls():
                    self._let_go(page, "no longer sends messages")
            device_states = self._show_devices(device_states)
            await asyncio.sleep(_PUMP_PERIOD)

    def _show_devices(self, before: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """What has changed of devices: to pages that watch, and where one comes or goes to all."""
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

    def _let_go(self, page: ConnectedPage, why: str) -> None:
        released = [name for source in sorted(page.sources) for name in self._arbiter.gone(source)]
        if released:
            self._report_all(
                "told", self._car.latest().time, f"Page {page.number} {why}: {', '.join(released)} let go."
            )

    def _report_all(self, kind: str, seconds: float, text: str) -> None:
        """A sentence for the terminal and all pages."""
        self._tell(kind, text)
        for page in self._pages.values():
            page.texts.append(_text("event", kind=kind, time=seconds, text=text))


def _text(type_: str, **content: Any) -> str:
    return json.dumps({"type": type_, **content}, allow_nan=False)
