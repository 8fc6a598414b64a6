"""The thread that reads devices, detects their connection and removal, and passes on their values."""

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from ali3.errors import UserError
from ali3.message_text import word_list
from hosts.common.errors import HostError
from hosts.simulator.devices import sdl as sdl_library
from hosts.simulator.devices.defaults import default_mapping
from hosts.simulator.devices.device import ANGLE_MAX, Device, Steering
from hosts.simulator.devices.device_text import connection_text
from hosts.simulator.devices.joysticks import Joystick, Joysticks
from hosts.simulator.devices.mapping import DeviceMapping
from hosts.simulator.devices.mapping_files import MappingFiles
from hosts.simulator.devices.reading import Source

PERIOD = 0.004
"""Time between two readings, s."""
IDLE_PERIOD = 0.05
"""Time between two searches while there is no device, s."""
REPEAT = 0.25
"""Time after which values are sent again, s, for inputs that another source no longer drives."""
_START_TIME = 5.0
_END_TIME = 0.4
TORQUE = "steering_wheel_torque"
MAX_DEVICES_OF_MODEL = 8
"""Largest number of devices of one model."""


class ArbiterLike(Protocol):
    """The interface of `InputArbiter` for devices."""

    def want(self, source: str, values: Mapping[str, tuple[float, float]]) -> None: ...

    def gone(self, source: str) -> list[str]: ...


class Reader:
    """Reads devices in a thread.

    `inputs`: inputs that devices can drive, by their names in mappings; `torque`: see `Devices`. `devices`: the
    connected ones, by `id`; `lock`: lock to be held while they are read or changed.
    """

    def __init__(
        self,
        arbiter: ArbiterLike,
        inputs: list[str],
        steering: Steering,
        tell: Callable[[str], None],
        folder: Path,
        torque: Callable[[], float | None] | None,
    ) -> None:
        self.inputs, self.tell = inputs, tell
        self.lock = threading.RLock()
        self.devices: dict[str, Device] = {}
        self.files = MappingFiles(folder)
        self._arbiter, self._steering, self._torque = arbiter, steering, torque
        self._identities = Identities(self.files.serial)
        self._stop, self._ready = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None
        self._sdl: Any = None
        self._angle_reported = False

    def start(self) -> None:
        """Start the thread, and wait until the connected devices are known. A message reports a missing SDL."""
        try:
            self._sdl = sdl_library.load()
        except HostError as error:
            self.tell(str(error))
            return
        self._thread = threading.Thread(target=self._run, name="devices", daemon=True)
        self._thread.start()
        if not self._ready.wait(_START_TIME):
            self.tell(f"SDL has not found out within {_START_TIME:g} s which devices there are; it continues to look.")

    def close(self) -> None:
        """Stop all motors and threads."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(2.0 * _END_TIME)

    def _run(self) -> None:
        """Run in the thread, from which SDL requires all its joystick calls."""
        try:
            sdl_library.start(self._sdl)
        except HostError as error:
            self.tell(str(error))
            self._ready.set()
            return
        joysticks = Joysticks(self._sdl)
        try:
            self._loop(joysticks)
        except Exception as error:  # the car goes on, and all inputs are released
            reason = str(error) if isinstance(error, UserError) else f"{type(error).__name__}: {error}."
            self.tell(f"Devices are no longer read; the keyboard drives. {reason}")
            for device in self.devices.values():
                with suppress(Exception):  # the car may have ended
                    self._arbiter.gone(device.source)
        finally:
            with self.lock:
                removed, self.devices = [*self.devices.values()], {}
            for device in removed:
                if device.force is not None:
                    device.force.stop(0.0)  # all at the same time; `close` waits for each
            closed = [device.close(_END_TIME) for device in removed]
            if all(closed):
                sdl_library.stop(self._sdl)
            self._ready.set()

    def _loop(self, joysticks: Joysticks) -> None:
        next_time = repeat = time.monotonic()
        while not self._stop.is_set():
            added, removed, refused = joysticks.update()
            for joystick in removed:
                self._remove(joystick)
            for joystick in added:
                self._add(joystick)
            for name in refused:
                self.tell(f"{name} is plugged in and cannot be opened; perhaps another program has it.")
            now = time.monotonic()
            with self.lock:
                for device in self.devices.values():
                    self._read_device(device, now, now >= repeat)
            if now >= repeat:
                repeat = now + REPEAT
            if not self._ready.is_set():
                if not self.devices:
                    self.tell("No wheel, pedals or gamepad is plugged in; one that is plugged in later drives at once.")
                self._ready.set()
            next_time = max(now, next_time + (PERIOD if self.devices else IDLE_PERIOD))
            time.sleep(max(0.0, next_time - time.monotonic()))

    def _read_device(self, device: Device, now: float, everything: bool) -> None:
        """Read a device, advance its calibration or assignment, and request the inputs that it drives."""
        device.reading = device.joystick.read()
        if device.calibration is not None:
            device.calibration.feed(now, device.reading)
            return
        assignment = device.assignment
        if assignment is not None:
            result = assignment.feed(device.reading)
            if result is not None:
                device.assignment = None
                self.remap(device, device.mapping.with_input(assignment.name, result))
                self.tell(f"{device.label}: {result.source} drives {assignment.name} now.")
            elif now > assignment.until:
                device.assignment = None
                self.tell(f"{device.label}: nothing was moved far enough for {assignment.name}; it is as before.")
        wants = device.wants(everything)
        if wants:
            self._arbiter.want(device.source, wants)

    def _add(self, joystick: Joystick) -> None:
        id = self._identities.take(joystick.guid, joystick.serial, joystick.path)
        labels = {device.label for device in self.devices.values()}
        label = next(n for n in _unique_labels(joystick.name) if n not in labels)
        try:
            mapping, from_file = self.files.read(id), True
        except HostError as error:
            self.tell(f"{error} {label} is driven as a device of its kind.")
            mapping = None
        if mapping is None:
            mapping, from_file = self.default(joystick), False
        device = Device(id, label, joystick, mapping, self.inputs, self._steering)
        with self.lock:
            self.devices[id] = device
        self.tell(connection_text(label, joystick.kind, mapping, from_file, self.inputs))
        missing = [m.source for m in mapping.inputs.values() if not Source.read(m.source).is_in(device.reading)]
        if missing:
            self.tell(f"{label} has no {word_list(missing)}, as its file says; it has {device.reading.counts()}.")
        if mapping.settings.rotation and self._steering.lacks_angle and not self._angle_reported:
            self._angle_reported = True
            self.tell(f"The car does not say {ANGLE_MAX}, so a wheel's whole turn is full steering.")
        self._start_force(device)

    def _start_force(self, device: Device) -> None:
        joystick = device.joystick
        if joystick.kind == "gamepad" or self._sdl.SDL_JoystickIsHaptic(joystick.handle) <= 0:
            return
        if self._torque is None:
            device.force_problem = f"the car has no {TORQUE}"
            self.tell(f"{device.label} has a motor, but the car has no {TORQUE}: it gives no force.")
            return

        def fail(reason: str) -> None:
            device.force_problem = reason
            self.tell(f"{device.label} continues without force: {reason}.")

        device.start_force(self._torque, fail)

    def _remove(self, joystick: Joystick) -> None:
        with self.lock:
            device = next((d for d in self.devices.values() if d.joystick is joystick), None)
            if device is None:
                return
            del self.devices[device.id]
        let_go = self._arbiter.gone(device.source)
        self._identities.leave(device.id)
        message = f"; {word_list(let_go)} let go" if let_go else ""
        self.tell(f"{device.label} was pulled out{message}. Plug it in again and it drives as before.")
        device.close(_END_TIME)

    def default(self, joystick: Joystick) -> DeviceMapping:
        return default_mapping(joystick.kind, joystick.read(), joystick.bindings, self.inputs)

    def let_go(self, device: Device) -> None:
        """Release the inputs that the device drives until they are moved again."""
        device.sleep(list(device.mapping.inputs))
        self._arbiter.gone(device.source)

    def remap(self, device: Device, mapping: DeviceMapping, save: bool = True) -> None:
        if device.remap(mapping):
            self._arbiter.gone(device.source)
        device.calibration = None
        if not save:
            return
        try:
            self.files.write(device.id, mapping, device.joystick.name, device.joystick.serial)
        except UserError as error:
            self.tell(f"{error} What was set for {device.label} holds until it is unplugged.")


def _unique_labels(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name} ({number})"
        number += 1


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
