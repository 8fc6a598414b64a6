"""The side of the server that any program can reach: addresses, requests, and the number of connections."""

from __future__ import annotations

import asyncio
import errno
import gzip
import http
import json
import socket
from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from ali3.errors import reason
from hosts.common.errors import HostError
from hosts.simulator.guard import Guard

DRIVE = "/drive"
MOST_STRANGERS = 64
"""Connections that have not shown the token; a further one ends the oldest."""
MOST_PAGES = 8
DEFAULT_PORT = 8765
_PORTS_TRIED = 100
_TAKEN = (errno.EADDRINUSE, errno.EACCES)


def listening_socket(address: str, port: int | None) -> socket.socket:
    """A socket that listens. `port`: by default the first free one from `DEFAULT_PORT` on.

    Raises `HostError`: the port is taken, with the next free one; or there is no such address.
    """
    if port is not None and not 0 <= port <= 65535:
        raise HostError(f"The port is {port}; it must be from 1 to 65535, or 0 for any that is free.")
    first = DEFAULT_PORT if port is None else port
    for tried in range(first, min(first + _PORTS_TRIED, 65536)):
        try:
            found = _bound(address, tried)
        except OSError as error:
            if error.errno == errno.EACCES and port is not None:
                raise HostError(f"The port {port} may not be used by you; ports from 1024 on may.") from None
            if error.errno not in _TAKEN:
                raise HostError(f"The server cannot listen on {address}: {reason(error)}.") from None
            continue
        if port is None or tried == port:
            return found
        found.close()
        raise HostError(
            f"The port {port} of {address} is taken by another program; the port {tried} is free: --port {tried}."
        )
    raise HostError(f"The ports {first} to {first + _PORTS_TRIED - 1} of {address} are all taken; give another --port.")


def _bound(address: str, port: int) -> socket.socket:
    family, *_, place = socket.getaddrinfo(address, port, type=socket.SOCK_STREAM)[0]
    return socket.create_server((str(place[0]), port), family=family)


class Web:
    """Answers requests. `page`: HTML; `world`: JSON of the drawing of the world."""

    def __init__(self, guard: Guard, page: str, world: Mapping[str, Any]) -> None:
        self._guard = guard
        self._bodies = {
            "/": ("text/html; charset=utf-8", _packed(page)),
            "/world": ("application/json", _packed(json.dumps(world, allow_nan=False))),
        }
        self._strangers: dict[ServerConnection, None] = {}  # the oldest first

    def answer(self, connection: ServerConnection, request: Request, pages: int) -> Response | None:
        """What a request gets; None: it becomes a WebSocket. `pages`: how many are connected."""
        headers = request.headers
        found = {name: headers.get_all(name) for name in ("Host", "Origin")}
        doubled = next((name for name, values in found.items() if len(values) > 1), None)
        refusal = f"The request says {doubled} several times." if doubled else ""
        refusal = refusal or self._guard.refusal(request.path, {name: v[0] for name, v in found.items() if v})
        if refusal:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"{refusal}\n")
        self._strangers.pop(connection, None)
        path = urlsplit(request.path).path
        if path == DRIVE:
            if pages < MOST_PAGES:
                return None
            words = f"{pages} pages are connected, which is as many as this server takes; close one.\n"
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, words)
        if path not in self._bodies:
            return connection.respond(http.HTTPStatus.NOT_FOUND, f"There is /, the page, /world and {DRIVE}.\n")
        kind, body = self._bodies[path]
        return _response(kind, body, "gzip" in ",".join(headers.get_all("Accept-Encoding")))

    def connection_type(self) -> type[ServerConnection]:
        """Connections that are counted until they have shown the token; who floods the server ends its own."""
        web = self

        class Known(ServerConnection):
            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                web._strangers[self] = None
                if len(web._strangers) > MOST_STRANGERS:
                    oldest = next(iter(web._strangers))
                    del web._strangers[oldest]
                    oldest.transport.abort()

            def connection_lost(self, exc: Exception | None) -> None:
                web._strangers.pop(self, None)
                super().connection_lost(exc)

        return Known

    def end_strangers(self) -> None:
        """End the connections that have not shown the token, for which a server that closes would wait."""
        for connection in self._strangers:
            connection.transport.abort()


def _packed(text: str) -> bytes:
    return gzip.compress(text.encode("utf-8"), 5, mtime=0)


def _response(kind: str, packed: bytes, gzipped: bool) -> Response:
    body = packed if gzipped else gzip.decompress(packed)
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
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
    return Response(200, "OK", headers, body)
