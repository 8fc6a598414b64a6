"""Compiles the kernel and the shell into the library of an FMU, for any platform from any platform."""

from __future__ import annotations

from pathlib import Path

from fmu_src.native.sources import HERE, KERNEL_INCLUDE, shell_files
from fmu_src.native.universal import universal
from fmu_src.platforms import SUFFIXES, TARGETS
from mbs.kernel import build


def compile_target(target: str, face: str, table: Path, library: Path) -> Path:
    """Compile for one target.

    Parameters
    ----------
    target : str
        Triple as `zig cc -target` takes it.
    face : str
        ``fmi2`` or ``fmi3``.
    table : Path
        The generated `table.c`.
    library : Path
        The file to write.

    Returns
    -------
    Path
        The library.
    """
    # The kernel's own functions are not for hosts: only those of FMI are exported.
    files = [*build.sources(), *shell_files(face), table]
    build.compile_c(files, target, library, include=(KERNEL_INCLUDE, HERE), what="the FMU", defines=("ALI3_INSIDE",))
    return library


def compile_platform(platform: str, face: str, table: Path, folder: Path, name: str) -> bytes:
    """Compile for one platform of FMI 2.0; darwin64 gives a universal file.

    Parameters
    ----------
    platform : str
        Out of ``linux64``, ``win64`` and ``darwin64``.
    face : str
    table : Path
    folder : Path
        For the compiler's output.
    name : str
        Of the library, without suffix.

    Returns
    -------
    bytes
        The library.
    """
    made = [
        compile_target(target, face, table, folder / target / f"{name}{SUFFIXES[platform]}").read_bytes()
        for target in TARGETS[platform]
    ]
    return made[0] if len(made) == 1 else universal(made)
