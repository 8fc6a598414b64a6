"""Ports of a car from an option of the command line."""

from typing import get_args

from mbs.vehicle.ports import PORTS, Ports


def chosen_ports(text: str) -> dict[str, str]:
    """Parse a list of ports such as ``torque,brakes=pressure``; return kinds by port, by default the first kind.

    Raises `ValueError` if the text is not such a list; the message names the ports and their kinds.
    """
    kinds_of = {name: _kinds(name) for name in PORTS}
    chosen: dict[str, str] = {}
    for item in text.split(","):
        name, equals, kind = (part.strip() for part in item.partition("="))
        kind = kind if equals else next(iter(kinds_of.get(name, ("",))))
        if name not in kinds_of or kind not in kinds_of[name] or name in chosen:
            offered = ", ".join(f"{port} ({' or '.join(kinds)})" for port, kinds in kinds_of.items())
            twice = f", where {name} stands twice" if name in chosen else ""
            raise ValueError(
                f"The ports are '{text}'{twice}; they must be a list such as torque,brakes=pressure out of {offered}."
            )
        chosen[name] = kind
    return chosen


def _kinds(name: str) -> tuple[str, ...]:
    """Kinds of a port, from the type of its field."""
    return get_args(get_args(Ports.model_fields[name].annotation)[0])
