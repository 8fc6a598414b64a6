"""Compilation of the kernel with the C compiler of the package `ziglang`; no system compiler is needed."""

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
from ali3.errors import FileError
from ali3.folders import atomic_folder
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
"""Without fused or reordered arithmetic, so that results have the same bits on all platforms."""
NO_UNWIND_TABLES = ["-fno-asynchronous-unwind-tables", "-fno-unwind-tables"]
"""The kernel has no exceptions; only Windows needs these tables, to unwind its stack."""
WASM_FLAGS = [
    "-mexec-model=reactor",
    "-DALI3_ALONE",  # files and messages in memory: the module imports nothing
    "-Wno-pass-failed",  # without simd128, loops cannot be vectorised
    "-Wl,-z,stack-size=1048576",  # below all data, so that an overflow traps
]
"""Flags for WebAssembly instead of ``-shared -fPIC``."""
WASM_HELPERS = ("malloc", "free", "ali3_file_add", "ali3_file_remove")
"""Exports of a WebAssembly module in addition to the kernel's functions: memory, and files in memory."""
LANES = ("lanes", "run_many.c", "entries.c")
"""Folders and files of `src/` that an FMU does not have: steps of many instances, and the functions for Python."""


def sources(lanes: bool = True, kernel: Path | None = None) -> list[Path]:
    """C files of the kernel, sorted by folder and name.

    `lanes`: whether to include those in `LANES`; `kernel`: folder of the kernel, by default the one of this file.
    """
    files = sorted(((kernel or HERE) / "src").rglob("*.c"))
    return [f for f in files if lanes or not (f.parent.name in LANES or f.name in LANES)]


def host_target() -> str:
    """Target triple of this machine; Linux libraries need glibc 2.17 or newer."""
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
    """Cache folder of the compiler: `ZIG_GLOBAL_CACHE_DIR`, otherwise a cache of the user; see `cache_folder`."""
    return cache_folder(name="ali3-zig", variable="ZIG_GLOBAL_CACHE_DIR")


def compiler() -> str:
    """Path of the program `zig` of the package `ziglang`.

    ``python -m ziglang`` would search the current folder first. Raises `ModuleNotFoundError`: the package is not
    installed.
    """
    spec = importlib.util.find_spec("ziglang")
    if spec is None or not spec.submodule_search_locations:
        raise ModuleNotFoundError(
            "The package ziglang, which compiles C, is not installed; run: python -m pip install ziglang",
            name="ziglang",
        )
    return str(Path(spec.submodule_search_locations[0], "zig.exe" if os.name == "nt" else "zig"))


def compile_library(target: str | None = None, out: str | Path | None = None) -> Path:
    """Compile the kernel, once for equal sources, and return the path of the library.

    `target`: triple for `zig cc -target`, by default for this machine; `out`: path of the library, by default in
    `lib/` beside this file with the usual name of the platform.
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
    """Hash of the compiler's version, its options, and names and content of the C files and headers in folders."""
    digest = hashlib.sha256(repr((version("ziglang"), command[1:])).encode())
    for root, source in ((folder, file) for folder in folders for file in sorted(folder.rglob("*.[ch]"))):
        content = source.read_bytes()
        digest.update(f"\n{source.relative_to(root).as_posix()} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def functions() -> list[str]:
    """Names of the kernel's functions, from its header."""
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
        Triple for `zig cc -target`.
    path : Path
        File to write; an existing one is replaced when the new one is complete.
    include : sequence of Path
        Folders of headers.
    what : str
        Name of the product in errors.
    shared : bool
        Make a library; otherwise a program.
    exports : sequence of str
        Functions that a WebAssembly module exports; other libraries mark them in the sources.

    Raises
    ------
    RuntimeError
        The compiler fails; with its message.
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
            message = result.stderr.strip()
            if not message:  # as when the linker cannot write
                message = f"the compiler ended with {result.returncode} and no message; is there room in {path.parent}?"
            raise RuntimeError(f"{what} did not compile for {target}:\n{message}")
        output.replace(path)  # atomically, because a program may have loaded the old library


def compiler_environment() -> dict[str, str]:
    """Environment of this process with the folders of the compiler's cache and of its headers."""
    cache = str(cache_directory())
    folders = {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache, "ZIG_LIB_DIR": str(_compiler_headers())}
    return os.environ | folders


def _compiler_headers() -> Path:
    """The compiler's headers and libraries in its cache, the same files for all installations of one version.

    The cache notes inode and time of each. A compiler that finds others notes them again, and for that waits until no
    other compiler runs that has read the note.
    """
    own = Path(compiler()).parent / "lib"
    shared = cache_directory() / "lib" / version("ziglang")
    if not shared.is_dir():
        try:
            with atomic_folder(shared) as temporary:
                shutil.copytree(own, temporary, copy_function=_link_or_copy, dirs_exist_ok=True)
        except FileError:  # as where there is no room
            return own
    return shared


def _link_or_copy(source: str, target: str) -> None:
    try:
        os.link(source, target)
    except OSError:  # another file system, or one without links
        shutil.copy2(source, target)


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
    """Command line that compiles C files into `path`, with the arguments of `compile_c`."""
    command = [compiler(), "cc", "-target", target, *FLAGS, *([] if "windows" in target else NO_UNWIND_TABLES)]
    is_wasm = "wasm" in target
    if is_wasm or not shared:
        command = [flag for flag in command if flag not in ("-shared", "-fPIC")]
    if is_wasm:
        command += WASM_FLAGS + [f"-Wl,--export={name}" for name in exports]
    elif shared and "macos" in target:
        command.append(f"-Wl,-install_name,@rpath/{path.name}")
    command += [f"-I{folder}" for folder in include] + [f"-D{name}" for name in defines]
    command += ["-o", str(path), *map(str, files)]
    if "linux" in target:
        command += ["-lm", "-ldl"]
    return command
