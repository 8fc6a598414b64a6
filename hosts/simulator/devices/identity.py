"""Persistent names of devices, under which their mappings are stored; devices of one model are distinguished."""

from collections.abc import Callable

MOST_OF_A_MODEL = 8
"""Devices of one model that are remembered."""


class Identities:
    """An `id` for each connected device: its GUID, followed by ``-2`` for a second device of the same model.

    A device that is reconnected gets its former `id`. Devices of one model are distinguished by serial number, else by
    port, else by their order.

    `kept_serial`: serial number in the file of an `id`, else empty.
    """

    def __init__(self, kept_serial: Callable[[str], str]) -> None:
        self._kept_serial = kept_serial
        self._there: set[str] = set()
        self._before: dict[str, tuple[str, str]] = {}

    def take(self, guid: str, serial: str, path: str) -> str:
        """The `id` of a device that was connected."""
        names = (_named(guid, k) for k in range(1, len(self._there) + MOST_OF_A_MODEL + 1))
        free = [name for name in names if name not in self._there]
        result = self._same(free, serial, path) or self._unclaimed(free, serial)
        self._there.add(result)
        self._before[result] = (serial, path)
        return result

    def leave(self, device: str) -> None:
        """The device was disconnected."""
        self._there.discard(device)

    def _serial(self, device: str) -> str:
        return self._before.get(device, ("", ""))[0] or self._kept_serial(device)

    def _same(self, free: list[str], serial: str, path: str) -> str:
        if serial:
            return next((i for i in free if self._serial(i) == serial), "")
        return next((i for i in free if path and self._before.get(i, ("", ""))[1] == path), "")

    def _unclaimed(self, free: list[str], serial: str) -> str:
        """The first that does not belong to another device; without serial numbers the first."""
        return next((i for i in free if not (serial and self._serial(i))), free[-1])


def _named(guid: str, number: int) -> str:
    return guid if number == 1 else f"{guid}-{number}"
