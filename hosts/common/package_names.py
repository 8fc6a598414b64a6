"""Names of cars and worlds of the package, so that a misspelt one is reported before anything is built for it."""

from pathlib import Path

import ali3
from ali3.message_text import brief
from ali3.near_names import did_you_mean
from ali3.reading import is_file_or_folder
from hosts.common.errors import HostError

_MBS = Path(ali3.__file__).parents[1] / "mbs"


def check_car(car: Path) -> None:
    """Refuse a word that is neither a file here nor the name of a car; `HostError` with a near name, or all."""
    names = sorted(file.parent.name for file in (_MBS / "vehicle" / "cars").glob("*/car.toml"))
    if not is_file_or_folder(car) and str(car) not in names:
        _refuse("car", str(car), names)


def check_world(world: str) -> None:
    """Refuse a word that is neither a file here nor the name of a world or road; `HostError` as `check_car`."""
    roads = (_MBS / "roads" / "files").glob("*.road")
    names = sorted(file.stem for file in (*(_MBS / "worlds").glob("*.toml"), *roads))
    if not is_file_or_folder(world) and world.removesuffix(".road") not in names:
        _refuse("world", world, names)


def _refuse(kind: str, name: str, names: list[str]) -> None:
    near = did_you_mean(name, names, f"the {kind}s of the package are {', '.join(names)}", 1)
    raise HostError(f"There is no {kind} {brief(name)} and no such file{near}")
