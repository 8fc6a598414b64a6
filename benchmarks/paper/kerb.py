"""The paper's test on the kerb: peaks of the bending moments, residual moments at the end, cost."""

from typing import Any

import numpy as np

from benchmarks.car import fidelity, fidelity_runs
from benchmarks.shared.coarse_runs import expected_errors
from mbs import Simulation, Trajectory
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity

GAUGES = ("SG1", "SG3")
FIDELITIES = tuple(model.name.lower() for model in fidelity.COMPARED)
RELEASE = 13.0  # s: tyres let go


def changes(t: Trajectory, h: float) -> dict[str, float]:
    """Largest changes from rest, N m."""
    result = fidelity_runs.peaks(t, h)
    shown = {f"peak_{g}": result[f"bending_moment.{g}"] for g in GAUGES}
    return shown | {f"filtered_{g}": result[f"{fidelity_runs.FILTERED}bending_moment.{g}"] for g in GAUGES}


def left_at_the_end(model: Fidelity, h: float) -> tuple[float, float]:
    """Largest change of a moment that stays, over its peak: as the car stands, and with its tyres let go."""
    car = Simulation(fidelity_runs.system_of("kerb_test", model))
    names = [f"bending_moment.{g}" for g in GAUGES]
    t = car.run(RELEASE, h, progress=False)
    peaks = {n: float(np.abs(t[n] - t[n][0]).max()) for n in names}
    at_rest = car.sensors
    with expected_errors():
        car.set_parameter("road.friction", 0.0)
    car.run(kerb_test.DURATION, h, progress=False)
    free = car.sensors
    one, other = (max(abs(s[n] - float(t[n][0])) / peaks[n] for n in names) for s in (at_rest, free))
    return one, other


def measure(model: Fidelity, h: float, repeats: int) -> dict[str, Any]:
    """One row; where the chassis is rigid there are no moments."""
    row = fidelity.measure("kerb_test", model, h, repeats)
    row["seconds"] = kerb_test.DURATION / row["realtime_factor"]
    if model.rigid:
        return row
    reference = fidelity_runs.read_peaks("kerb_test")
    peaks = changes(fidelity_runs.run("kerb_test", model, h), h)
    errors = {"peak": 0.0, "filtered": 0.0}
    for g in GAUGES:
        for what, prefix in (("peak", ""), ("filtered", fidelity_runs.FILTERED)):
            size = reference[f"{prefix}bending_moment.{g}"]
            errors[what] = max(errors[what], abs(peaks[f"{what}_{g}"] - size) / size)
    held, free = left_at_the_end(model, h)
    return row | peaks | {f"{k}_error": v for k, v in errors.items()} | {"left_held": held, "left_free": free}
