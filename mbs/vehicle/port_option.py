"""Ports as a list of a command line."""

from typing import get_args

from mbs.vehicle.ports import PORTS, Ports


def chosen_ports(text: str) -> dict[str, str]:
    """The keys of `Ports` that a list such as ``torque,brakes=pressure`` asks for; of each the first kind by default.

    Raises `ValueError`: it is no such list; the message names the ports and their kinds.
    """
    known = {name: _kinds(name) for name in PORTS}
    chosen: dict[str, str] = {}
    for word in text.split(","):
        name, equals, kind = (part.strip() for part in word.partition("="))
        kind = kind if equals else next(iter(known.get(name, ("",))))
        if name not in known or kind not in known[name] or name in chosen:
            offered = ", ".join(f"{port} ({' or '.join(kinds)})" for port, kinds in known.items())
            twice = f", where {name} stands twice" if name in chosen else ""
            raise ValueError(
                f"The ports are '{text}'{twice}; they must be a list such as torque,brakes=pressure out of {offered}."
            )
        chosen[name] = kind
    return chosen


def _kinds(name: str) -> tuple[str, ...]:
    return get_args(get_args(Ports.model_fields[name].annotation)[0])
