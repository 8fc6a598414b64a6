"""Beams and the prototype frame in CalculiX, an independent finite-element program: ``python -m benchmarks.calculix``.

Writes the decks, runs ``ccx`` (Debian package calculix-ccx) and stores its figures, with their origin, for the tests.
CalculiX expands its quadratic beams B32R to solid elements and makes the sections at clamps and at joints rigid; that
stiffens half an element at each of them, an error of first order in the length of the elements. So every case is run
on three meshes, each twice as fine as the one before, and extrapolated (2 f(h/2) - f(h) of the two finest).
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car.calculix import (
    STORED,
    clamped_frequencies,
    frame_frequencies,
    frame_torsion,
    gauge_moments,
    tip_deflection,
)
from benchmarks.shared.command import parser_of, watched

TUBE_MESHES = (16, 32, 64)  # elements
FRAME_MESHES = (2, 4, 8)  # refinements


def main(arguments: Sequence[str] | None = None) -> int:
    """Run every case on three meshes, print and store."""
    parser_of("calculix", __doc__, json=False).parse_args(arguments)
    cases: dict[str, tuple[Callable[[int], Any], tuple[int, ...]]] = {
        "tube_tip_deflection_m": (tip_deflection, TUBE_MESHES),
        "tube_clamped_hz": (clamped_frequencies, TUBE_MESHES),
        "frame_torsional_stiffness_Nm_per_deg": (frame_torsion, FRAME_MESHES),
        "frame_loaded_free_hz": (lambda r: frame_frequencies(r, True, 5), FRAME_MESHES),
        "frame_bare_free_hz": (lambda r: frame_frequencies(r, False, 4), FRAME_MESHES),
        "frame_gauge_moments_Nm": (gauge_moments, FRAME_MESHES),
    }
    results: dict[str, list[Any]] = {name: [] for name in cases}
    for name, case, mesh in watched([(name, case, m) for name, (case, meshes) in cases.items() for m in meshes]):
        results[name].append(case(mesh))
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.strip()
    stored = {
        "origin": f"CalculiX, {version}; B32R beams with pipe sections; python -m benchmarks.calculix",
        "meshes": "three, each twice as fine; extrapolated = 2 f(h/2) - f(h) of the two finest",
    }
    for name, values in results.items():
        meshes = np.array(values)
        extrapolated = 2 * meshes[2] - meshes[1]
        stored[name] = {"meshes": meshes.tolist(), "extrapolated": np.round(extrapolated, 8).tolist()}
        print(f"{name}: {meshes.tolist()} -> {np.round(extrapolated, 6).tolist()}")
    STORED.parent.mkdir(parents=True, exist_ok=True)
    write_text(STORED, json.dumps(stored, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
