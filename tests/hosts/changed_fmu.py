"""Copies of FMUs with other files in them."""

import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeAlias

Change: TypeAlias = bytes | Callable[[bytes], bytes] | None
DESCRIPTION = "modelDescription.xml"


def changed_fmu(fmu: Path, copy: Path, changes: Mapping[str, Change]) -> Path:
    """The copy.

    `changes`: by the name of a file its content, a function of its old content that alters it, or None to leave it out.
    """
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(copy, "w") as target:
        files = {name: source.read(name) for name in source.namelist()}
        for name, change in changes.items():
            new = change(files[name]) if callable(change) else change
            assert not callable(change) or new != files[name], f"{name} is as it was"
            if new is None:
                files.pop(name, None)
            else:
                files[name] = new
        for name, content in files.items():
            target.writestr(name, content)
    return copy
