"""Builds FMUs on demand, by ``ali3 build`` in a separate process, and caches them."""

import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import ali3
from ali3.cache import cache_folder
from ali3.commands import COMMANDS
from ali3.errors import FileError
from ali3.folders import atomic_folder, forget_oldest
from ali3.locks import locked
from ali3.reading import files_in, is_file, is_folder, read_bytes, read_toml
from hosts.common.commands import run_ali3
from hosts.common.errors import HostError
from hosts.fmu.car import CAR_FILE

_SUFFIXES = (".py", ".c", ".h", ".toml", ".csv", ".npz", ".json", ".road", ".xml", ".txt")
_MAX_FMUS = 10
_IN_USE = 86400.0  # s, in which a command may still open an FMU
_MAX_FOLDER_SIZE = 500_000_000  # bytes of a car's folder


def fmu_of_car(car: str, tell: Callable[[str], None], ports: str | None = None) -> Path:
    """The FMU of a car for this platform, built once for each content of its files and each version of the program.

    Parameters
    ----------
    car : str
        A car of the package by its name, a folder with a file ``car.toml``, or such a file.
    tell : callable
        Called with messages.
    ports : str, optional
        See ``ali3 build --ports``.

    Raises
    ------
    HostError
        It cannot be built; with the message of the build.
    """
    options = () if ports is None else ("--ports", ports)
    name = car_digest(car) if ports is None else f"{car_digest(car)}-{ports.replace(',', '_')}"
    return _cached_fmu(f"the car {car}", name, ("--car", car, *options), tell)


def fmu_of_scene(scene: str, tell: Callable[[str], None]) -> Path:
    """The FMU of a scene of the package; see `fmu_of_car`."""
    return _cached_fmu(f"the scene {scene}", f"{scene}-{program_version()}", ("--scene", scene), tell)


def _cached_fmu(subject: str, name: str, options: tuple[str, ...], tell: Callable[[str], None]) -> Path:
    cache = cache_folder("cars")
    folder = cache / name
    with locked(cache):
        files = sorted(folder.glob("*.fmu"))
        if files:
            os.utime(folder)
            return files[0]
    tell(f"{subject[0].upper()}{subject[1:]} is built for this machine, which takes half a minute ...")
    try:
        with atomic_folder(folder) as temporary:
            build_fmu(subject, options, temporary)
            if not list(temporary.glob("*.fmu")):
                raise HostError(f"The FMU of {subject} cannot be built: the build left no FMU.")
    except KeyboardInterrupt:
        tell(f"The build of {subject} was stopped and nothing was run; the same command begins again.")
        raise
    with locked(cache):
        forget_oldest(cache, _MAX_FMUS, _IN_USE)
    return sorted(folder.glob("*.fmu"))[0]


def build_fmu(subject: str, options: tuple[str, ...], folder: Path) -> None:
    """Build a native FMU, for this platform unless the options name others.

    `subject`: subject of messages; `options`: options of ``ali3 build``. Raises `HostError` with the message of the
    build.
    """
    try:
        run_ali3("build", "--kind", "native", "--platforms", "this", *options, "--out", str(folder))
    except HostError as error:
        raise HostError(f"The FMU of {subject} cannot be built: {error}") from None


def car_digest(car: str) -> str:
    """A digest of the files of a car and of the program that builds it.

    `car`: a folder with a file ``car.toml``, or such a file, of which all files of the folder and those it names
    elsewhere count; otherwise the name of a car of the package.
    """
    digest = hashlib.sha256(program_version().encode())
    path = Path(car)
    file = path / CAR_FILE if is_folder(path) else path
    if not is_file(file):
        digest.update(f"name {car}".encode())
        return digest.hexdigest()[:32]
    files = {f for f in file.parent.rglob("*") if is_file(f)}
    with suppress(FileError):  # the build reports the fault
        files |= {*files_in(read_toml(file), file.parent)}
    size = sum(f.stat().st_size for f in files)
    if size > _MAX_FOLDER_SIZE:
        raise HostError(
            f"The folder {file.parent} of the car has {1e-6 * size:.0f} MB of files; give the car a folder of its own."
        )
    digest.update(file.name.encode())
    for source in sorted(files):
        digest.update(os.path.relpath(source, file.parent).encode() + b"\n")
        digest.update(read_bytes(source, _MAX_FOLDER_SIZE, HostError))
    return digest.hexdigest()[:32]


def program_version() -> str:
    """A digest of the program that builds: of the packages of all commands except those of hosts."""
    packages = {command.module.partition(".")[0] for command in COMMANDS} - {"hosts"}
    root = Path(ali3.__file__).parents[1]
    digest = hashlib.sha256()
    for file in sorted(f for name in packages for f in _files(root / name)):
        state = file.stat()
        digest.update(f"{file.relative_to(root).as_posix()} {state.st_size} {state.st_mtime_ns}\n".encode())
    return digest.hexdigest()[:16]


def _files(folder: Path) -> Iterator[Path]:
    return (f for f in folder.rglob("*") if f.suffix in _SUFFIXES and is_file(f))
