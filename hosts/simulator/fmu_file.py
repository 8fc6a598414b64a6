"""Which FMU is driven: the given one, the one in ``dist``, or one that is built for this machine and kept."""

from __future__ import annotations

import hashlib
import os
import subprocess
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import ali3
from ali3.cache import cache_folder
from ali3.command import COMMANDS
from ali3.running import module_command
from hosts.errors import HostError

NAME = "PrototypeCar.fmu"
DIST = Path("dist", NAME)
_SUFFIXES = (".py", ".c", ".h", ".toml", ".csv", ".npz", ".json", ".road", ".xml", ".txt")
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
    kept = room / f"{_version()}" / NAME
    if kept.is_file():
        os.utime(kept.parent)
        return FoundFmu(kept)
    tell(f"There is no {DIST}; the prototype car is built for this machine, which takes half a minute ...")
    begin = time.monotonic()
    _build(kept.parent)
    built = time.monotonic() - begin
    tell(f"Built in {built:.1f} s; it is kept for the next time in {kept.parent}.")
    _forget(room)
    return FoundFmu(kept, built)


def _build(folder: Path) -> None:
    options = ("--kind", "native", "--platforms", "this", "--poses", "all", "--out", str(folder))
    done = subprocess.run(
        module_command("ali3", "build", *options), capture_output=True, text=True, encoding="utf-8", check=False
    )
    if done.returncode != 0 or not (folder / NAME).is_file():
        words = done.stderr.strip().splitlines()
        why = words[-1].removeprefix("error: ") if words else "the build said nothing."
        raise HostError(f"The FMU of the car cannot be built: {why}")


def _version() -> str:
    """A name that changes with the program that builds: with the packages of all commands but those of hosts."""
    packages = {command.module.partition(".")[0] for command in COMMANDS} - {"hosts"}
    root = Path(ali3.__file__).parents[1]
    digest = hashlib.sha256()
    for file in sorted(f for name in packages for f in _files(root / name)):
        state = file.stat()
        digest.update(f"{file.relative_to(root).as_posix()} {state.st_size} {state.st_mtime_ns}\n".encode())
    return digest.hexdigest()[:16]


def _files(folder: Path) -> Iterator[Path]:
    return (f for f in folder.rglob("*") if f.suffix in _SUFFIXES and f.is_file())


def _forget(room: Path) -> None:
    """Remove FMUs of older versions but the last few."""
    import shutil

    folders = sorted((f for f in room.iterdir() if f.is_dir()), key=lambda f: f.stat().st_mtime, reverse=True)
    for folder in folders[_KEPT:]:
        shutil.rmtree(folder, ignore_errors=True)
