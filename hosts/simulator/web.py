"""HTTP side of the server: addresses, requests, and the limit of connections."""

import asyncio
import errno
import gzip
import http
import json
import socket
import time
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from ali3.errors import reason
from hosts.common.errors import HostError
from hosts.simulator.access_control import AccessControl

DRIVE = "/drive"
MOST_STRANGERS = 64
"""Connections that have not shown the token; a further one ends the oldest."""
MOST_PAGES = 8
MOST_ANSWERS = 16
"""Pages and worlds that are being sent at once."""
STRANGERS_PER_SECOND = 400
"""Connections that are taken before they have shown the token."""
BACKLOG = 1024
"""Connections that the system keeps until they are taken."""
READ_WITHIN = 10.0
"""Who takes nothing of an answer for so long, s, is ended."""
DEFAULT_PORT = 8765
_PORTS_TRIED = 100
_PIECE = 65536  # bytes of a body that are written at once
_LOOKS = 64  # connections that are looked at before others have their turn
_FIRST_BYTES = 2048
_LONGEST_METHOD = 20
_NOT_ALLOWED = b"HTTP/1.1 405 Method Not Allowed\r\nAllow: GET, HEAD\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
_TAKEN = (errno.EADDRINUSE, errno.EACCES)


class _Doors(socket.socket):
    """A socket that listens, and ends connections of a flood before they cost what a connection costs.

    Under a flood it takes those that have sent the token with their first bytes; of the others so many a second.
    """

    token = b""
    _may_come, _at = float(STRANGERS_PER_SECOND), 0.0

    def accept(self) -> tuple[socket.socket, Any]:
        """The next connection that is taken; `BlockingIOError`: there is none, or others are to have their turn."""
        for _ in range(_LOOKS):
            line, address = super().accept()
            now = time.monotonic()
            gained = STRANGERS_PER_SECOND * (now - self._at)
            self._may_come, self._at = min(STRANGERS_PER_SECOND, self._may_come + gained), now
            if self._may_come >= 1.0:
                self._may_come -= 1.0
                return line, address
            if self._knows(line):
                return line, address
            line.close()
        raise BlockingIOError

    def _knows(self, line: socket.socket) -> bool:
        line.setblocking(False)
        try:
            return bool(self.token) and self.token in line.recv(_FIRST_BYTES, socket.MSG_PEEK)
        except OSError:
            return False


def listening_socket(address: str, port: int | None) -> socket.socket:
    """A socket that listens. `port`: by default the first free one from `DEFAULT_PORT` on.

    Raises `HostError`: the port is taken, with the next free one; or there is no such address.
    """
    if port is not None and not 0 <= port <= 65535:
        raise HostError(f"The port is {port}; it must be from 1 to 65535, or 0 for any that is free.")
    first = DEFAULT_PORT if port is None else port
    for tried in range(first, min(first + _PORTS_TRIED, 65536)):
        try:
            result = _bound(address, tried)
        except OSError as error:
            if error.errno == errno.EACCES and port is not None:
                raise HostError(
                    f"The system does not allow you to use the port {port}; give one from 1024 on."
                ) from None
            if error.errno not in _TAKEN:
                raise HostError(f"The server cannot listen on {address}: {reason(error)}.") from None
            continue
        if port is None or tried == port:
            return result
        result.close()
        raise HostError(
            f"The port {port} of {address} is taken by another program; the port {tried} is free: --port {tried}."
        )
    raise HostError(f"The ports {first} to {first + _PORTS_TRIED - 1} of {address} are all taken; give another --port.")


def _bound(address: str, port: int) -> socket.socket:
    family, *_, sockaddr = socket.getaddrinfo(address, port, type=socket.SOCK_STREAM)[0]
    dual = sockaddr[0] == "::" and socket.has_dualstack_ipv6()  # the name of this machine may be one of IPv4 alone
    with socket.create_server((str(sockaddr[0]), port), family=family, dualstack_ipv6=dual) as bound:
        if hasattr(socket, "TCP_DEFER_ACCEPT"):  # who is taken has sent first bytes, unless it is silent for a second
            bound.setsockopt(socket.IPPROTO_TCP, socket.TCP_DEFER_ACCEPT, 1)
        return _Doors(family, socket.SOCK_STREAM, fileno=bound.detach())


class Web:
    """Answers requests. `page`: HTML; `world`: JSON of the drawing of the world."""

    def __init__(self, access: AccessControl, page: str, world: Mapping[str, Any]) -> None:
        self._guard = access
        self._kinds = {"/": "text/html; charset=utf-8", "/world": "application/json"}
        texts = {"/": page, "/world": json.dumps(world, allow_nan=False)}
        self._bodies = {(path, True): gzip.compress(text.encode(), 5, mtime=0) for path, text in texts.items()}
        self._strangers: dict[ServerConnection, None] = {}  # the oldest first
        self._answered: set[ServerConnection] = set()  # who has the token and is being sent a body

    async def answer(self, connection: ServerConnection, request: Request, pages: int) -> Response | None:
        """What a request gets; None: it becomes a WebSocket. `pages`: how many are connected."""
        headers = request.headers
        try:
            path = urlsplit(request.path).path
        except ValueError:
            path = ""
        if not path.startswith("/"):
            return connection.respond(http.HTTPStatus.BAD_REQUEST, "The request names no address.\n")
        results = {name: headers.get_all(name) for name in ("Host", "Origin")}
        doubled = next((name for name, values in results.items() if len(values) > 1), None)
        refusal = f"The request says {doubled} several times." if doubled else ""
        refusal = refusal or self._guard.refusal(request.path, {name: v[0] for name, v in results.items() if v})
        if refusal:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"{refusal}\n")
        self._strangers.pop(connection, None)
        if path == DRIVE:
            if pages < MOST_PAGES:
                return None
            message = f"{pages} pages are connected, which is as many as this server takes; close one.\n"
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, message)
        if path not in self._kinds:
            return connection.respond(http.HTTPStatus.NOT_FOUND, f"There is /, the page, /world and {DRIVE}.\n")
        if len(self._answered) >= MOST_ANSWERS:
            message = (
                f"{MOST_ANSWERS} answers are being sent, which is as many as this server sends at once; try again.\n"
            )
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, message)
        gzipped = "gzip" in ",".join(headers.get_all("Accept-Encoding"))
        if (path, gzipped) not in self._bodies:
            self._bodies[path, gzipped] = gzip.decompress(self._bodies[path, True])
        body = self._bodies[path, gzipped]
        head = _head(self._kinds[path], len(body), gzipped)
        self._answered.add(connection)
        try:
            await _send(connection, head, b"" if getattr(request, "method", "GET") == "HEAD" else body)
        finally:
            self._answered.discard(connection)
        return head  # the library writes it to a line that is closed

    def connection_type(self) -> type[ServerConnection]:
        """Connections that are counted until they have shown the token; who floods the server ends its own."""
        web = self

        class Known(ServerConnection):
            heard: Callable[[], None] | None = None
            """Called for each frame."""
            _method = b""

            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                web._strangers[self] = None
                if len(web._strangers) > MOST_STRANGERS:
                    oldest = next(iter(web._strangers))
                    del web._strangers[oldest]
                    oldest.transport.abort()

            def data_received(self, data: bytes) -> None:
                if self.request is None:  # the library takes any method for GET, or none but GET
                    received = self._method
                    self._method = (received + data)[:_LONGEST_METHOD]
                    method, space, _ = self._method.partition(b" ")
                    if space and method not in (b"GET", b"HEAD"):
                        if b" " not in received:
                            self.transport.write(_NOT_ALLOWED)
                            self.transport.write_eof()
                        return
                super().data_received(data)

            def process_event(self, event: Any) -> None:
                if self.heard is not None:
                    self.heard()
                super().process_event(event)

            def connection_lost(self, exc: Exception | None) -> None:
                web._strangers.pop(self, None)
                super().connection_lost(exc)

        return Known

    def watch(self, listening: socket.socket) -> None:
        """Let a listening socket of `listening_socket` know who is to come in under a flood."""
        if isinstance(listening, _Doors):
            listening.token = self._guard.token.encode()

    def end_strangers(self) -> None:
        """End the connections that no page is at the other end of, for which a server that closes would wait."""
        for connection in (*self._strangers, *self._answered):
            connection.transport.abort()


async def _send(connection: ServerConnection, head: Response, body: bytes) -> None:
    """Send an answer piece by piece, so that all that wait share its body; who does not read is ended."""
    transport = connection.transport
    transport.set_write_buffer_limits(0)
    transport.write(head.serialize())
    try:
        for offset in range(0, max(len(body), 1), _PIECE):
            transport.write(body[offset : offset + _PIECE])
            async with asyncio.timeout(READ_WITHIN):
                await connection.drain()
            if transport.is_closing():  # the other side has gone
                return
        transport.close()
    except (TimeoutError, OSError):
        transport.abort()


def _head(kind: str, size: int, gzipped: bool) -> Response:
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(size),
            "Cache-Control": "no-store",
            "Connection": "close",
            "Content-Security-Policy": "frame-ancestors 'none'",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
        }
    )
    if gzipped:
        headers["Content-Encoding"] = "gzip"
    return Response(200, "OK", headers, b"")
