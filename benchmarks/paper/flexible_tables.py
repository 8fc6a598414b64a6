"""Tables of cars with flexible frames: sizes by fidelity, counts and peaks of the kerb test."""

from collections.abc import Sequence

import numpy as np

import mbs
from benchmarks.car import fidelity_runs
from benchmarks.car.fidelity import size_of
from benchmarks.paper.kerb import peak_changes
from benchmarks.shared.pages import table
from mbs.scenes import kerb_test, prototype_car
from mbs.vehicle import Fidelity, load

KERB = (Fidelity.QUASI_STATIC, Fidelity.LOAD_PATHS, Fidelity.DYNAMIC)

HATCHBACK = (*((f, kerb_test.STEP) for f in KERB), *((Fidelity.DYNAMIC, h) for h in (0.005, 0.0025, 0.00125)))
PEAKS = {"peak change at SG1, SG3, N m": "peak", "the same after the low-pass of 10 Hz": "filtered"}
_AFTER_KERB = 9.0  # s


def size_table() -> str:
    """Table of coordinates and constraints of the prototype by fidelity."""
    rows = []
    for fidelity in (0, 1, 2, 3, 4, "paper"):
        system = mbs.compile(prototype_car.build(fidelity=fidelity))
        name = f'"{fidelity}"' if isinstance(fidelity, str) else str(fidelity)
        rows.append({"`fidelity`": name, "coordinates, rows": f"{system.nq}, {system.nc}"})
    return table(rows, dict.fromkeys(rows[0], ""))


def kerb_table() -> str:
    """Table of sizes, iterations and peaks of the kerb test with steps of 10 ms, a column for each fidelity."""
    titles = ("coordinates, rows, modes", "Newton iterations, mean (most)", *PEAKS)
    rows = [{"": title} for title in titles]
    for fidelity in KERB:
        size, result = size_of("kerb_test", fidelity), fidelity_runs.run("kerb_test", fidelity, kerb_test.STEP)
        report, peaks = result.report, peak_changes(result, kerb_test.STEP)
        assert report is not None
        cells = [
            f"{size['coordinates']}, {size['rows']}, {size['modes']}",
            f"{report.mean_iterations:.1f} ({report.max_iterations})",
            *(f"{peaks[f'{kind}_SG1']:.2f}, {peaks[f'{kind}_SG3']:.2f}" for kind in PEAKS.values()),
        ]
        for row, cell in zip(rows, cells, strict=True):
            row[f"fidelity {int(fidelity)}"] = cell
    return table(rows, dict.fromkeys(rows[0], ""))


def hatchback_kerb_table(cases: Sequence[tuple[Fidelity, float]] = HATCHBACK) -> str:
    """Table of sizes and peaks of the hatchback in the kerb test by fidelity and step, s."""
    car, rows = load("hatchback"), []
    for fidelity, h in cases:
        system = mbs.compile(kerb_test.build(fidelity, car))
        run = mbs.simulate(system, _AFTER_KERB, h, estimate_error=False)
        modes = 0 if fidelity is Fidelity.QUASI_STATIC else car.flexible_frame.reduced(fidelity).n_modes
        stress = {name: run[f"stress.{name}"] for name in ("SG1", "SG5")}
        peaks = {f"{name}, MPa": 1e-6 * float(np.abs(x - x[0]).max()) for name, x in stress.items()}
        size = f"{system.nq}, {system.nc}, {modes}"
        rows.append({"fidelity": int(fidelity), "h, ms": 1e3 * h, "coordinates, rows, modes": size, **peaks})
    return table(rows, {"fidelity": "d", "h, ms": "g", "coordinates, rows, modes": "", **dict.fromkeys(peaks, ".3g")})
