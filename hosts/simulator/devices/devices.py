"""Steering wheels, pedals and gamepads, for the host of the car."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from hosts.common.errors import HostError
from hosts.simulator.devices.calibration import Assignment, Calibration
from hosts.simulator.devices.device import Device
from hosts.simulator.devices.device_text import and_list, number_text
from hosts.simulator.devices.mapping import DeviceMapping, drivable, read_input, read_settings
from hosts.simulator.devices.reader import ArbiterLike, Reader
from hosts.simulator.devices.reading import Source
from hosts.simulator.devices.steering import ANGLE_MAX, Steering

ASSIGN_TIME = 15.0
"""s for which an input waits to be assigned by moving something."""


class Devices:
    """Wheels, pedals and gamepads that drive the car; a context manager.

    Without SDL and without a device one sentence says so, and everything else works.

    Parameters
    ----------
    arbiter : InputArbiter
        Takes what devices want, as source ``device NAME``.
    constants : mapping of str to float
        Of the car; `vehicle.steering_wheel_angle_max` is used.
    tell : callable
        Takes sentences for people, from any thread.
    torque : callable or None
        Torque of the driver's hands on the car's steering wheel, N m, positive to the left; None while the car does not
        run. Called from a thread of each motor. Instead of a callable None: the car does not have it.
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
        """Let motors go and end all threads."""
        self._reader.close()

    def state(self) -> list[dict[str, Any]]:
        """The devices that are plugged in, for the page."""
        with self._reader.lock:
            return [device.state() for device in self._reader.devices.values()]

    def assign(self, device: str, name: str, mapping: Mapping[str, Any] | None) -> None:
        """Another mapping of an input; it is kept in the device's file.

        `device`: its `id`; `mapping`: fields of `InputMapping`; None: the device does not drive this input. Raises
        `HostError`: the device is not there, or the mapping is wrong; nothing changes.
        """
        with self._reader.lock:
            result = self._device(device)
            assigned = None if mapping is None else read_input(name, mapping)
            if name not in self._inputs:
                raise HostError(f"The car has no input for '{name}'; {number_text(self._inputs)}.")
            if assigned is not None and not Source.read(assigned.source).is_in(result.reading):
                raise HostError(f"{result.label} has no {assigned.source}; it has {result.reading.counts()}.")
            self._reader.remap(result, result.mapping.with_input(name, assigned))

    def assign_by_moving(self, device: str, name: str, on: bool = True) -> None:
        """The next axis or button that is moved on this device drives this input; see `assign`."""
        with self._reader.lock:
            result = self._device(device)
            if name not in self._inputs:
                raise HostError(f"The car has no input for '{name}'; {number_text(self._inputs)}.")
            result.assignment = Assignment(name, result.reading, time.monotonic() + ASSIGN_TIME) if on else None

    def calibrate(self, device: str, on: bool, keep: bool = True) -> None:
        """Begin a calibration, or end it.

        `device`: its `id`; `on`: true: begin; the device drives nothing until the end; `keep`: at the end, whether what
        was found counts. Raises `HostError`: the device is not there.
        """
        with self._reader.lock:
            result = self._device(device)
            if on:
                self._reader.let_go(result)
                result.calibration = Calibration(result.mapping)
                return
            calibration, result.calibration = result.calibration, None
            if calibration is None or not keep:
                return
            mapping, new, still = calibration.result()
            self._reader.remap(result, mapping)
            if new:
                self._reader.tell(f"{result.label}: the ends of {and_list(new)} are found.")
            if still:
                self._reader.tell(f"{result.label}: {and_list(still)} was not moved far enough and is as before.")

    def reset_mapping(self, device: str) -> None:
        """The mapping that a device of this kind begins with; its file is removed."""
        with self._reader.lock:
            result = self._device(device)
            self._reader.files.remove(device)
            self._reader.remap(result, self._reader.default(result.joystick), save=False)

    def set_settings(self, device: str, settings: Mapping[str, Any]) -> None:
        """Other `DeviceSettings`; those not named stay. Kept in the device's file; see `assign` for errors."""
        with self._reader.lock:
            result = self._device(device)
            device_settings = read_settings(settings, result.mapping.settings)
            self._reader.remap(result, DeviceMapping(result.mapping.inputs, device_settings))

    def test_force(self, device: str) -> None:
        """A short push to the left. Raises `HostError`: the device is not there or has no motor that works."""
        with self._reader.lock:
            result = self._device(device)
            if result.force is None or not result.force.works:
                raise HostError(f"{result.label} has no force: {result.force_problem or 'it has no motor'}.")
            result.force.pulse()

    def message(self, message: Mapping[str, Any]) -> None:
        """Do what a message of the page asks for.

        `message`: `type` is ``assign``, ``assign by moving``, ``calibrate``, ``reset mapping``, ``device settings`` or
        ``test force``; `device` an `id`; see the method of that name for the others. Raises `HostError`: it cannot be
        done; nothing changes.
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
        result = self._reader.devices.get(device)
        if result is None:
            raise HostError(f"The device '{device}' is not plugged in.")
        return result
