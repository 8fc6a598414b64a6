"""The thread that reads devices, notices which are plugged in or out, and passes on their values."""

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from ali3.errors import UserError
from hosts.common.errors import HostError
from hosts.simulator.devices import sdl as sdl_library
from hosts.simulator.devices.defaults import default_mapping
from hosts.simulator.devices.device import Device
from hosts.simulator.devices.device_text import and_list, came
from hosts.simulator.devices.identity import Identities
from hosts.simulator.devices.joysticks import Joystick, Joysticks
from hosts.simulator.devices.mapping import DeviceMapping
from hosts.simulator.devices.mapping_files import MappingFiles
from hosts.simulator.devices.reading import Source
from hosts.simulator.devices.steering import ANGLE_MAX, Steering

PERIOD = 0.004
"""s between two readings."""
IDLE_PERIOD = 0.05
"""s between two looks for devices while there is none."""
REPEAT = 0.25
"""s after which values are sent again, for inputs that another source no longer drives."""
_START_TIME = 5.0
_END_TIME = 0.4
TORQUE = "steering_wheel_torque"


class ArbiterLike(Protocol):
    """The interface of `InputArbiter` for devices."""

    def want(self, source: str, values: Mapping[str, tuple[float, float]]) -> None: ...

    def gone(self, source: str) -> list[str]: ...


class Reader:
    """Reads devices while it runs.

    `inputs`: that devices can drive, in the words of mappings; `torque`: as of `Devices`. `lock`: held while `devices`
    or one of them is looked at or changed; `devices`: those that are plugged in, by `id`.
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
        self._end, self._ready = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None
        self._sdl: Any = None
        self._told_angle = False

    def start(self) -> None:
        """Begin; returns when the devices that are there are known. Without SDL one sentence says so."""
        try:
            self._sdl = sdl_library.load()
        except HostError as error:
            self.tell(str(error))
            return
        self._thread = threading.Thread(target=self._run, name="devices", daemon=True)
        self._thread.start()
        if not self._ready.wait(_START_TIME):
            self.tell(f"SDL has not found out within {_START_TIME:g} s which devices there are; it goes on looking.")

    def close(self) -> None:
        """Let motors go and end all threads."""
        self._end.set()
        if self._thread is not None:
            self._thread.join(2.0 * _END_TIME)

    def _run(self) -> None:
        """The thread: SDL wants all calls about joysticks from the thread that began."""
        try:
            sdl_library.start(self._sdl)
        except HostError as error:
            self.tell(str(error))
            self._ready.set()
            return
        joysticks = Joysticks(self._sdl)
        try:
            self._loop(joysticks)
        except Exception as error:  # the car goes on, and nothing that was held stays held
            why = str(error) if isinstance(error, UserError) else f"{type(error).__name__}: {error}."
            self.tell(f"Devices are no longer read; the keyboard drives. {why}")
            for device in self.devices.values():
                with suppress(Exception):  # perhaps it is the car that is gone
                    self._arbiter.gone(device.source)
        finally:
            with self.lock:
                gone, self.devices = [*self.devices.values()], {}
            for device in gone:
                if device.force is not None:
                    device.force.stop(0.0)  # all at once; waited for below
            closed = [device.close(_END_TIME) for device in gone]
            if all(closed):
                sdl_library.stop(self._sdl)
            self._ready.set()

    def _loop(self, joysticks: Joysticks) -> None:
        next_time = repeat = time.monotonic()
        while not self._end.is_set():
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
                    self._follow(device, now, now >= repeat)
            if now >= repeat:
                repeat = now + REPEAT
            if not self._ready.is_set():
                if not self.devices:
                    self.tell("No wheel, pedals or gamepad is plugged in; one that is plugged in later drives at once.")
                self._ready.set()
            next_time = max(now, next_time + (PERIOD if self.devices else IDLE_PERIOD))
            time.sleep(max(0.0, next_time - time.monotonic()))

    def _follow(self, device: Device, now: float, everything: bool) -> None:
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
        label = next(n for n in _labels(joystick.name) if n not in labels)
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
        self.tell(came(label, joystick.kind, mapping, from_file, self.inputs))
        missing = [m.source for m in mapping.inputs.values() if not Source.read(m.source).is_in(device.reading)]
        if missing:
            self.tell(f"{label} has no {and_list(missing)}, as its file says; it has {device.reading.counts()}.")
        if mapping.settings.rotation and self._steering.says_no_angle and not self._told_angle:
            self._told_angle = True
            self.tell(f"The car does not say {ANGLE_MAX}, so a wheel's whole turn is full steering.")
        self._begin_force(device)

    def _begin_force(self, device: Device) -> None:
        joystick = device.joystick
        if joystick.kind == "gamepad" or self._sdl.SDL_JoystickIsHaptic(joystick.handle) <= 0:
            return
        if self._torque is None:
            device.force_problem = f"the car has no {TORQUE}"
            self.tell(f"{device.label} has a motor, but the car has no {TORQUE}: it gives no force.")
            return

        def fail(why: str) -> None:
            device.force_problem = why
            self.tell(f"{device.label} goes on without force: {why}.")

        device.start_force(self._torque, fail)

    def _remove(self, joystick: Joystick) -> None:
        with self.lock:
            device = next((d for d in self.devices.values() if d.joystick is joystick), None)
            if device is None:
                return
            del self.devices[device.id]
        let_go = self._arbiter.gone(device.source)
        self._identities.leave(device.id)
        message = f"; {and_list(let_go)} let go" if let_go else ""
        self.tell(f"{device.label} was pulled out{message}. Plug it in again and it drives as before.")
        device.close(_END_TIME)

    def default(self, joystick: Joystick) -> DeviceMapping:
        return default_mapping(joystick.kind, joystick.read(), joystick.bindings, self.inputs)

    def let_go(self, device: Device) -> None:
        """Release the inputs that the device drives; what is moved again drives again."""
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
            self.tell(f"{error} What was set for {device.label} holds until it is pulled out.")


def _labels(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name} ({number})"
        number += 1
