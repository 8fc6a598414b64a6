"""Compute the motions that take long: those without an exact reduction by minimum-norm accelerations, DOP853 or Radau.

python -m benchmarks.references.store [SCENE ...]
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np

from benchmarks.references.cases import CASES, SAMPLES, STORED, computed

NAMES = tuple(name for name, case in CASES.items() if case.stored)


def main(names: Sequence[str]) -> int:
    """Write one file for each scene."""
    for name in names or NAMES:
        case = CASES[name]
        rows = np.column_stack([np.linspace(0.0, case.end, SAMPLES + 1), computed(name)])
        header = f"python -m benchmarks.references.store {name}\n" + ",".join(["time_s", *case.sensors])
        np.savetxt(STORED / f"{name}.csv", rows, fmt="%.17g", delimiter=",", header=header)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
