"""Compiles the kernel and the shell into the library of an FMU, for any platform from any platform."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fmu_src.native.sources import DETOUR, HERE, KERNEL_INCLUDE, shell_files
from fmu_src.native.universal import universal
from mbs.kernel import build


def compile_library(targets: Sequence[str], face: str, table: Path, folder: Path, name: str) -> bytes:
    """Compile for one platform; several targets make one universal file.

    Parameters
    ----------
    targets : sequence of str
        Triples as `zig cc -target` takes them.
    face : str
        ``fmi2``, ``fmi3`` or ``python``.
    table : Path
        The generated `table.c`.
    folder : Path
        For the compiler's output.
    name : str
        Of the library, with its suffix.

    Returns
    -------
    bytes
        The library.
    """
    # The kernel's own functions are not for hosts: only those of FMI are exported.
    files = [*build.sources(), *shell_files(face), table]
    made = []
    for target in targets:
        library, include = folder / target / name, (KERNEL_INCLUDE, HERE, DETOUR)
        build.compile_c(files, target, library, include=include, what="the FMU", defines=("ALI3_INSIDE",))
        made.append(library.read_bytes())
    return made[0] if len(made) == 1 else universal(made)
