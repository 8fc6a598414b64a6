"""Where, when and with what something was measured."""

from __future__ import annotations

import os
import platform
import time
from importlib import metadata
from pathlib import Path
from typing import Any

from mbs.settings import Settings

PACKAGES = ("ali3", "numpy", "scipy", "fmpy", "pythonfmu", "ziglang", "exudyn", "mujoco")


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


def describe(benchmark: str, settings: Settings | None = None, **more: Any) -> dict[str, Any]:
    """The `meta` part of a JSON file: what was measured, when, where and how.

    Parameters
    ----------
    benchmark : str
        Its name.
    settings : Settings, optional
        Of the solver.
    **more
        Anything else a reader must know; JSON values.
    """
    meta: dict[str, Any] = {"benchmark": benchmark, "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}
    meta |= {"machine": machine()}
    if settings is not None:
        meta["settings"] = settings.kernel_fields()
    return meta | more


def _processor() -> str:
    """Model name where the system tells it."""
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
