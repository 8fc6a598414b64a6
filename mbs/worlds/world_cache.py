"""Cache of the files of worlds, by the content of their descriptions and of the code that makes them."""

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
from mbs.roads.grid_files import MAX_BYTES
from mbs.roads.road_header import RoadFileError

ROOT = Path(__file__).parents[2]
CODE = (
    *("mbs/roads", "mbs/worlds", "mbs/kernel/header", "ali3/plausibility"),
    *("ali3/scene/road_types.py", "ali3/scene/base64_numbers.py", "ali3/iso_3888.py", "ali3/cones.py"),
)
"""Code that determines the files of worlds."""
MAX_ENTRIES = 12
COMPLETE_MARK = "made"


def cache_key(files: Iterable[Path], name: str = "") -> str:
    """Key of the world made from files; it changes with their content and with the code.

    `name`: name or path as the user gave it; the stored warnings contain it.
    """
    digest = hashlib.sha256(name.encode(errors="surrogateescape"))
    sources = [path for entry in CODE for path in _source_files(ROOT / entry)]
    for path in (*sources, *files):
        data = read_bytes(path, MAX_BYTES, RoadFileError)
        digest.update(f"{path.name} {len(data)} ".encode())
        digest.update(data)
    return digest.hexdigest()[:32]


def _source_files(entry: Path) -> list[Path]:
    """Files of an entry of `CODE`."""
    return sorted(p for p in entry.iterdir() if p.suffix in (".py", ".csv")) if entry.is_dir() else [entry]


def world_files(key: str, make: Callable[[Path], None], out: Path) -> tuple[list[Path], bool]:
    """Copy the files of a world into a folder, from the cache or newly made.

    `key`: result of `cache_key`; `make`: writes the files into an empty folder.

    Returns
    -------
    files : list of Path
        In `out`.
    cached : bool
        Whether they were in the cache.
    """
    make_folder(out)
    cache = cache_folder("worlds")
    entry = cache / key
    if cached := (entry / COMPLETE_MARK).is_file():
        try:
            os.utime(entry)  # time of last use
            return _copy(entry, out), cached
        except FileNotFoundError:  # removed by another process
            pass
    with temporary_folder(out) as folder:
        make(folder)
        _store(folder, cache, entry)
        return _copy(folder, out), False


def _copy(folder: Path, out: Path) -> list[Path]:
    """Copy road file and record; return the new paths."""
    names = sorted(path.name for path in folder.iterdir() if path.suffix in (".road", ".json"))
    for name in names:
        with atomic_file(out / name) as target:
            shutil.copyfile(folder / name, target)
    return [out / name for name in names]


def _store(folder: Path, cache: Path, entry: Path) -> None:
    """Copy the files of a world into the cache, completely or not at all."""
    try:
        with atomic_folder(entry) as target:
            for path in folder.iterdir():
                shutil.copyfile(path, target / path.name)
            (target / COMPLETE_MARK).touch()
        forget_oldest(cache, MAX_ENTRIES)
    except OSError as error:
        print(f"The world is not stored for the next time: {str(error).rstrip('.')}.", file=sys.stderr)


def add_file(key: str, name: str, make: Callable[[Path], None], out: Path) -> None:
    """Copy a further file of a cached world, such as its map, to `out`; `make` writes it if it is missing."""
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
