"""Platforms an FMU is built for, by the names of FMI 2.0 or, if it has none, by the tuple of FMI 3.0."""

import platform
import sys

TARGETS = {
    "linux64": ("x86_64-linux-gnu.2.17",),
    "win64": ("x86_64-windows-gnu",),
    "darwin64": ("x86_64-macos.10.13", "aarch64-macos.11.0"),
    "aarch64-linux": ("aarch64-linux-gnu.2.17",),
    "wasm32": ("wasm32-wasi",),
}
"""Target triples of `zig cc`; the two of darwin64 become one universal file."""

SUFFIXES = {"linux64": ".so", "win64": ".dll", "darwin64": ".dylib", "aarch64-linux": ".so", "wasm32": ".wasm"}

PLATFORMS = tuple(name for name in TARGETS if name != "wasm32")
"""Those of a build that names none: where tools load an FMU. WebAssembly, for pages, is asked for by name."""

PYTHON_PLATFORMS = ("linux64", "win64")
"""PythonFMU has libraries for these two only."""

FMI3_FOLDERS = {
    "x86_64-linux-gnu.2.17": "x86_64-linux",
    "x86_64-windows-gnu": "x86_64-windows",
    "x86_64-macos.10.13": "x86_64-darwin",
    "aarch64-macos.11.0": "aarch64-darwin",
    "aarch64-linux-gnu.2.17": "aarch64-linux",
}
"""Folders of binaries in FMI 3.0, one per target."""


def able_platforms(kind: str) -> tuple[str, ...]:
    """The platforms that a kind of FMU can have, see `fmu_src.build.build.KINDS`."""
    return {"native": tuple(TARGETS), "python": PYTHON_PLATFORMS}.get(kind, PLATFORMS)


def this_platform() -> str | None:
    """The platform of this machine, None if no FMU is built for it."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    if sys.platform == "darwin":
        return "darwin64"
    return {
        ("linux", "x86_64"): "linux64",
        ("linux", "aarch64"): "aarch64-linux",
        ("win32", "x86_64"): "win64",
    }.get((sys.platform, machine))
