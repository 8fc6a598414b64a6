"""Compiles the kernel and the shell into the library of an FMU, for any platform from any platform.

The compiler knows an object by the place of its source. Sources are compiled in a place that their content names, so
that other clones and environments find what one of them has compiled.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from ali3.files import write_bytes
from fmu_src.native.archive import identity_of
from fmu_src.native.sources import HERE, PYTHON_SLAVE, shell_files
from fmu_src.native.universal_binary import universal
from mbs.kernel import build

_ROOMS = {build.HERE: "kernel", HERE: "shell", PYTHON_SLAVE: "python"}
_INCLUDE = ("kernel/include", "kernel/src", "shell", "python")
# The kernel's own functions are not for hosts: only functions of FMI are exported.
_DEFINES = ("ALI3_INSIDE",)


def compile_library(
    targets: Sequence[str], face: str, table: Path, generated: Mapping[str, str], folder: Path, name: str
) -> bytes:
    """Compile for one platform; several targets make one universal file.

    Parameters
    ----------
    targets : sequence of str
        Triples as `zig cc -target` takes them.
    face : str
        ``fmi2``, ``fmi3`` or ``python``.
    table : Path
        The generated `table.c`.
    generated : mapping of str to str
        C that was generated for Systems, by name.
    folder : Path
        For the compiler's output.
    name : str
        Of the library, with its suffix.
    """
    return _library(targets, *_files(face, table, generated), folder, name)


def compile_packed(targets: Sequence[str], sources: Path, folder: Path, name: str) -> bytes:
    """The same from the sources that lie in an FMU. `folder`, `name`: as for `compile_library`."""
    return _library(targets, sorted(sources.rglob("*.c")), (sources,), folder, name)


def _library(targets: Sequence[str], files: Sequence[Path], include: Sequence[Path], folder: Path, name: str) -> bytes:
    binaries = []
    for target in targets:
        library = folder / target / name
        build.compile_c(
            files, target, library, include=include, what="the FMU", defines=_DEFINES, exports=exports(files)
        )
        binaries.append(library.read_bytes())
    return binaries[0] if len(binaries) == 1 else universal(binaries)


def library_command(face: str, target: str, table: Path, library: Path) -> list[str]:
    """Command line of the compiler by which `compile_library` makes the library for a target."""
    files, include = _files(face, table, {})
    return build.compiler_command(files, target, library, include=include, defines=_DEFINES, exports=exports(files))


def exports(files: Sequence[Path]) -> list[str]:
    """Functions that a WebAssembly module of these C files exports: FMI 2.0 and what its host needs beside."""
    shell = [f.read_text(encoding="utf-8") for f in files if f.name.startswith("fmi2_")]
    functions = re.findall(r"^FMI2_(?:ENTRY|EXPORT .*\bFMI2_NAME)\((\w+)", "\n".join(shell), re.MULTILINE)
    return [*functions, *build.WASM_HELPERS]


def _files(face: str, table: Path, generated: Mapping[str, str]) -> tuple[list[Path], list[Path]]:
    """C files and folders of headers: copies, but the table. All headers name their folder, each C file itself.

    C files that a header includes are beside the headers too.
    """
    files = [*build.sources(lanes=False), *shell_files(face)]
    headers = {_inside(file): file.read_bytes() for root in _ROOMS for file in root.rglob("*.h")}
    matches = (re.findall(rb'#include "(?:.*/)?(\w+\.c)"', data) for data in headers.values())
    included = {name.decode() for names in matches for name in names}
    headers |= {_inside(file): file.read_bytes() for file in files if file.name in included}
    cache_folder = build.cache_directory() / "sources" / identity_of(headers, None)[0]
    copies, compiled = {cache_folder / name: data for name, data in headers.items()}, [table]
    for file in files:
        data = file.read_bytes()
        compiled.append((cache_folder / _inside(file)).with_stem(f"{file.stem}-{identity_of({'': data}, None)[0]}"))
        copies[compiled[-1]] = data
    for name, text in generated.items():
        data = text.encode()
        compiled.append(cache_folder / "generated" / f"{name}-{identity_of({'': data}, None)[0]}.c")
        copies[compiled[-1]] = data
    for copy, data in copies.items():
        if not copy.is_file():
            write_bytes(copy, data)
    return compiled, [cache_folder / name for name in _INCLUDE]


def _inside(file: Path) -> str:
    return next(f"{name}/{file.relative_to(r).as_posix()}" for r, name in _ROOMS.items() if file.is_relative_to(r))
