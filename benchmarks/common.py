"""What every benchmark needs: the machine, repeated timing, tables and JSON files."""

from __future__ import annotations

import json
import os
import platform
import statistics
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

import mbs
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


def median_wall(action: Callable[[], float | None], repeats: int = 5, warm_up: int = 1) -> float:
    """Median wall time of an action, s.

    Parameters
    ----------
    action : callable
        Is run `warm_up + repeats` times. It may return the time it measured itself, s, to leave its preparations out.
    repeats, warm_up : int
        Measured and unmeasured runs.
    """
    walls = []
    for k in range(warm_up + repeats):
        begin = time.perf_counter()
        measured = action()
        wall = time.perf_counter() - begin if measured is None else measured
        if k >= warm_up:
            walls.append(wall)
    return statistics.median(walls)


def print_table(rows: Sequence[Mapping[str, Any]], columns: Mapping[str, str] | None = None) -> None:
    """Print rows as aligned columns.

    Parameters
    ----------
    rows : sequence of mapping
        All with the same keys; None prints as "-".
    columns : mapping of str to str, optional
        Which keys, and how their values are formatted (".3g"); by default all, as ".4g".
    """
    if not rows:
        return
    formats = dict(columns) if columns is not None else dict.fromkeys(rows[0], ".4g")
    lines = [list(formats)] + [[_cell(row[key], form) for key, form in formats.items()] for row in rows]
    widths = [max(len(line[k]) for line in lines) for k in range(len(formats))]
    left = [isinstance(rows[0][key], str) for key in formats]
    for number, line in enumerate(lines):
        cells = [c.ljust(w) if is_left else c.rjust(w) for c, w, is_left in zip(line, widths, left, strict=True)]
        print("  ".join(cells).rstrip())
        if number == 0:
            print("  ".join("-" * w for w in widths))


def write_json(file: Path, meta: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> None:
    """Write ``{"meta": ..., "rows": [...]}``; numbers that are not finite become null."""
    text = json.dumps({"meta": _plain(meta), "rows": _plain(rows)}, indent=1, allow_nan=False)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text + "\n", encoding="utf-8")


def _cell(value: Any, form: str) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else format(value, form)


def _plain(value: Any) -> Any:
    """Values that JSON knows."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def _processor() -> str:
    """Model name where the system tells it."""
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


@contextmanager
def wrong_on_purpose() -> Iterator[None]:
    """Runs whose steps or models are too coarse on purpose, held against a reference: what they say is known."""
    with warnings.catch_warnings():
        for category in (mbs.AccuracyWarning, mbs.BendingWarning, mbs.BranchWarning):
            warnings.simplefilter("ignore", category)
        yield
