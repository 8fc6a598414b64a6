"""Compiles the kernel with the C compiler that the `ziglang` package brings; no system compiler is needed."""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

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


def sources() -> list[Path]:
    """C files of the kernel, sorted by room and name."""
    return sorted((HERE / "src").rglob("*.c"))


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
    if "windows" in target:
        return "ali3.dll"
    return "libali3.dylib" if "macos" in target else "libali3.so"


def cache_directory() -> Path:
    """Where the compiler keeps what it built, outside the source tree: `ZIG_GLOBAL_CACHE_DIR`, else the home folder."""
    given = os.environ.get("ZIG_GLOBAL_CACHE_DIR")
    if given:
        return Path(given)
    try:
        home = Path.home() / ".cache" / "ali3-zig"
        home.mkdir(parents=True, exist_ok=True)
        return home
    except (OSError, RuntimeError):  # no home folder, or none to write to
        return Path(tempfile.mkdtemp(prefix="ali3-zig-"))


def compile_library(target: str | None = None, out: str | Path | None = None) -> Path:
    """Compile the kernel.

    Parameters
    ----------
    target : str, optional
        Triple as `zig cc -target` takes it; by default the platform this runs on.
    out : path, optional
        The library to write; by default `lib/` beside this file, under the platform's usual name.

    Returns
    -------
    Path
        The library.
    """
    target = target or host_target()
    path = Path(out) if out is not None else HERE / "lib" / library_name(target)
    compile_c(sources(), target, path, what="the kernel")
    return path


def compile_c(
    files: Sequence[Path],
    target: str,
    path: Path,
    *,
    include: Sequence[Path] = (),
    defines: Sequence[str] = (),
    what: str,
    shared: bool = True,
) -> None:
    """Compile C files into one library or program.

    Parameters
    ----------
    files : sequence of Path
        C files.
    target : str
        Triple as `zig cc -target` takes it.
    path : Path
        The file to write; an older one is replaced only when the new one is whole.
    include : sequence of Path
        Folders of headers.
    defines : sequence of str
        Macros.
    what : str
        Name for messages.
    shared : bool
        A library; otherwise a program.

    Raises
    ------
    RuntimeError
        With the compiler's words.
    """
    if importlib.util.find_spec("ziglang") is None:
        raise RuntimeError(f"{what} needs the compiler of the package 'ziglang': python -m pip install ziglang")
    path.parent.mkdir(parents=True, exist_ok=True)
    cache = str(cache_directory())
    environment = os.environ | {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        made = Path(folder) / path.name
        command = [sys.executable, "-m", "ziglang", "cc", "-target", target, *FLAGS]
        if not shared:
            command = [part for part in command if part not in ("-shared", "-fPIC")]
        elif "macos" in target:
            command.append(f"-Wl,-install_name,@rpath/{path.name}")
        command += [f"-I{place}" for place in include] + [f"-D{name}" for name in defines]
        command += ["-o", str(made), *map(str, files)]
        if "linux" in target:
            command += ["-lm", "-ldl"]
        result = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        if result.returncode != 0:
            raise RuntimeError(f"{what} did not compile for {target}:\n{result.stderr}")
        made.replace(path)  # at once, so that a program that has the old library loaded keeps it whole


def main() -> None:
    """Command line: `python -m mbs.kernel.build [--target TRIPLE] [--out FILE]`."""
    parser = argparse.ArgumentParser(description="Compile the ALi3 kernel.")
    parser.add_argument("--target", help="zig target triple; default: this platform")
    parser.add_argument("--out", help="library to write; default: lib/ beside this file")
    arguments = parser.parse_args()
    print(compile_library(arguments.target, arguments.out))


if __name__ == "__main__":
    main()
