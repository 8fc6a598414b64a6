"""Describes the machine, the date and the versions of a measurement."""

import os
import platform
import time
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from mbs.settings.settings import Settings

PACKAGES = ("ali3", "numpy", "scipy", "fmpy", "pythonfmu", "ziglang", "drake", "exudyn", "mujoco", "pin")


def machine() -> dict[str, Any]:
    """Processor, cores, system, and versions of Python and of the packages that are installed."""
    versions = {}
    for package in PACKAGES:
        try:
            versions[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "python": platform.python_version(),
        "versions": versions,
    }


def describe(benchmark: str, *, repeats: int = 1, **options: Any) -> dict[str, Any]:
    """The `meta` part of a JSON file: command, time, machine and settings.

    `repeats`: measured runs of a figure; `**options`: options of the command; JSON values.
    """
    meta: dict[str, Any] = {"benchmark": benchmark, "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}
    meta |= {"machine": machine(), "repeats": repeats, "settings": Settings().kernel_fields()}
    return meta | options


def machine_text(meta: Mapping[str, Any]) -> str:
    """Machine and versions, in one line."""
    m = meta["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in m["versions"].items())
    return f"{m['processor']}, {m['cores']} cores, {m['system']}, Python {m['python']}; {versions}"


def conditions(meta: Mapping[str, Any]) -> str:
    """Machine, versions and number of runs as text, from `describe`."""
    runs = "one run" if meta["repeats"] == 1 else f"{meta['repeats']} runs"
    return f"{machine_text(meta)}\nDefault settings; {runs} of each figure"


def _processor() -> str:
    """Model name of the processor if the system reports it."""
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
