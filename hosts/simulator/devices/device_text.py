"""Sentences about devices."""

from collections.abc import Collection, Sequence

from hosts.simulator.devices.mapping import DeviceMapping


def and_list(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def number_text(names: Sequence[str]) -> str:
    """A sentence on the inputs that a device can drive."""
    return f"a device can drive {and_list(names)}" if names else "a device can drive none of its inputs"


def came(label: str, kind: str, mapping: DeviceMapping, kept: bool, inputs: Collection[str]) -> str:
    """The sentence for a device that was plugged in."""
    drives = [f"{name} by {m.source}" for name, m in mapping.inputs.items() if name in inputs]
    if not drives:
        return f"{label} is plugged in and drives nothing yet: assign its axes under Devices in the page."
    how = "as it was assigned" if kept else f"as a {kind} for now; calibrate it under Devices in the page"
    return f"{label} is plugged in and drives {and_list(drives)}, {how}."
