"""Compiles the kernel and the shell into the library of an FMU, for any platform from any platform."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from fmu_src.native.sources import DETOUR, HERE, KERNEL_INCLUDE, shell_files
from fmu_src.native.universal import universal
from mbs.kernel import build

_INCLUDE = (KERNEL_INCLUDE, HERE, DETOUR)
# The kernel's own functions are not for hosts: only those of FMI are exported.
_DEFINES = ("ALI3_INSIDE",)


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
    """
    return _library(targets, _files(face, table), _INCLUDE, folder, name)


def compile_packed(targets: Sequence[str], sources: Path, folder: Path, name: str) -> bytes:
    """The same from the sources that lie in an FMU. `folder`, `name`: as for `compile_library`."""
    return _library(targets, sorted(sources.rglob("*.c")), (sources,), folder, name)


def _library(targets: Sequence[str], files: Sequence[Path], include: Sequence[Path], folder: Path, name: str) -> bytes:
    made = []
    for target in targets:
        library = folder / target / name
        build.compile_c(
            files, target, library, include=include, what="the FMU", defines=_DEFINES, exports=exports(files)
        )
        made.append(library.read_bytes())
    return made[0] if len(made) == 1 else universal(made)


def library_command(face: str, target: str, table: Path, library: Path) -> list[str]:
    """Command line of the compiler by which `compile_library` makes the library for a target."""
    files = _files(face, table)
    return build.compiler_command(files, target, library, include=_INCLUDE, defines=_DEFINES, exports=exports(files))


def exports(files: Sequence[Path]) -> list[str]:
    """Functions that a WebAssembly module of these C files exports: those of FMI 2.0 and what its host needs beside."""
    shell = [f.read_text(encoding="utf-8") for f in files if f.name.startswith("fmi2_")]
    found = re.findall(r"^FMI2_EXPORT .*\bFMI2_NAME\((\w+)\)", "\n".join(shell), re.MULTILINE)
    return [*found, *build.WASM_HELPERS]


def _files(face: str, table: Path) -> list[Path]:
    return [*build.sources(lanes=False), *shell_files(face), table]
