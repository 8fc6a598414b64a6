"""Instructions of a function in a program, counted by valgrind: the same on a busy machine and on an idle one."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache

_COLLECTED = re.compile(r"Collected : (\d+)")


@cache
def counter() -> str | None:
    """The program valgrind; None where it is not installed."""
    return shutil.which("valgrind")


def instructions(command: Sequence[str], function: str = "") -> int | None:
    """Instructions within all calls of an exported function, else of the program; None without valgrind.

    Raises `RuntimeError`: valgrind did not say how many.
    """
    valgrind = counter()
    if valgrind is None:
        return None
    options = ["--tool=callgrind", "--callgrind-out-file=/dev/null"]
    options += [f"--toggle-collect={function}"] if function else []
    done = subprocess.run([valgrind, *options, *command], capture_output=True, text=True, check=True)
    found = _COLLECTED.search(done.stderr)
    if found is None:
        raise RuntimeError(f"{valgrind} did not say how many instructions it has counted.")
    return int(found[1])
