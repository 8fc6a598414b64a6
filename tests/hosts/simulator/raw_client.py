"""HTTP and WebSocket by hand, from RFC 6455: a second opinion beside a library."""

from __future__ import annotations

import base64
import hashlib
import os
import socket
import struct
from collections.abc import Mapping, Sequence

_KEY = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


def _head(port: int, path: str, headers: Mapping[str, str], upgrade: bool, more: Sequence[tuple[str, str]]) -> bytes:
    lines = {"Host": f"127.0.0.1:{port}"} | dict(headers)
    if upgrade:
        key = base64.b64encode(os.urandom(16)).decode()
        lines |= {
            "Upgrade": "websocket",
            "Connection": "Upgrade",
            "Sec-WebSocket-Key": key,
            "Sec-WebSocket-Version": "13",
        }
    pairs = [*lines.items(), *more]
    return "\r\n".join([f"GET {path} HTTP/1.1", *(f"{name}: {value}" for name, value in pairs), "", ""]).encode()


def request(
    port: int, path: str, headers: Mapping[str, str], upgrade: bool = False, more: Sequence[tuple[str, str]] = ()
) -> tuple[int, dict[str, str], bytes]:
    """Status, headers and body of an answer."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as line:
        line.sendall(_head(port, path, headers, upgrade, more))
        data = b""
        while b"\r\n\r\n" not in data:
            data += line.recv(65536)
        head, _, body = data.partition(b"\r\n\r\n")
        first, *rest = head.decode().split("\r\n")
        results = {name.lower(): value.strip() for name, value in (text.split(":", 1) for text in rest)}
        status = int(first.split()[1])
        while status != 101 and len(body) < int(results["content-length"]):
            body += line.recv(65536)
        return status, results, body


class RawClient:
    """A WebSocket of bytes."""

    def __init__(self, port: int, path: str = "/drive") -> None:
        self._line = socket.create_connection(("127.0.0.1", port), timeout=10)
        head = _head(port, path, {}, True, ())
        self._line.sendall(head)
        self._rest = b""
        answer = self._until(b"\r\n\r\n")
        key = next(text.split(": ")[1] for text in head.decode().split("\r\n") if text.startswith("Sec-WebSocket-Key"))
        assert answer.startswith(b"HTTP/1.1 101 ")
        assert base64.b64encode(hashlib.sha1((key + _KEY).encode()).digest()) in answer

    @staticmethod
    def silent(port: int) -> socket.socket:
        """A connection that never says anything."""
        return socket.create_connection(("127.0.0.1", port), timeout=10)

    def __enter__(self) -> RawClient:
        return self

    def __exit__(self, *_: object) -> None:
        self._line.close()

    def send(self, text: str) -> None:
        """A masked text frame."""
        data, mask = text.encode(), os.urandom(4)
        size = struct.pack(">B", 0x80 | len(data)) if len(data) < 126 else struct.pack(">BH", 0x80 | 126, len(data))
        self._line.sendall(b"\x81" + size + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def fragments(self, count: int) -> None:
        """A text in so many frames, each of them empty, without its last one."""
        empty = b"\x80" + bytes(4)  # masked by zeros
        self._line.sendall(b"\x01" + empty + (count - 1) * (b"\x00" + empty))

    def receive(self) -> str | bytes:
        """The next whole message."""
        first, second = self._take(2)
        assert first & 0x80
        size = second & 0x7F
        assert not second & 0x80  # a server masks nothing
        if size == 126:
            (size,) = struct.unpack(">H", self._take(2))
        elif size == 127:
            (size,) = struct.unpack(">Q", self._take(8))
        data = self._take(size)
        return data.decode() if first & 0x0F == 1 else data

    def _take(self, size: int) -> bytes:
        while len(self._rest) < size:
            more = self._line.recv(65536)
            assert more
            self._rest += more
        data, self._rest = self._rest[:size], self._rest[size:]
        return data

    def _until(self, mark: bytes) -> bytes:
        while mark not in self._rest:
            self._rest += self._line.recv(65536)
        head, _, self._rest = self._rest.partition(mark)
        return head
