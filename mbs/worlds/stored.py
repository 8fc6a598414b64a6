"""Worlds that were made before are kept: the same description and files give the same world."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ali3.cache import cache_folder
from ali3.files import make_folder, whole_file

ROOT = Path(__file__).parents[2]
CODE = ("mbs/roads", "mbs/worlds", "mbs/kernel/header.py", "viewer/road_types.py", "viewer/base64_numbers.py")
"""What worlds are made by."""
MOST_KEPT = 12
MADE = "made"


def key_of(files: Iterable[Path]) -> str:
    """A name for what is made of files: another content or another version of the code, another name."""
    digest = hashlib.sha256()
    sources = [path for entry in CODE for path in _sources(ROOT / entry)]
    for path in (*sources, *files):
        data = path.read_bytes()
        digest.update(f"{path.name} {len(data)} ".encode())
        digest.update(data)
    return digest.hexdigest()[:32]


def _sources(place: Path) -> list[Path]:
    return sorted(place.glob("*.py")) if place.is_dir() else [place]


def world_files(key: str, make: Callable[[Path], None], out: Path) -> tuple[list[Path], bool]:
    """The files of a world in a folder, from those that are kept, or made.

    Parameters
    ----------
    key : str
        From `key_of`.
    make : callable
        Writes the files into an empty folder.
    out : Path
        Where they are wanted.

    Returns
    -------
    files : list of Path
        In `out`.
    kept : bool
        Whether they had been made before.
    """
    make_folder(out)
    home = cache_folder("worlds")
    entry = home / key
    if kept := (entry / MADE).is_file():
        try:
            os.utime(entry)  # used now
            return _copied(entry, out), kept
        except FileNotFoundError:  # removed by another run just now
            pass
    with tempfile.TemporaryDirectory(prefix=".world-", dir=out) as folder:
        made = Path(folder)
        make(made)
        _keep(made, home, entry)
        return _copied(made, out), False


def _copied(folder: Path, out: Path) -> list[Path]:
    names = sorted(path.name for path in folder.iterdir() if path.suffix in (".road", ".json"))
    for name in names:
        with whole_file(out / name) as target:
            shutil.copyfile(folder / name, target)
    return [out / name for name in names]


def _keep(made: Path, home: Path, entry: Path) -> None:
    """Copy what was made into the cache, whole or not at all; without one it is made again next time."""
    try:
        place = Path(tempfile.mkdtemp(prefix=".making-", dir=home))
        try:
            for path in made.iterdir():
                shutil.copyfile(path, place / path.name)
            (place / MADE).touch()
            place.rename(entry)
        finally:
            shutil.rmtree(place, ignore_errors=True)
        _prune(home)
    except OSError as error:
        if not entry.is_dir():  # else another run made the same
            words = error.strerror or str(error)
            print(f"The world is not kept for the next time: {home} cannot be written to ({words}).", file=sys.stderr)


def add_file(key: str, file: Path, make: Callable[[Path], None], out: Path) -> Path:
    """One more file of a world that is kept, such as its map; `make` writes it where there is none."""
    entry = cache_folder("worlds") / key
    stored: Any = entry / file.name
    with whole_file(out / file.name) as target:
        if stored.is_file():
            shutil.copyfile(stored, target)
        else:
            make(target)
            if entry.is_dir():
                with whole_file(stored) as copy:
                    shutil.copyfile(target, copy)
    return out / file.name


def _prune(home: Path) -> None:
    """Remove the worlds that were not used for the longest time."""
    entries = sorted(home.iterdir(), key=lambda entry: entry.stat().st_mtime, reverse=True)
    for entry in entries[MOST_KEPT:]:
        shutil.rmtree(entry, ignore_errors=True)
