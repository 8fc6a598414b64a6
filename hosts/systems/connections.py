"""Connections between the parts of a system: which output drives which input."""

import re
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from ali3.message_text import brief
from ali3.near_names import did_you_mean
from ali3.units import known_unit
from hosts.common.arguments import mapping
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu


@dataclass(frozen=True)
class Wire:
    """One connection: the input takes the output."""

    source: str
    output: str
    """`source`, `output`: part and its variable."""
    target: str
    input: str
    """`target`, `input`: part and its variable."""


def fmus_of(parts: Mapping[str, Path], stack: ExitStack) -> dict[str, Fmu]:
    """The FMUs of a system by the names of its parts, which `stack` closes.

    Raises `HostError`: a part has a name that no file can have, or no FMU that can be opened.
    """
    for part, path in mapping(parts, "The parts of a system").items():
        if not re.fullmatch(r"[\w-]+", part):
            raise HostError(f"A part is named {brief(part)}; its name must be of letters, digits, '_' and '-'.")
        if not isinstance(path, (str, PathLike)):
            raise HostError(f"The part '{part}' is {brief(path)}; it must be the path of an FMU.")
    return {part: stack.enter_context(Fmu(Path(path))) for part, path in parts.items()}


def wires_of(connections: Mapping[str, str], parts: Mapping[str, Fmu]) -> tuple[Wire, ...]:
    """Connections of a system, checked against its parts.

    `connections`: outputs by the inputs that take them, each as ``part.variable``. Raises `HostError`: there is no such
    part or variable, or the units of both ends differ.
    """
    wires = []
    for end, start in mapping(connections, "The connections").items():
        target, name = _checked_end(end, parts, "input")
        source, output = _checked_end(start, parts, "output")
        units = [parts[p].variables[n].unit for p, n in ((source, output), (target, name))]
        output_unit, input_unit = (known_unit(unit) if unit else None for unit in units)
        if output_unit is not None and input_unit is not None and output_unit != input_unit:
            raise HostError(
                f"'{start}' is in {units[0]} and '{end}' in {units[1]}; a wire converts no units, so wire variables "
                "of one unit."
            )
        wires.append(Wire(source, output, target, name))
    return tuple(wires)


def starts_of(start: Mapping[str, Value], parts: Mapping[str, Fmu]) -> dict[str, dict[str, Value]]:
    """Start values by part and variable. `start`: parameters and inputs, as ``part.variable``.

    Raises `HostError`: there is no such part or variable, or a value is none of its variable.
    """
    results: dict[str, dict[str, Value]] = {part: {} for part in parts}
    for text, value in mapping(start, "The start values").items():
        part, name = part_and_name(text, parts)
        source = f"The part '{part}'"
        results[part][name] = parts[part].table.settable(name, source).check(value, source)
    return results


def part_and_name(text: str, parts: Mapping[str, Fmu]) -> tuple[str, str]:
    """Part and variable of ``part.variable``. Raises `HostError`: there is no such part."""
    part, dot, name = text.partition(".") if isinstance(text, str) else ("", "", "")
    if part not in parts:
        hint = f"the parts are {', '.join(parts)}"
        raise HostError(f"{brief(text)} names no part{did_you_mean(part, parts, hint)}")
    if not dot:
        raise HostError(f"'{text}' names a part and no variable; it must be PART.VARIABLE.")
    return part, name


def _checked_end(text: str, parts: Mapping[str, Fmu], causality: str) -> tuple[str, str]:
    part, name = part_and_name(text, parts)
    names: Sequence[str] = parts[part].names(causality)
    if name not in names:
        raise HostError(f"The part '{part}' has no {causality} '{name}'{did_you_mean(name, names)}")
    return part, name
