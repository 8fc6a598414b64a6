"""Mappings of devices in TOML files in the user's configuration folder."""

import os
from dataclasses import asdict
from pathlib import Path
from typing import Any

import tomli_w
from platformdirs import user_config_path

from ali3.errors import FileError, reason
from ali3.files import write_bytes, write_text
from ali3.message_text import brief
from ali3.reading import LARGEST_TEXT, read_bytes, read_toml
from hosts.common.errors import HostError
from hosts.simulator.devices.mapping import DeviceMapping, read_input, read_settings

FORMAT = "ALi3 device"
VERSION = 1
_HEADER = """\
# How this device drives the car; written by the simulator's page of devices, and may be edited.
# source: "axis 0", "button 3" or "hat 0 up". low, high: ends of the axis, from -1 to 1. inverted: the input grows as
# the axis falls. dead_zone: fraction of the travel without effect. centre: rest position of the steering.
"""
_KEYS = ("format", "version", "name", "serial", "settings", "inputs")


def configuration_folder() -> Path:
    """Folder of the mapping files: ``devices`` in ``ALI3_CONFIG``, otherwise in the user's configuration folder."""
    folder = os.environ.get("ALI3_CONFIG")
    if folder:
        return Path(folder, "devices")
    return user_config_path("ali3", appauthor=False) / "devices"


class MappingFiles:
    """Mapping files in a folder, one per device; the folder is made when a file is written."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def path(self, device: str) -> Path:
        """Path of the file of a device; `device`: its `id`."""
        return self.folder / f"{device}.toml"

    def serial(self, device: str) -> str:
        """Serial number in the file of a device, or empty."""
        try:
            return str(read_toml(self.path(device)).get("serial", ""))
        except FileError:
            return ""

    def read(self, device: str) -> DeviceMapping | None:
        """The mapping of a device; None if it has no file.

        Raises `HostError` if the file cannot be read or is damaged.
        """
        path = self.path(device)
        if not path.exists():
            return None
        table = read_toml(path, HostError)
        try:
            return _read_mapping(table)
        except HostError as error:
            raise HostError(f"{path} is damaged: {error}") from None

    def write(self, device: str, mapping: DeviceMapping, name: str, serial: str = "") -> None:
        """Write the file of a device. A damaged file is first copied, with `.damaged` added to its name.

        Raises `FileError` if it cannot be written.
        """
        path = self.path(device)
        inputs = {
            input: {key: value for key, value in asdict(input_mapping).items() if value is not None}
            for input, input_mapping in mapping.inputs.items()
        }
        table: dict[str, Any] = {"format": FORMAT, "version": VERSION, "name": name, "serial": serial}
        table |= {"settings": asdict(mapping.settings), "inputs": inputs}
        self._keep_damaged(device)
        write_text(path, _HEADER + tomli_w.dumps(table))

    def _keep_damaged(self, device: str) -> None:
        path = self.path(device)
        try:
            self.read(device)
        except HostError:
            if path.is_file():
                write_bytes(path.with_name(path.name + ".damaged"), read_bytes(path, LARGEST_TEXT))

    def remove(self, device: str) -> None:
        """Remove the file of a device, if there is one. Raises `HostError` if it cannot be removed."""
        try:
            self.path(device).unlink(missing_ok=True)
        except OSError as error:
            raise HostError(f"{self.path(device)} cannot be removed: {reason(error)}.") from None


def _read_mapping(table: dict[str, Any]) -> DeviceMapping:
    if table.get("format") != FORMAT or table.get("version") != VERSION:
        raise HostError(f'it must have format = "{FORMAT}" and version = {VERSION}.')
    for name in table:
        if name not in _KEYS:
            raise HostError(f"'{name}' is unknown.")
    inputs = table.get("inputs", {})
    if not isinstance(inputs, dict):
        raise HostError(f"inputs = {brief(inputs)} is not a table.")
    input_mappings = {name: read_input(name, fields) for name, fields in inputs.items()}
    return DeviceMapping(input_mappings, read_settings(table.get("settings", {})))
