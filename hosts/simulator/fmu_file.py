"""Which FMU is driven: the given one, the one in ``dist``, or one that is built for this machine and kept."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ali3.cache import cache_folder
from hosts.common.errors import HostError
from hosts.fmu.built_fmu import build_fmu, forget_oldest, program_version

NAME = "PrototypeCar.fmu"
DIST = Path("dist", NAME)
_KEPT = 3


@dataclass(frozen=True)
class FoundFmu:
    """An FMU and where it comes from.

    Parameters
    ----------
    path : Path
    built : float
        Seconds that its build took; 0: it was there.
    """

    path: Path
    built: float = 0.0


def find_fmu(given: Path | None, tell: Callable[[str], None]) -> FoundFmu:
    """The FMU that is driven.

    Parameters
    ----------
    given : Path, optional
        Of the command line; else ``dist/PrototypeCar.fmu`` if it is there, else one in the cache of the user, which is
        built when it is not there or the program has changed.
    tell : callable
        Takes sentences.

    Raises
    ------
    HostError
        It cannot be built; with the words of the build.
    """
    if given is not None:
        return FoundFmu(given)
    if DIST.is_file():
        return FoundFmu(DIST)
    room = cache_folder("simulator")
    kept = room / program_version() / NAME
    if kept.is_file():
        os.utime(kept.parent)
        return FoundFmu(kept)
    tell(f"There is no {DIST}; the prototype car is built for this machine, which takes half a minute ...")
    begin = time.monotonic()
    _build(kept.parent)
    built = time.monotonic() - begin
    tell(f"Built in {built:.1f} s; it is kept for the next time in {kept.parent}.")
    forget_oldest(room, _KEPT)
    return FoundFmu(kept, built)


def _build(folder: Path) -> None:
    build_fmu("the car", ("--poses", "all"), folder)
    if not (folder / NAME).is_file():
        raise HostError(f"The FMU of the car cannot be built: the build left no {NAME}.")
