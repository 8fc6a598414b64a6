"""Steering wheels, pedals and gamepads, for the host of the car."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from ali3.message_text import word_list
from hosts.common.errors import HostError
from hosts.simulator.devices.calibration import Assignment, Calibration
from hosts.simulator.devices.device import ANGLE_MAX, Device, Steering
from hosts.simulator.devices.device_text import drivable_text
from hosts.simulator.devices.mapping import DeviceMapping, drivable, read_input, read_settings
from hosts.simulator.devices.reader import ArbiterLike, Reader
from hosts.simulator.devices.reading import Source

ASSIGN_TIME = 15.0
"""s for which an input waits to be assigned by moving something."""


class Devices:
    """Wheels, pedals and gamepads that drive the car; a context manager.

    A message reports a missing SDL or device; everything else works.

    Parameters
    ----------
    arbiter : InputArbiter
        Receives the requests of devices, with the source ``device NAME``.
    constants : mapping of str to float
        Constants of the car, of which `vehicle.steering_wheel_angle_max` is used.
    tell : callable
        Called with messages, from any thread.
    torque : callable or None
        Torque of the driver's hands on the car's steering wheel, N m, positive to the left; None while the car does not
        run. Called from a thread of each motor. None: the car has no such output.
    """

    def __init__(
        self,
        arbiter: ArbiterLike,
        inputs: Collection[str],
        constants: Mapping[str, float],
        tell: Callable[[str], None],
        folder: Path,
        torque: Callable[[], float | None] | None,
    ) -> None:
        self._inputs = drivable(inputs)
        steering = Steering(constants.get(ANGLE_MAX), "steering" not in inputs)
        self._reader = Reader(arbiter, self._inputs, steering, tell, Path(folder), torque)

    def __enter__(self) -> Devices:
        self._reader.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop all motors and threads."""
        self._reader.close()

    def state(self) -> list[dict[str, Any]]:
        """The connected devices as JSON for pages."""
        with self._reader.lock:
            return [device.state() for device in self._reader.devices.values()]

    def assign(self, device: str, name: str, mapping: Mapping[str, Any] | None) -> None:
        """Replace the mapping of an input, and store it in the file of the device.

        `device`: its `id`; `mapping`: fields of `InputMapping`; None: the device does not drive this input. Raises
        `HostError` if the device is not connected, or the mapping is wrong; nothing changes.
        """
        with self._reader.lock:
            connected = self._device(device)
            assigned = None if mapping is None else read_input(name, mapping)
            if name not in self._inputs:
                raise HostError(f"The car has no input for '{name}'; {drivable_text(self._inputs)}.")
            if assigned is not None and not Source.read(assigned.source).is_in(connected.reading):
                raise HostError(f"{connected.label} has no {assigned.source}; it has {connected.reading.counts()}.")
            self._reader.remap(connected, connected.mapping.with_input(name, assigned))

    def assign_by_moving(self, device: str, name: str, on: bool = True) -> None:
        """Assign the next axis or button that is moved to an input, or end this; see `assign`."""
        with self._reader.lock:
            connected = self._device(device)
            if name not in self._inputs:
                raise HostError(f"The car has no input for '{name}'; {drivable_text(self._inputs)}.")
            connected.assignment = Assignment(name, connected.reading, time.monotonic() + ASSIGN_TIME) if on else None

    def calibrate(self, device: str, on: bool, keep: bool = True) -> None:
        """Begin a calibration, or end it.

        `device`: its `id`; `on`: whether to begin; the device drives nothing until the end; `keep`: whether the result
        is used at the end. Raises `HostError` if the device is not connected.
        """
        with self._reader.lock:
            connected = self._device(device)
            if on:
                self._reader.let_go(connected)
                connected.calibration = Calibration(connected.mapping)
                return
            calibration, connected.calibration = connected.calibration, None
            if calibration is None or not keep:
                return
            mapping, calibrated, unmoved = calibration.result()
            self._reader.remap(connected, mapping)
            if calibrated:
                self._reader.tell(f"{connected.label}: the ends of {word_list(calibrated)} are found.")
            if unmoved:
                self._reader.tell(f"{connected.label}: {word_list(unmoved)} was not moved far enough and is as before.")

    def reset_mapping(self, device: str) -> None:
        """Return to the default mapping of the kind of device, and remove its file."""
        with self._reader.lock:
            connected = self._device(device)
            self._reader.files.remove(device)
            self._reader.remap(connected, self._reader.default(connected.joystick), save=False)

    def set_settings(self, device: str, settings: Mapping[str, Any]) -> None:
        """Change some `DeviceSettings` and store them in the file of the device; see `assign` for errors."""
        with self._reader.lock:
            connected = self._device(device)
            device_settings = read_settings(settings, connected.mapping.settings)
            self._reader.remap(connected, DeviceMapping(connected.mapping.inputs, device_settings))

    def test_force(self, device: str) -> None:
        """Push the wheel to the left briefly. Raises `HostError` if the device is not connected or has no motor."""
        with self._reader.lock:
            connected = self._device(device)
            if connected.force is None or not connected.force.works:
                raise HostError(f"{connected.label} has no force: {connected.force_problem or 'it has no motor'}.")
            connected.force.pulse()

    def message(self, message: Mapping[str, Any]) -> None:
        """Execute a message of a page.

        `message`: `type` is ``assign``, ``assign by moving``, ``calibrate``, ``reset mapping``, ``device settings`` or
        ``test force``; `device` an `id`; see the method of that name for other fields. Raises `HostError` if it
        cannot be executed; nothing changes.
        """
        kind, device = message.get("type"), message.get("device")
        if not isinstance(device, str):
            raise HostError(f"A message about devices has the device {device!r}; it needs the id of one.")
        name, on = message.get("input"), bool(message.get("on", True))
        if kind in ("assign", "assign by moving") and not isinstance(name, str):
            raise HostError(f"A message “{kind}” has the input {name!r}; it needs the name of one.")
        if kind == "assign":
            self.assign(device, str(name), message.get("mapping"))
        elif kind == "assign by moving":
            self.assign_by_moving(device, str(name), on)
        elif kind == "calibrate":
            self.calibrate(device, on, bool(message.get("keep", True)))
        elif kind == "reset mapping":
            self.reset_mapping(device)
        elif kind == "device settings":
            self.set_settings(device, message.get("settings", {}))
        elif kind == "test force":
            self.test_force(device)
        else:
            raise HostError(f"A message about devices has the type {kind!r}, which is unknown.")

    def _device(self, device: str) -> Device:
        connected = self._reader.devices.get(device)
        if connected is None:
            raise HostError(f"The device '{device}' is not plugged in.")
        return connected
