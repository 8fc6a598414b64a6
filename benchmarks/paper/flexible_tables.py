"""Tables of the page of the flexible car: sizes by fidelity, counts and peaks of the kerb test."""

from __future__ import annotations

import mbs
from benchmarks.car import fidelity_runs
from benchmarks.car.fidelity import size_of
from benchmarks.paper.kerb import changes
from mbs.scenes import kerb_test, prototype_car
from mbs.vehicle import Fidelity

KERB = (Fidelity.QUASI_STATIC, Fidelity.LOAD_PATHS, Fidelity.DYNAMIC)


def size_table() -> str:
    """Coordinates and rows of the prototype by fidelity."""
    rows = []
    for fidelity in (0, 1, 2, 3, 4, "paper"):
        system = mbs.compile(prototype_car.build(fidelity=fidelity))
        name = f'"{fidelity}"' if isinstance(fidelity, str) else fidelity
        rows.append(f"| {name} | {system.nq}, {system.nc} |")
    return "\n".join(["| `fidelity` | coordinates, rows |", "| --- | --- |", *rows])


def kerb_table() -> str:
    """Sizes, iterations and peaks of the kerb test with steps of 10 ms; a column a fidelity."""
    columns = []
    for fidelity in KERB:
        size, found = size_of("kerb_test", fidelity), fidelity_runs.run("kerb_test", fidelity, kerb_test.STEP)
        report, peaks = found.report, changes(found, kerb_test.STEP)
        assert report is not None
        columns.append(
            [
                f"fidelity {int(fidelity)}",
                "---",
                f"{size['coordinates']}, {size['rows']}, {size['modes']}",
                f"{report.mean_iterations:.1f} ({report.max_iterations})",
                *(f"{peaks[f'{what}_SG1']:.2f}, {peaks[f'{what}_SG3']:.2f}" for what in ("peak", "filtered")),
            ]
        )
    names = (
        "",
        "---",
        "coordinates, rows, modes",
        "Newton iterations, mean (most)",
        "peak change at SG1, SG3, N m",
        "the same after the low-pass of 10 Hz",
    )
    return "\n".join(f"| {' | '.join(cells)} |" for cells in zip(names, *columns, strict=True))
