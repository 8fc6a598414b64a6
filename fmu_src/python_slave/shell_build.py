"""Compiles the shell around PythonFMU's library with zig, for any platform from any platform."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from fmu_src.platforms import SUFFIXES, TARGETS

_HERE = Path(__file__).parent


def compile_shell(platform: str, folder: Path) -> Path:
    """Compile `shell.c`.

    Parameters
    ----------
    platform : str
        FMI's name: ``linux64`` or ``win64``.
    folder : Path
        Where the library goes.

    Returns
    -------
    Path
        The library.

    Raises
    ------
    RuntimeError
        With the compiler's words.
    """
    library = folder / f"shell{SUFFIXES[platform]}"
    flags = ["-shared", "-fPIC", "-O2", "-std=c11", "-fvisibility=hidden", "-s", "-Wall", "-Wextra", "-Werror"]
    command = [sys.executable, "-m", "ziglang", "cc", "-target", TARGETS[platform], *flags]
    command += ["-o", str(library), str(_HERE / "shell.c")]
    if platform == "linux64":
        command.append("-ldl")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"The FMU's shell could not be compiled for {platform}:\n{done.stderr.strip()}")
    return library
