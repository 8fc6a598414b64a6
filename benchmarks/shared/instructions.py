"""Instructions of a function in a program, counted by valgrind: the same on a busy machine and on an idle one."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Sequence
from functools import cache
from pathlib import Path

_COLLECTED = re.compile(r"Collected : (\d+)")
_FUNCTION = re.compile(r"^\s*([\d,]+) \(\s*[\d.]+%\)\s+\S*?:(\w+)", re.MULTILINE)


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


def by_function(command: Sequence[str], function: str, folder: Path) -> dict[str, int]:
    """Instructions within all calls of an exported function by the function they are in; most first.

    The program must have the names of its functions. Raises `RuntimeError`: there is no valgrind, or it named no
    function.
    """
    valgrind = counter()
    if valgrind is None:
        raise RuntimeError("Functions are counted by valgrind, which is not installed.")
    file = folder / "callgrind"
    options = ["--tool=callgrind", f"--callgrind-out-file={file}", f"--toggle-collect={function}"]
    subprocess.run([valgrind, *options, *command], capture_output=True, check=True)
    annotate = ["callgrind_annotate", "--threshold=100", str(file)]
    shown = subprocess.run(annotate, capture_output=True, text=True, check=True)
    found: Counter[str] = Counter()
    for count, name in _FUNCTION.findall(shown.stdout):
        found[name] += int(count.replace(",", ""))
    if not found:
        raise RuntimeError("valgrind named no function: the program has no names of its functions.")
    return dict(found.most_common())
