"""Worlds that were made before are kept: the same description and files give the same world."""

import hashlib
import os
import shutil
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ali3.cache import cache_folder
from ali3.files import atomic_file, make_folder
from ali3.folders import atomic_folder, forget_oldest
from ali3.reading import read_bytes
from ali3.temporary_folder import temporary_folder
from mbs.roads.grid_files import MOST_BYTES
from mbs.roads.road_header import RoadFileError

ROOT = Path(__file__).parents[2]
CODE = (
    *("mbs/roads", "mbs/worlds", "mbs/kernel/header", "ali3/plausibility"),
    *("ali3/scene/road_types.py", "ali3/scene/base64_numbers.py", "ali3/iso_3888.py", "ali3/cones.py"),
)
"""What worlds are made by."""
MOST_KEPT = 12
MADE = "made"


def key_of(files: Iterable[Path]) -> str:
    """Name of the world made from files, different for another content or another version of the code."""
    digest = hashlib.sha256()
    sources = [path for entry in CODE for path in _sources(ROOT / entry)]
    for path in (*sources, *files):
        data = read_bytes(path, MOST_BYTES, RoadFileError)
        digest.update(f"{path.name} {len(data)} ".encode())
        digest.update(data)
    return digest.hexdigest()[:32]


def _sources(entry: Path) -> list[Path]:
    return sorted(p for p in entry.iterdir() if p.suffix in (".py", ".csv")) if entry.is_dir() else [entry]


def world_files(key: str, make: Callable[[Path], None], out: Path) -> tuple[list[Path], bool]:
    """The files of a world in a folder, from the cache or newly made.

    `key`: from `key_of`; `make`: writes the files into an empty folder.

    Returns
    -------
    files : list of Path
        In `out`.
    cached : bool
        Whether they had been made before.
    """
    make_folder(out)
    cache = cache_folder("worlds")
    entry = cache / key
    if cached := (entry / MADE).is_file():
        try:
            os.utime(entry)  # used now
            return _copied(entry, out), cached
        except FileNotFoundError:  # removed by another run just now
            pass
    with temporary_folder(out) as folder:
        make(folder)
        _keep(folder, cache, entry)
        return _copied(folder, out), False


def _copied(folder: Path, out: Path) -> list[Path]:
    names = sorted(path.name for path in folder.iterdir() if path.suffix in (".road", ".json"))
    for name in names:
        with atomic_file(out / name) as target:
            shutil.copyfile(folder / name, target)
    return [out / name for name in names]


def _keep(folder: Path, home: Path, entry: Path) -> None:
    """Copy the files of a world into the cache, all or none; otherwise they are made again next time."""
    try:
        with atomic_folder(entry) as target:
            for path in folder.iterdir():
                shutil.copyfile(path, target / path.name)
            (target / MADE).touch()
        forget_oldest(home, MOST_KEPT)
    except OSError as error:
        print(f"The world is not kept for the next time: {str(error).rstrip('.')}.", file=sys.stderr)


def add_file(key: str, name: str, make: Callable[[Path], None], out: Path) -> None:
    """Add a file to a cached world, such as its map; `make` writes it if it is missing."""
    entry = cache_folder("worlds") / key
    stored: Any = entry / name
    with atomic_file(out) as target:
        if stored.is_file():
            shutil.copyfile(stored, target)
        else:
            make(target)
            if entry.is_dir():
                with atomic_file(stored) as copy:
                    shutil.copyfile(target, copy)
