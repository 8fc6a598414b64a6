"""A connected device, such as a steering wheel, and its requests for inputs of the car."""

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from hosts.simulator.devices.calibration import Assignment, Calibration
from hosts.simulator.devices.force_feedback import ForceFeedback
from hosts.simulator.devices.joysticks import Joystick
from hosts.simulator.devices.mapping import ANGLE, SELECTOR, DeviceMapping, InputMapping
from hosts.simulator.devices.reading import Reading, Source
from hosts.simulator.input_arbiter import LET_GO

TOUCHED = 0.02
"""Change of an input from its rest with which a device begins to request it."""
BUTTON_RATES = {"throttle": 2.5, "brake": 4.0, "hand_brake": 8.0}
"""Largest change per second of a pedal while its button is pressed, as with keys; `LET_GO` after its release."""
ANGLE_MAX = "vehicle.steering_wheel_angle_max"
_DEFAULT_ROTATION = 900.0
"""Rotation of a device from end to end, degrees, if neither it nor the largest angle of the car is known."""


@dataclass(frozen=True)
class Steering:
    """The steering of a car by a device: to an angle, or to a fraction of full steering."""

    angle_max: float | None
    """Steering wheel angle of the car at full steering, rad, if known."""
    by_angle: bool = False
    """Whether the car has the input `steering_wheel_angle_demand` and no `steering`."""

    @property
    def lacks_angle(self) -> bool:
        """Whether the ends of the device are full steering because the angle of the car is not known."""
        return self.angle_max is None and not self.by_angle

    def fraction(self, turn: float, rotation: float) -> float:
        """Steering from -1 to 1.

        `turn`: position of the device, from -1 to 1, positive to the left; `rotation`: rotation of the device from end
        to end, degrees; 0: its ends are full steering.
        """
        if not rotation or not self.angle_max:
            return turn
        return max(-1.0, min(1.0, turn * 0.5 * math.radians(rotation) / self.angle_max))

    def want(self, turn: float, rotation: float) -> tuple[str, float]:
        """Name and value of the input of the car; see `fraction`."""
        fraction = self.fraction(turn, rotation)
        if not self.by_angle:
            return "steering", fraction
        return ANGLE, fraction * (self.angle_max or 0.5 * math.radians(rotation or _DEFAULT_ROTATION))


class Device:
    """A connected device.

    `id`, `label`: its unique names for programs and for messages; `inputs`: inputs of the car, by their names in
    mappings.
    """

    def __init__(
        self,
        id: str,
        label: str,
        joystick: Joystick,
        mapping: DeviceMapping,
        inputs: Collection[str],
        steering: Steering,
    ) -> None:
        self.id, self.label, self.joystick = id, label, joystick
        self.source = f"device {label}"
        self.mapping = mapping
        self.reading = joystick.read()
        self.calibration: Calibration | None = None
        self.assignment: Assignment | None = None
        self.force: ForceFeedback | None = None
        self.force_problem = ""
        self._inputs, self._steering = inputs, steering
        self._rest_values: dict[str, float] = {}
        self._requesting: set[str] = set()
        self._pressed: set[str] = self.reading.pressed()
        self._sent: dict[str, tuple[float, float]] = {}
        self._store_rest(list(mapping.inputs))

    def remap(self, mapping: DeviceMapping) -> list[str]:
        """Replace the mapping. Inputs with a changed mapping are not requested until they are moved.

        Returns the inputs among them that the device requested before.
        """
        changed = {
            n for n in {*mapping.inputs, *self.mapping.inputs} if mapping.inputs.get(n) != self.mapping.inputs.get(n)
        }
        self.mapping = mapping
        return self.sleep(changed)

    def sleep(self, names: Collection[str]) -> list[str]:
        """Request these inputs only after they are moved again; returns those that the device requested before."""
        requested = [name for name in names if name in self._requesting]
        self._store_rest(names)
        return requested

    def _store_rest(self, names: Collection[str]) -> None:
        """Take the present values of these inputs as their rest."""
        for name in names:
            self._requesting.discard(name)
            self._rest_values.pop(name, None)
            self._sent.pop(name, None)
            mapping = self.mapping.inputs.get(name)
            value = None if mapping is None or name in SELECTOR else self.value(name, mapping)
            if value is not None:
                self._rest_values[name] = value

    def wants(self, everything: bool) -> dict[str, tuple[float, float]]:
        """Requests of the last reading: by input of the car, its value and largest change per second.

        `everything`: including requests that have not changed since the last call.
        """
        results: dict[str, tuple[float, float]] = {}
        for name, mapping in self.mapping.inputs.items():
            if name not in self._inputs or name in SELECTOR:
                continue
            value = self.value(name, mapping)
            if value is None:
                continue
            if name not in self._requesting:
                if abs(value - self._rest_values.setdefault(name, value)) <= TOUCHED:
                    continue
                self._requesting.add(name)
            request = value, self._rate(name, mapping, value)
            if everything or self._sent.get(name) != request:
                self._sent[name] = request
                results.update(self._car_request(name, mapping, request))
        results.update(self._selector())
        return results

    def value(self, name: str, mapping: InputMapping) -> float | None:
        """Value of an input of the car in the last reading; None if its source has no value."""
        value = mapping.value(name, self.reading)
        if value is None or name != "steering":
            return value
        return self._steering.fraction(value, self.mapping.settings.rotation)

    def _car_request(
        self, name: str, mapping: InputMapping, request: tuple[float, float]
    ) -> dict[str, tuple[float, float]]:
        """The request under the name of the input of the car, where the steering may be an angle."""
        turn = mapping.value(name, self.reading) if name == "steering" else None
        if turn is None:
            return {name: request}
        input_name, value = self._steering.want(turn, self.mapping.settings.rotation)
        return {input_name: (value, request[1])}

    def _rate(self, name: str, mapping: InputMapping, value: float) -> float:
        if Source.read(mapping.source).kind == "axis":
            return math.inf
        return BUTTON_RATES[name] if value else LET_GO[name]

    def _selector(self) -> Mapping[str, tuple[float, float]]:
        """The request for the selector of a button that has just been pressed."""
        pressed = self.reading.pressed()
        new, self._pressed = pressed - self._pressed, pressed
        for name, value in SELECTOR.items():
            mapping = self.mapping.inputs.get(name)
            if mapping is not None and name in self._inputs and mapping.source in new:
                return {"selector": (value, math.inf)}
        return {}

    def start_force(self, torque: Callable[[], float | None], fail: Callable[[str], None]) -> None:
        """Start force feedback. `torque`: steering-wheel torque, N m; `fail`: called with a message if it fails."""
        handle, sdl = self.joystick.handle, self.joystick.sdl
        self.force = ForceFeedback(sdl, handle, torque, lambda: self.mapping.settings, fail)

    def close(self, timeout: float) -> bool:
        """Stop force feedback and close the device; False: the motor still runs after `timeout` s."""
        if self.force is not None and not self.force.stop(timeout):
            return False
        self.joystick.close()
        return True

    def state(self) -> dict[str, Any]:
        """The device as JSON for pages."""
        reading: Reading = self.reading
        inputs = {}
        for name, m in self.mapping.inputs.items():
            value = None if name in SELECTOR else self.value(name, m)
            inputs[name] = asdict(m) | {"value": value if value is None else round(value, 4)}
        calibration = self.calibration
        return {
            "id": self.id,
            "name": self.label,
            "kind": self.joystick.kind,
            "usb": self.joystick.usb,
            "axes": [round(a, 4) for a in reading.axes],
            "buttons": [int(b) for b in reading.buttons],
            "hats": list(reading.hats),
            "force": self.force is not None and self.force.works,
            "force_problem": self.force_problem,
            "mapping": inputs,
            "inputs": list(self._inputs),
            "settings": asdict(self.mapping.settings),
            "assigning": self.assignment.name if self.assignment else None,
            "calibration": None
            if calibration is None
            else {"stage": calibration.stage, "text": calibration.words, "ends": calibration.ends()},
        }
