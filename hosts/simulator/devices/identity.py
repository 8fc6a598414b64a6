"""Persistent names of devices, under which their mappings are stored; devices of one model are distinguished."""

from collections.abc import Callable

MAX_DEVICES_OF_MODEL = 8
"""Largest number of devices of one model."""


class Identities:
    """The `id` of each connected device: its GUID, followed by ``-2`` for a second device of the same model.

    A device that is reconnected gets its former `id`. Devices of one model are distinguished by serial number, by
    port, or by their order, the first that is known.

    `stored_serial`: serial number in the file of an `id`, or empty.
    """

    def __init__(self, stored_serial: Callable[[str], str]) -> None:
        self._stored_serial = stored_serial
        self._connected: set[str] = set()
        self._known: dict[str, tuple[str, str]] = {}

    def take(self, guid: str, serial: str, path: str) -> str:
        """The `id` of a newly connected device."""
        names = (_numbered_id(guid, k) for k in range(1, len(self._connected) + MAX_DEVICES_OF_MODEL + 1))
        free = [name for name in names if name not in self._connected]
        result = self._former_id(free, serial, path) or self._unclaimed_id(free, serial)
        self._connected.add(result)
        self._known[result] = (serial, path)
        return result

    def leave(self, device: str) -> None:
        """Note that a device was disconnected."""
        self._connected.discard(device)

    def _serial(self, device: str) -> str:
        return self._known.get(device, ("", ""))[0] or self._stored_serial(device)

    def _former_id(self, free: list[str], serial: str, path: str) -> str:
        if serial:
            return next((i for i in free if self._serial(i) == serial), "")
        return next((i for i in free if path and self._known.get(i, ("", ""))[1] == path), "")

    def _unclaimed_id(self, free: list[str], serial: str) -> str:
        """The first free `id` that does not belong to another serial number."""
        return next((i for i in free if not (serial and self._serial(i))), free[-1])


def _numbered_id(guid: str, number: int) -> str:
    return guid if number == 1 else f"{guid}-{number}"
