"""Compiles the shell around PythonFMU's library with zig, for any platform from any platform."""

from __future__ import annotations

from pathlib import Path

from fmu_src.native.sources import HERE as FMI_HEADERS
from fmu_src.platforms import SUFFIXES, TARGETS
from mbs.kernel import build

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
    """
    library = folder / f"shell{SUFFIXES[platform]}"
    build.compile_c([_HERE / "shell.c"], TARGETS[platform][0], library, include=(FMI_HEADERS,), what="the FMU's shell")
    return library
