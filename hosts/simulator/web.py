"""HTTP part of the server: addresses, requests, and limits of connections."""

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
MAX_STRANGERS = 64
"""Largest number of connections without the token; a further one ends the oldest."""
MAX_PAGES = 8
MAX_ANSWERS = 16
"""Largest number of pages and worlds sent at the same time."""
STRANGERS_PER_SECOND = 400
"""Connections without the token that are accepted per second."""
BACKLOG = 1024
"""Connections that the system queues until they are accepted."""
READ_WITHIN = 10.0
"""Time without progress of an answer, s, after which its connection is ended."""
DEFAULT_PORT = 8765
_MAX_PORTS = 100
_PIECE_SIZE = 65536  # bytes of a body that are written at once
_MAX_EXAMINED = 64  # connections examined before other tasks continue
_FIRST_BYTES = 2048
_MAX_METHOD_LENGTH = 20
_NOT_ALLOWED = b"HTTP/1.1 405 Method Not Allowed\r\nAllow: GET, HEAD\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"
_UNAVAILABLE = (errno.EADDRINUSE, errno.EACCES)


class _FloodGuard(socket.socket):
    """A listening socket that closes connections of a flood before they are served.

    Under a flood it accepts connections that have sent the token with their first bytes, and some others per second.
    """

    token = b""
    _allowance, _last_time = float(STRANGERS_PER_SECOND), 0.0

    def accept(self) -> tuple[socket.socket, Any]:
        """Accept the next connection; `BlockingIOError` if there is none, or after some closed ones."""
        for _ in range(_MAX_EXAMINED):
            connection, address = super().accept()
            now = time.monotonic()
            gain = STRANGERS_PER_SECOND * (now - self._last_time)
            self._allowance, self._last_time = min(STRANGERS_PER_SECOND, self._allowance + gain), now
            if self._allowance >= 1.0:
                self._allowance -= 1.0
                return connection, address
            if self._has_token(connection):
                return connection, address
            connection.close()
        raise BlockingIOError

    def _has_token(self, connection: socket.socket) -> bool:
        connection.setblocking(False)
        try:
            return bool(self.token) and self.token in connection.recv(_FIRST_BYTES, socket.MSG_PEEK)
        except OSError:
            return False


def listening_socket(address: str, port: int | None) -> socket.socket:
    """A listening socket. `port`: by default the first free one, `DEFAULT_PORT` or above.

    Raises `HostError` if the port is not available, with the next free one, or if the address does not exist.
    """
    if port is not None and not 0 <= port <= 65535:
        raise HostError(f"The port is {port}; it must be from 1 to 65535, or 0 for any that is free.")
    first = DEFAULT_PORT if port is None else port
    for number in range(first, min(first + _MAX_PORTS, 65536)):
        try:
            result = _bound_socket(address, number)
        except OSError as error:
            if error.errno == errno.EACCES and port is not None:
                raise HostError(f"The system does not allow you to use the port {port}; give 1024 or above.") from None
            if error.errno not in _UNAVAILABLE:
                raise HostError(f"The server cannot listen on {address}: {reason(error)}.") from None
            continue
        if port is None or number == port:
            return result
        result.close()
        raise HostError(
            f"The port {port} of {address} is taken by another program; the port {number} is free: --port {number}."
        )
    raise HostError(f"The ports {first} to {first + _MAX_PORTS - 1} of {address} are all taken; give another --port.")


def _bound_socket(address: str, port: int) -> socket.socket:
    family, *_, sockaddr = socket.getaddrinfo(address, port, type=socket.SOCK_STREAM)[0]
    dual = sockaddr[0] == "::" and socket.has_dualstack_ipv6()  # the name of this machine may have an IPv4 address only
    with socket.create_server((str(sockaddr[0]), port), family=family, dualstack_ipv6=dual) as server_socket:
        if hasattr(socket, "TCP_DEFER_ACCEPT"):  # accepted connections have sent bytes, unless silent for a second
            server_socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_DEFER_ACCEPT, 1)
        return _FloodGuard(family, socket.SOCK_STREAM, fileno=server_socket.detach())


class Web:
    """Answers requests. `page`: HTML; `world`: JSON of the drawing of the world."""

    def __init__(self, access: AccessControl, page: str, world: Mapping[str, Any]) -> None:
        self._access = access
        self._kinds = {"/": "text/html; charset=utf-8", "/world": "application/json"}
        texts = {"/": page, "/world": json.dumps(world, allow_nan=False)}
        self._bodies = {(path, True): gzip.compress(text.encode(), 5, mtime=0) for path, text in texts.items()}
        self._unidentified: dict[ServerConnection, None] = {}  # oldest first
        self._being_answered: set[ServerConnection] = set()  # with the token, while a body is sent

    async def answer(self, connection: ServerConnection, request: Request, pages: int) -> Response | None:
        """The answer to a request; None: it becomes a WebSocket. `pages`: number of connected pages."""
        headers = request.headers
        try:
            path = urlsplit(request.path).path
        except ValueError:
            path = ""
        if not path.startswith("/"):
            return connection.respond(http.HTTPStatus.BAD_REQUEST, "The request names no address.\n")
        values_by_name = {name: headers.get_all(name) for name in ("Host", "Origin")}
        repeated = next((name for name, values in values_by_name.items() if len(values) > 1), None)
        refusal = f"The request says {repeated} several times." if repeated else ""
        refusal = refusal or self._access.refusal(request.path, {name: v[0] for name, v in values_by_name.items() if v})
        if refusal:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"{refusal}\n")
        self._unidentified.pop(connection, None)
        if path == DRIVE:
            if pages < MAX_PAGES:
                return None
            message = f"{pages} pages are connected, which is as many as this server takes; close one.\n"
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, message)
        if path not in self._kinds:
            return connection.respond(http.HTTPStatus.NOT_FOUND, f"There is /, the page, /world and {DRIVE}.\n")
        if len(self._being_answered) >= MAX_ANSWERS:
            message = (
                f"{MAX_ANSWERS} answers are being sent, which is as many as this server sends at once; try again.\n"
            )
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, message)
        gzipped = "gzip" in ",".join(headers.get_all("Accept-Encoding"))
        if (path, gzipped) not in self._bodies:
            self._bodies[path, gzipped] = gzip.decompress(self._bodies[path, True])
        body = self._bodies[path, gzipped]
        head = _response_head(self._kinds[path], len(body), gzipped)
        self._being_answered.add(connection)
        try:
            await _send(connection, head, b"" if getattr(request, "method", "GET") == "HEAD" else body)
        finally:
            self._being_answered.discard(connection)
        return head  # the library writes it to the closed connection

    def connection_type(self) -> type[ServerConnection]:
        """The class of connections, which counts those without the token and ends the oldest of too many."""
        web = self

        class Known(ServerConnection):
            heard: Callable[[], None] | None = None
            """Called for each frame."""
            _method = b""

            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                web._unidentified[self] = None
                if len(web._unidentified) > MAX_STRANGERS:
                    oldest = next(iter(web._unidentified))
                    del web._unidentified[oldest]
                    oldest.transport.abort()

            def data_received(self, data: bytes) -> None:
                if self.request is None:  # the library treats any method as GET, or refuses all others
                    received = self._method
                    self._method = (received + data)[:_MAX_METHOD_LENGTH]
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
                web._unidentified.pop(self, None)
                super().connection_lost(exc)

        return Known

    def watch(self, listening: socket.socket) -> None:
        """Give a socket of `listening_socket` the token for connections under a flood."""
        if isinstance(listening, _FloodGuard):
            listening.token = self._access.token.encode()

    def end_strangers(self) -> None:
        """Abort connections without a page, for which the closing server would wait."""
        for connection in (*self._unidentified, *self._being_answered):
            connection.transport.abort()


async def _send(connection: ServerConnection, head: Response, body: bytes) -> None:
    """Send an answer in pieces of a shared body; a connection that does not read is aborted."""
    transport = connection.transport
    transport.set_write_buffer_limits(0)
    transport.write(head.serialize())
    try:
        for offset in range(0, max(len(body), 1), _PIECE_SIZE):
            transport.write(body[offset : offset + _PIECE_SIZE])
            async with asyncio.timeout(READ_WITHIN):
                await connection.drain()
            if transport.is_closing():  # the client has closed the connection
                return
        transport.close()
    except (TimeoutError, OSError):
        transport.abort()


def _response_head(kind: str, size: int, gzipped: bool) -> Response:
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
