"""FMUs that are built when they are needed and kept: by the command of the builder, in a process of its own."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import ali3
from ali3.cache import cache_folder
from ali3.commands import COMMANDS
from ali3.files import reason
from ali3.running import module_command
from hosts.common.errors import HostError

_SUFFIXES = (".py", ".c", ".h", ".toml", ".csv", ".npz", ".json", ".road", ".xml", ".txt")
_KEPT = 10
_CAR_FILE = "car.toml"
_LARGEST = 500_000_000  # bytes of a car's folder


def fmu_of_car(car: str, tell: Callable[[str], None]) -> Path:
    """The FMU of a car for this machine; built once for each content of its files and each version of the program.

    Parameters
    ----------
    car : str
        A car of the package by its name, a folder with a file ``car.toml``, or such a file.
    tell : callable
        Takes sentences.

    Raises
    ------
    HostError
        It cannot be built; with the words of the build.
    """
    room = cache_folder("cars")
    place = room / car_digest(car)
    found = sorted(place.glob("*.fmu"))
    if found:
        os.utime(place)
        return found[0]
    tell(f"The car {car} is built for this machine, which takes half a minute ...")
    with tempfile.TemporaryDirectory(prefix=".building-", dir=room) as folder:
        made = Path(folder, "car")
        build_fmu(f"the car {car}", ("--car", car), made)
        if not list(made.glob("*.fmu")):
            raise HostError(f"The FMU of the car {car} cannot be built: the build left no FMU.")
        try:
            made.rename(place)
        except OSError:  # another program has built it meanwhile
            if not list(place.glob("*.fmu")):
                raise
    forget_oldest(room, _KEPT)
    return sorted(place.glob("*.fmu"))[0]


def build_fmu(what: str, options: tuple[str, ...], folder: Path) -> None:
    """Build a native FMU for this machine.

    Parameters
    ----------
    what : str
        For messages.
    options : tuple of str
        Of the command, that say what is built.
    folder : Path

    Raises
    ------
    HostError
        With the words of the build.
    """
    always = ("--kind", "native", "--platforms", "this", "--out", str(folder))
    done = subprocess.run(
        module_command("ali3", "build", *options, *always),
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    if done.returncode != 0:
        words = done.stderr.strip().splitlines()
        why = words[-1].removeprefix("error: ") if words else "the build said nothing."
        raise HostError(f"The FMU of {what} cannot be built: {why}")


def car_digest(car: str) -> str:
    """A name that changes with the files of a car and with the program that builds it.

    Parameters
    ----------
    car : str
        A folder with a file ``car.toml``, or such a file: all files of its folder count, and those it names elsewhere.
        Else a name, which the program knows.
    """
    digest = hashlib.sha256(program_version().encode())
    path = Path(car)
    file = path / _CAR_FILE if path.is_dir() else path
    if not file.is_file():
        digest.update(f"name {car}".encode())
        return digest.hexdigest()[:32]
    files = {f for f in file.parent.rglob("*") if f.is_file()} | set(_named_files(file))
    size = sum(f.stat().st_size for f in files)
    if size > _LARGEST:
        raise HostError(
            f"The folder {file.parent} of the car has {1e-6 * size:.0f} MB of files; give the car a folder of its own."
        )
    digest.update(file.name.encode())
    for found in sorted(files):
        try:
            digest.update(os.path.relpath(found, file.parent).encode() + b"\n" + found.read_bytes())
        except OSError as error:
            raise HostError(f"{found} cannot be read: {reason(error)}.") from None
    return digest.hexdigest()[:32]


def _named_files(file: Path) -> Iterator[Path]:
    """Files whose names stand in a car file."""
    try:
        content = tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError):
        return  # the build says what is wrong
    for text in _texts(content):
        try:
            named = file.parent / text
            if named.is_file():
                yield named
        except (OSError, ValueError):
            continue


def _texts(content: Any) -> Iterator[str]:
    if isinstance(content, str):
        yield content
    elif isinstance(content, dict):
        for value in content.values():
            yield from _texts(value)
    elif isinstance(content, list):
        for value in content:
            yield from _texts(value)


def program_version() -> str:
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


def forget_oldest(room: Path, kept: int) -> None:
    """Remove folders of older versions but the last few.

    Parameters
    ----------
    room : Path
    kept : int
    """
    folders = (f for f in room.iterdir() if f.is_dir() and not f.name.startswith("."))
    for folder in sorted(folders, key=lambda f: f.stat().st_mtime, reverse=True)[kept:]:
        shutil.rmtree(folder, ignore_errors=True)
