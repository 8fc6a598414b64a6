"""Time of FMU calls from a C program; Python runs only inside the FMU of the kind `python`."""

import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import fmpy

from benchmarks.shared.pages import Row, table
from fmu_src.native.sources import HERE as FMI_HEADERS
from mbs.kernel import build

CALLS = {
    "step": "one step of 2 ms",
    "get_all": "all outputs after a step",
    "get_again": "the same once more",
    "set_one": "one input set",
    "save_restore_free": "state: get, set, free",
    "instantiate_to_initialised": "instantiate to initialised",
}
"""Quantities in the table of the page, with their titles."""
KINDS = ("native", "python")
PYTHON_INSTANCES = 30  # at once, of the kind python
SOURCE = Path(__file__).parent / "c" / "time_fmu.c"


def measure(fmu: Path, kind: str, folder: Path, steps: int, repeats: int, instances: int) -> list[dict[str, Any]]:
    """Rows of an FMU, with ``quantity``, ``kind`` and ``value``; only that of its size if the C program cannot run it.

    `kind`: of `KINDS`; `folder`: folder for the unpacked FMU; `steps`: calls in a timed run; `repeats`: timed runs;
    `instances`: instances at the same time.
    """
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    values = {"file_MB": fmu.stat().st_size / 1e6}
    values |= time_from_c(folder, steps, repeats, instances if kind == "native" else PYTHON_INSTANCES)
    return [{"quantity": name, "kind": kind, "value": value} for name, value in values.items()]


def time_from_c(folder: Path, steps: int, repeats: int, instances: int) -> dict[str, float]:
    """Figures of the C program by quantity, us unless named otherwise; empty if it cannot run the FMU."""
    description = fmpy.read_model_description(str(folder))
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output"]
    program = folder / ("time_fmu.exe" if sys.platform == "win32" else "time_fmu")
    build.compile_c([SOURCE], build.host_target(), program, include=(FMI_HEADERS,), what="the timer", shared=False)
    library = (
        folder / "binaries" / fmpy.platform / (description.coSimulation.modelIdentifier + fmpy.sharedLibraryExtension)
    )
    numbers = (float(description.defaultExperiment.stepSize), steps, repeats, len(outputs), outputs[0], instances)
    command = [str(program), str(library), folder.joinpath("resources").as_uri(), description.guid, *map(str, numbers)]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    if process.returncode != 0:
        print(f"the C host cannot run it: {process.stderr.strip()}", file=sys.stderr)
    pairs = (line.split() for line in process.stdout.splitlines())
    return {name: float(value) for name, value in pairs}


def fmu_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of microseconds per call by kind of FMU."""
    results = {(r["quantity"], r["kind"]): r["value"] for r in rows}
    lines = [
        {"microseconds": title} | {kind: results.get((name, kind)) for kind in KINDS} for name, title in CALLS.items()
    ]
    return {"fmu calls": table(lines, {"microseconds": "", **dict.fromkeys(KINDS, ".3g")})}
