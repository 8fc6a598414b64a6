"""Finds a car by its name or its file, compiles it in all fidelities and adds the data that its FMU stores."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import mbs
from ali3.archives import LARGEST_UNPACKED
from ali3.message_text import shortened
from ali3.reading import files_in, is_file, read_bytes
from fmu_src.build.scene_registry import SceneError
from fmu_src.geometry.system_with_poses import Maker, posed_systems
from mbs.vehicle import Car, Fidelity, car_names, load
from mbs.vehicle.ports import chosen_ports
from mbs.vehicle.summary import grip_row

FOLDER = "resources/car"
"""Where the car's file and its tables lie in an FMU."""
_FILE = "car.toml"


@dataclass(frozen=True)
class BuiltCar:
    """A car ready for an FMU."""

    name: str
    description: str
    systems: Mapping[int, mbs.System]
    """By fidelity, ascending."""
    files: Mapping[str, bytes]
    """The car's file and the tables that it names, as they lie in the FMU."""
    grip: Mapping[str, str]
    """As `grip_of` gives it."""


def build_car(
    car: str,
    poses: str | None = None,
    ports: str | None = None,
    fidelity: float | None = None,
    tell: Callable[[str], object] = str,
) -> BuiltCar:
    """Read a car and compile it.

    Parameters
    ----------
    car : str
        Name of a car of the package, a folder with a file car.toml, or such a file.
    poses : {"wheels", "all"} or None
        As `fmu_src.geometry.system_with_poses.posed_systems` takes it.
    ports : str, optional
        As `mbs.vehicle.ports.chosen_ports` takes them, in addition to those of the file; the name of what is
        built says then that it has ports.
    fidelity : float, optional
        Number of a member of `mbs.vehicle.Fidelity` that is alone in what is built, which its name says; by default
        all that an FMU offers.
    tell : callable
        As `fmu_src.geometry.system_with_poses.posed_systems` takes it.

    Raises
    ------
    ValueError
        The file does not describe a car that can be built; the message says why.
    """
    data, name = load(Path(car) if _is_path(car) else car), None
    if ports is not None:
        name = f"{data.name}_ports"
        port_kinds = chosen_ports(ports)
        data = data.changed({f"ports.{key}": kind for key, kind in port_kinds.items()})
    if fidelity is not None:
        single_fidelity = Fidelity.of(int(fidelity) if fidelity % 1.0 == 0.0 else fidelity)  # type: ignore[arg-type]
        name = f"{name or data.name}_{single_fidelity.name.lower()}"
    prefix = f"{data.folder / _FILE}: the car '{data.name}' cannot be built"
    try:
        makers: Mapping[Any, Maker] = data.fidelities()
        if fidelity is not None:
            makers = {0: partial(data.model, None, single_fidelity)}
        systems = posed_systems(makers, min(makers), poses, tell)
    except (ValueError, RuntimeError) as error:
        raise SceneError(f"{prefix}: {error}") from error
    except (ArithmeticError, LookupError) as error:
        raise SceneError(f"{prefix}: {type(error).__name__}: {error}.") from error
    files = car_files(data)
    if ports is not None and b"[ports]" not in files[f"{FOLDER}/{_FILE}"]:  # so that the FMU can be built again from it
        table = "\n".join(["\n[ports]", *(f'{key} = "{kind}"' for key, kind in port_kinds.items()), ""])
        files[f"{FOLDER}/{_FILE}"] += table.encode()
    return BuiltCar(name or data.name, data.description, systems, files, grip_of(data))


def grip_of(car: Car) -> dict[str, str]:
    """What the tyres of each axle reach, a sentence each; a user may expect the forces of the tyre's file."""
    return dict(grip_row(car, axle) for axle in ("front", "rear"))


def car_text(car: str) -> str:
    """Description of the car that will be built: one of the package and one of a folder may have the same name.

    `car`: as for `build_car`.
    """
    if _is_path(car) or car not in car_names():
        return shortened(car)
    note = f" (the folder {car} here would be ./{car})" if is_file(Path(car) / _FILE) else ""
    return f"{car} of the package{note}"


def car_files(car: Car) -> dict[str, bytes]:
    """The file of a car and the tables that it names, by their paths in an FMU.

    `car`: as `mbs.vehicle.load` gives it.
    """
    folder = car.folder.resolve()
    named_files = {file.resolve() for file in files_in(car.model_dump(), folder)}
    files = {folder / _FILE} | {file for file in named_files if folder in file.parents}
    files_by_path = {f"{FOLDER}/{file.relative_to(folder).as_posix()}": file for file in sorted(files)}
    return {path: read_bytes(file, LARGEST_UNPACKED) for path, file in files_by_path.items()}


def _is_path(car: str) -> bool:
    return car.endswith(".toml") or "/" in car or "\\" in car or car in (".", "..")
