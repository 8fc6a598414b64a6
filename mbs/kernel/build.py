"""Compiles the kernel with the C compiler that the `ziglang` package brings; no system compiler is needed."""

import functools
import hashlib
import importlib.util
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from ali3.cache import cache_folder
from ali3.temporary_folder import temporary_folder

HERE = Path(__file__).resolve().parent
FLAGS = [
    "-O3",
    "-std=c11",
    "-fPIC",
    "-shared",
    "-fvisibility=hidden",
    "-ffp-contract=off",
    "-s",
    "-Wall",
    "-Wextra",
    "-Werror",
]
"""No fused or reordered arithmetic: the same bits on every platform."""

NO_UNWIND_TABLES = ["-fno-asynchronous-unwind-tables", "-fno-unwind-tables"]
"""Nothing is thrown through the kernel; Windows walks its stacks by these tables and keeps them."""

WASM_FLAGS = [
    "-mexec-model=reactor",
    "-DALI3_ALONE",  # files and messages in memory: the module imports nothing
    "-Wno-pass-failed",  # a loop that is asked to be vectors stays one, without simd128
    "-Wl,-z,stack-size=1048576",  # below all data, so that an overflow is a trap
]
"""In place of ``-shared -fPIC`` for WebAssembly."""

WASM_HELPERS = ("malloc", "free", "ali3_file_add", "ali3_file_remove")
"""Exports of a WebAssembly module for its host besides its own functions: memory, and files in it."""


LANES = ("lanes", "run_many.c", "entries.c")
"""Parts of `src/` that an FMU lacks: stepping of many instances together, and the functions that Python calls."""


def sources(lanes: bool = True, kernel: Path | None = None) -> list[Path]:
    """C files of the kernel, sorted by room and name; without `lanes` what steps one instance.

    `kernel`: folder of it, by default that beside this file.
    """
    files = sorted(((kernel or HERE) / "src").rglob("*.c"))
    return [f for f in files if lanes or not (f.parent.name in LANES or f.name in LANES)]


def host_target() -> str:
    """Target triple of the machine this runs on; Linux libraries ask for no newer glibc than 2.17."""
    machine = platform.machine().lower()
    cpu = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}.get(machine)
    system = {"linux": "linux-gnu.2.17", "win32": "windows-gnu", "darwin": "macos"}.get(sys.platform)
    if cpu is None or system is None:
        raise RuntimeError(f"no compiler target is known for {machine} under {sys.platform}")
    if system == "macos":
        system = "macos.11.0" if cpu == "aarch64" else "macos.10.13"
    return f"{cpu}-{system}"


def library_name(target: str) -> str:
    """File name of the library for a target triple."""
    if "wasm" in target:
        return "ali3.wasm"
    if "windows" in target:
        return "ali3.dll"
    return "libali3.dylib" if "macos" in target else "libali3.so"


@functools.cache
def cache_directory() -> Path:
    """Cache folder of the compiler: `ZIG_GLOBAL_CACHE_DIR`, else a cache of the user; see `cache_folder`."""
    return cache_folder(name="ali3-zig", variable="ZIG_GLOBAL_CACHE_DIR")


def compiler() -> str:
    """The program `zig` that the package `ziglang` brings.

    It is called by its path: ``python -m ziglang`` would look into the current folder first. Raises
    `ModuleNotFoundError` if the package is not installed.
    """
    spec = importlib.util.find_spec("ziglang")
    if spec is None or not spec.submodule_search_locations:
        raise ModuleNotFoundError(
            "The package ziglang, which compiles C, is not installed; run: python -m pip install ziglang",
            name="ziglang",
        )
    return str(Path(spec.submodule_search_locations[0], "zig.exe" if os.name == "nt" else "zig"))


def compile_library(target: str | None = None, out: str | Path | None = None) -> Path:
    """Compile the kernel, once for all folders that hold the same sources.

    `target`: triple as `zig cc -target` takes it; by default the platform this runs on; `out`: the library to write; by
    default `lib/` beside this file, under the platform's usual name.
    """
    target = target or host_target()
    path = Path(out) if out is not None else HERE / "lib" / library_name(target)
    exports = (*functions(), *WASM_HELPERS)
    command = compiler_command([], target, Path(library_name(target)), exports=exports)
    library = cache_directory() / "kernels" / digest_of(command, HERE) / library_name(target)
    if not library.is_file():
        compile_c(sources(), target, library, what="the kernel", exports=exports)
    path.parent.mkdir(parents=True, exist_ok=True)
    with temporary_folder(path.parent) as folder:
        shutil.copyfile(library, Path(folder, path.name)).replace(path)  # as in `compile_c`
    return path


def digest_of(command: Sequence[str], *folders: Path) -> str:
    """A hash of the compiler's version, its options, and the C files and headers in folders: no places but options'."""
    digest = hashlib.sha256(repr((version("ziglang"), command[1:])).encode())
    for root, source in ((folder, file) for folder in folders for file in sorted(folder.rglob("*.[ch]"))):
        content = source.read_bytes()
        digest.update(f"\n{source.relative_to(root).as_posix()} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def functions() -> list[str]:
    """Functions of the kernel, as its header declares them."""
    header = (HERE / "include" / "ali3.h").read_text(encoding="utf-8")
    return re.findall(r"^ALI3_API [^;(]*?\b(ali3_\w+)\(", header, re.MULTILINE)


def compile_c(
    files: Sequence[Path],
    target: str,
    path: Path,
    *,
    include: Sequence[Path] = (),
    defines: Sequence[str] = (),
    what: str,
    shared: bool = True,
    exports: Sequence[str] = (),
) -> None:
    """Compile C files into one library or program.

    Parameters
    ----------
    target : str
        Triple as `zig cc -target` takes it.
    path : Path
        The file to write; an older one is replaced only when the new one is whole.
    include : sequence of Path
        Folders of headers.
    what : str
        Name for messages.
    shared : bool
        A library; otherwise a program.
    exports : sequence of str
        Functions that a WebAssembly module exports; other libraries export by the sources.

    Raises
    ------
    RuntimeError
        With the compiler's words.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    environment = compiler_environment()
    with temporary_folder(path.parent) as folder:
        output = Path(folder) / path.name
        command = compiler_command(
            files, target, output, include=include, defines=defines, shared=shared, exports=exports
        )
        result = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        if result.returncode != 0:
            words = result.stderr.strip()
            if not words:  # the linker ends so when it cannot write
                words = f"the compiler ended with {result.returncode} and no message; is there room in {path.parent}?"
            raise RuntimeError(f"{what} did not compile for {target}:\n{words}")
        output.replace(path)  # at once, so that a program that has the old library loaded keeps it whole


def compiler_environment() -> dict[str, str]:
    """Environment of the compiler: that of this process with the place of the compiler's cache."""
    cache = str(cache_directory())
    return os.environ | {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}


def compiler_command(
    files: Sequence[Path],
    target: str,
    path: Path,
    *,
    include: Sequence[Path] = (),
    defines: Sequence[str] = (),
    shared: bool = True,
    exports: Sequence[str] = (),
) -> list[str]:
    """Command line that compiles C files into `path`; the arguments are those of `compile_c`."""
    command = [compiler(), "cc", "-target", target, *FLAGS, *([] if "windows" in target else NO_UNWIND_TABLES)]
    module = "wasm" in target
    if module or not shared:
        command = [part for part in command if part not in ("-shared", "-fPIC")]
    if module:
        command += WASM_FLAGS + [f"-Wl,--export={name}" for name in exports]
    elif shared and "macos" in target:
        command.append(f"-Wl,-install_name,@rpath/{path.name}")
    command += [f"-I{place}" for place in include] + [f"-D{name}" for name in defines]
    command += ["-o", str(path), *map(str, files)]
    if "linux" in target:
        command += ["-lm", "-ldl"]
    return command
