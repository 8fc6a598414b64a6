"""Checks of the arguments of `build_fmu`, made before any file is written; each error is one sentence."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mbs
from fmu_src.native.platforms import PLATFORMS
from mbs import ArgumentTypeError
from mbs.common.checks import instance_of, shown

Systems = mbs.System | Sequence[mbs.System] | Mapping[int, mbs.System]


def systems_by_number(system: Systems) -> dict[int, mbs.System]:
    """The Systems of an FMU by fidelity, ascending from 0.

    `system`: the numbers may be members of an enumeration, which they stay. Raises `mbs.ArgumentTypeError`: something
    is not a System. Raises `ValueError`: there is none, or the numbers are not 0, 1, 2 and on.
    """
    systems: Any = system
    if isinstance(systems, (list, tuple)):
        systems = dict(enumerate(systems))
    elif not isinstance(systems, Mapping):
        systems = {0: systems}
    for item in systems.values():
        instance_of(mbs.System, item, "the system of an FMU", "a System, which compile(model) makes")
    numbers = list(systems)
    if not numbers:
        raise ValueError("An FMU needs a System; none was given.")
    if any(isinstance(k, bool) or not isinstance(k, int) for k in numbers) or sorted(numbers) != list(
        range(len(systems))
    ):
        raise ValueError(f"The Systems of an FMU are numbered {shown(numbers)}; the numbers must be 0, 1, 2 and on.")
    return {k: systems[k] for k in sorted(numbers)}


def known_platforms(platforms: Sequence[str] | None, able: Sequence[str], kind: str) -> tuple[str, ...]:
    """The platforms that were asked for, by default the usual ones that the kind of FMU can have."""
    if platforms is None:
        return tuple(name for name in able if name in PLATFORMS)
    if isinstance(platforms, str) or not isinstance(platforms, Iterable):
        raise ArgumentTypeError(f"The platforms of an FMU must be a list of names, not {shown(platforms)}.")
    requested = tuple(platforms)
    unknown = sorted(str(name) for name in requested if name not in able)
    if not requested:
        raise ValueError(f"An FMU needs a platform; a {kind} FMU runs on {', '.join(able)}.")
    if unknown:
        raise ValueError(f"Platform '{', '.join(unknown)}' is not known; a {kind} FMU runs on {', '.join(able)}.")
    return requested
