"""Access control of the server: a token in the address, and the origin of requests."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import parse_qs, urlsplit

_LOCAL_NAMES = ("localhost",)


@dataclass(frozen=True)
class AccessControl:
    """The token and origins that a request is checked against."""

    address: str
    """Address on which the server listens."""
    token: str
    """Secret part of the address, because other users of this machine reach its ports too."""

    @classmethod
    def of(cls, address: str) -> AccessControl:
        """The access control of an address, with a new token."""
        return cls(address, secrets.token_urlsafe(24))

    @property
    def is_local(self) -> bool:
        """Whether only this machine reaches the server."""
        return _is_local(self.address)

    def refusal(self, path: str, headers: Mapping[str, str]) -> str:
        """A sentence on why a request is refused; empty if it is accepted.

        `path`: path with its query; `headers`: ``Host`` and, from browsers, ``Origin``, each at most once.
        """
        host = headers.get("Host", "")
        if not self._is_own_host(host):
            # DNS rebinding: a foreign name that resolves to this server is then in Host
            return f"A request must name this server by its own address, not {host[:80]!r}."
        origin = headers.get("Origin")
        if origin is not None and origin.lower() != f"http://{host.lower()}":
            return f"Only pages of this server may talk to it; the request is from a page of {origin[:80]!r}."
        tokens = parse_qs(urlsplit(path).query).get("token", [""])
        if not secrets.compare_digest(tokens[0].encode(), self.token.encode()):
            return "This server is guarded; open the address with the token that it printed when it was started."
        return ""

    def _is_own_host(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        if _is_local(name):
            return True
        if self.is_local:
            return False
        names = (socket.gethostname().lower(), socket.getfqdn().lower())
        return name == self.address or name in names or _address(name) is not None


def _is_local(name: str) -> bool:
    result = _address(name)
    return name in _LOCAL_NAMES if result is None else result.is_loopback


def _address(name: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(name)
    except ValueError:
        return None
