"""Builds FMUs when they are needed, by ``ali3 build`` in a process of its own, and caches them."""

import hashlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import ali3
from ali3.cache import cache_folder
from ali3.commands import COMMANDS
from ali3.errors import FileError, reason
from ali3.folders import atomic_folder, forget_oldest
from ali3.locks import locked
from ali3.reading import is_file, is_folder, read_bytes, read_toml
from hosts.common.commands import run_ali3
from hosts.common.errors import HostError
from hosts.fmu.car import CAR_FILE

_SUFFIXES = (".py", ".c", ".h", ".toml", ".csv", ".npz", ".json", ".road", ".xml", ".txt")
_KEPT = 10
_IN_USE = 86400.0  # s since an FMU was asked for, in which a command may still open it
_LARGEST = 500_000_000  # bytes of a car's folder


def fmu_of_car(car: str, tell: Callable[[str], None], ports: str | None = None) -> Path:
    """The FMU of a car for this machine; built once for each content of its files and each version of the program.

    Parameters
    ----------
    car : str
        A car of the package by its name, a folder with a file ``car.toml``, or such a file.
    tell : callable
        Takes sentences.
    ports : str, optional
        As ``ali3 build --ports`` takes them.

    Raises
    ------
    HostError
        It cannot be built; with the words of the build.
    """
    options = () if ports is None else ("--ports", ports)
    name = car_digest(car) if ports is None else f"{car_digest(car)}-{ports.replace(',', '_')}"
    return _kept_fmu(f"the car {car}", name, ("--car", car, *options), tell)


def fmu_of_scene(scene: str, tell: Callable[[str], None]) -> Path:
    """The FMU of a scene of the package, as `fmu_of_car` gives that of a car."""
    return _kept_fmu(f"the scene {scene}", f"{scene}-{program_version()}", ("--scene", scene), tell)


def _kept_fmu(what: str, name: str, options: tuple[str, ...], tell: Callable[[str], None]) -> Path:
    room = cache_folder("cars")
    folder = room / name
    with locked(room):
        result = sorted(folder.glob("*.fmu"))
        if result:
            os.utime(folder)
            return result[0]
    tell(f"{what[0].upper()}{what[1:]} is built for this machine, which takes half a minute ...")
    try:
        with atomic_folder(folder) as temporary:
            build_fmu(what, options, temporary)
            if not list(temporary.glob("*.fmu")):
                raise HostError(f"The FMU of {what} cannot be built: the build left no FMU.")
    except KeyboardInterrupt:
        tell(f"The build of {what} was stopped and nothing was run; the same command begins again.")
        raise
    with locked(room):
        forget_oldest(room, _KEPT, _IN_USE)
    return sorted(folder.glob("*.fmu"))[0]


def build_fmu(what: str, options: tuple[str, ...], folder: Path) -> None:
    """Build a native FMU, for this machine unless the options name other platforms.

    `options`: of the command, that say what is built. Raises `HostError` with the words of the build.
    """
    try:
        run_ali3("build", "--kind", "native", "--platforms", "this", *options, "--out", str(folder))
    except HostError as error:
        raise HostError(f"The FMU of {what} cannot be built: {error}") from None


def car_digest(car: str) -> str:
    """A name that changes with the files of a car and with the program that builds it.

    `car`: a folder with a file ``car.toml``, or such a file: all files of its folder count, and those it names
    elsewhere. Else a name, which the program knows.
    """
    digest = hashlib.sha256(program_version().encode())
    path = Path(car)
    file = path / CAR_FILE if is_folder(path) else path
    if not is_file(file):
        digest.update(f"name {car}".encode())
        return digest.hexdigest()[:32]
    files = {f for f in file.parent.rglob("*") if is_file(f)} | set(_named_files(file))
    size = sum(f.stat().st_size for f in files)
    if size > _LARGEST:
        raise HostError(
            f"The folder {file.parent} of the car has {1e-6 * size:.0f} MB of files; give the car a folder of its own."
        )
    digest.update(file.name.encode())
    for source in sorted(files):
        try:
            digest.update(
                os.path.relpath(source, file.parent).encode() + b"\n" + read_bytes(source, _LARGEST, HostError)
            )
        except OSError as error:
            raise HostError(f"{source} cannot be read: {reason(error)}.") from None
    return digest.hexdigest()[:32]


def _named_files(file: Path) -> Iterator[Path]:
    """Files whose names stand in a car file."""
    try:
        content = read_toml(file)
    except FileError:
        return  # the build says what is wrong
    for text in _texts(content):
        try:
            path = file.parent / text
            if is_file(path):
                yield path
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
    return (f for f in folder.rglob("*") if f.suffix in _SUFFIXES and is_file(f))
