"""The paper's test on the kerb: peaks of the bending moments, what is left of them at the end, cost."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.car import fidelity_runs
from benchmarks.car.fidelity import COMPARED, size_of
from benchmarks.shared.warned import wrong_on_purpose
from mbs import Simulation, Trajectory
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity

GAUGES = ("SG1", "SG3")
FIDELITIES = tuple(fidelity.name.lower() for fidelity in COMPARED)
RELEASE = 13.0  # s: tyres let go


def changes(t: Trajectory, h: float) -> dict[str, float]:
    """Largest changes from rest, N m."""
    found = fidelity_runs.peaks(t, h)
    shown = {f"peak_{g}": found[f"bending_moment.{g}"] for g in GAUGES}
    return shown | {f"filtered_{g}": found[f"{fidelity_runs.FILTERED}bending_moment.{g}"] for g in GAUGES}


def left_at_the_end(fidelity: Fidelity, h: float) -> tuple[float, float]:
    """Largest change of a moment that stays, over its peak: as the car stands, and with its tyres let go."""
    car = Simulation(fidelity_runs.system_of("kerb_test", fidelity))
    names = [f"bending_moment.{g}" for g in GAUGES]
    t = car.run(RELEASE, h, progress=False)
    peaks = {n: float(np.abs(t[n] - t[n][0]).max()) for n in names}
    held = car.sensors
    with wrong_on_purpose():
        car.set_parameter("road.friction", 0.0)
    car.run(kerb_test.DURATION, h, progress=False)
    free = car.sensors
    one, other = (max(abs(s[n] - float(t[n][0])) / peaks[n] for n in names) for s in (held, free))
    return one, other


def measure(fidelity: Fidelity, h: float, repeats: int) -> dict[str, Any]:
    """One row; where the chassis is rigid there are no moments."""
    found = fidelity_runs.run("kerb_test", fidelity, h)
    report = found.report
    assert report is not None
    spent = fidelity_runs.cpu_time("kerb_test", fidelity, h, repeats)
    row: dict[str, Any] = {
        "fidelity": fidelity.name.lower(),
        "h_s": h,
        **size_of("kerb_test", fidelity),
        "iterations_mean": report.mean_iterations,
        "iterations_max": report.max_iterations,
        "seconds": spent,
        "realtime_factor": kerb_test.DURATION / spent,
    }
    if fidelity.rigid:
        return row
    reference = fidelity_runs.read_peaks("kerb_test")
    peaks = changes(found, h)
    errors = {"peak": 0.0, "filtered": 0.0}
    for g in GAUGES:
        for what, prefix in (("peak", ""), ("filtered", fidelity_runs.FILTERED)):
            size = reference[f"{prefix}bending_moment.{g}"]
            errors[what] = max(errors[what], abs(peaks[f"{what}_{g}"] - size) / size)
    held, free = left_at_the_end(fidelity, h)
    return row | peaks | {f"{k}_error": v for k, v in errors.items()} | {"left_held": held, "left_free": free}
