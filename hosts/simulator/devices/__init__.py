"""Steering wheels, pedals and gamepads of this computer, read and moved by SDL."""

from hosts.simulator.devices.devices import Devices
from hosts.simulator.devices.mapping_files import configuration_folder

__all__ = ["Devices", "configuration_folder"]
