"""Messages of the page about devices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from hosts.errors import HostError

if TYPE_CHECKING:
    from hosts.simulator.devices.devices import Devices


def obey(devices: Devices, message: Mapping[str, Any]) -> None:
    """Do what a message asks for; see `Devices.message`."""
    kind, device = message.get("type"), message.get("device")
    if not isinstance(device, str):
        raise HostError(f"A message about devices has the device {device!r}; it needs the id of one.")
    name, on = message.get("input"), bool(message.get("on", True))
    if kind in ("assign", "assign by moving") and not isinstance(name, str):
        raise HostError(f"A message “{kind}” has the input {name!r}; it needs the name of one.")
    if kind == "assign":
        devices.assign(device, str(name), message.get("mapping"))
    elif kind == "assign by moving":
        devices.assign_by_moving(device, str(name), on)
    elif kind == "calibrate":
        devices.calibrate(device, on, bool(message.get("keep", True)))
    elif kind == "reset mapping":
        devices.reset_mapping(device)
    elif kind == "device settings":
        devices.set_settings(device, message.get("settings", {}))
    elif kind == "test force":
        devices.test_force(device)
    else:
        raise HostError(f"A message about devices has the type {kind!r}, which is unknown.")
