"""Messages about devices."""

from collections.abc import Collection, Sequence

from ali3.message_text import word_list
from hosts.simulator.devices.mapping import DeviceMapping


def drivable_text(names: Sequence[str]) -> str:
    """The part of a message on the inputs that a device can drive."""
    return f"a device can drive {word_list(names)}" if names else "a device can drive none of its inputs"


def connection_text(label: str, kind: str, mapping: DeviceMapping, from_file: bool, inputs: Collection[str]) -> str:
    """The message for a device that was connected. `from_file`: whether its mapping is stored."""
    drives = [f"{name} by {m.source}" for name, m in mapping.inputs.items() if name in inputs]
    if not drives:
        return f"{label} is plugged in and drives nothing yet: assign its axes under Devices in the page."
    origin = "as it was assigned" if from_file else f"as a {kind} for now; calibrate it under Devices in the page"
    return f"{label} is plugged in and drives {word_list(drives)}, {origin}."
