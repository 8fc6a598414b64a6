"""The paper's kerb test: peaks of the bending moments, residual moments at the end, cost."""

from typing import Any

import numpy as np

from benchmarks.car import fidelity, fidelity_runs
from benchmarks.shared.coarse_runs import expected_errors
from mbs import Simulation, Trajectory
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity

GAUGES = ("SG1", "SG3")
FIDELITIES = tuple(model.name.lower() for model in fidelity.COMPARED)
RELEASE = 13.0  # s, from which the tyres have no friction


def peak_changes(t: Trajectory, h: float) -> dict[str, float]:
    """Largest changes of the moments from rest, N m, before and after the low-pass. `h`: step, s."""
    result = fidelity_runs.peaks(t, h)
    peaks = {f"peak_{g}": result[f"bending_moment.{g}"] for g in GAUGES}
    return peaks | {f"filtered_{g}": result[f"{fidelity_runs.FILTERED}bending_moment.{g}"] for g in GAUGES}


def residual_moments(model: Fidelity, h: float) -> tuple[float, float]:
    """Largest residual change of a moment relative to its peak, of the standing car with and without tyre friction."""
    car = Simulation(fidelity_runs.system_of("kerb_test", model))
    names = [f"bending_moment.{g}" for g in GAUGES]
    t = car.run(RELEASE, h, progress=False)
    peaks = {n: float(np.abs(t[n] - t[n][0]).max()) for n in names}
    at_rest = car.sensors
    with expected_errors():
        car.set_parameter("road.friction", 0.0)
    car.run(kerb_test.DURATION, h, progress=False)
    free = car.sensors
    held, released = (max(abs(s[n] - float(t[n][0])) / peaks[n] for n in names) for s in (at_rest, free))
    return held, released


def measure(model: Fidelity, h: float, repeats: int) -> dict[str, Any]:
    """Row of a fidelity with a step, s; a rigid chassis has no moments."""
    row = fidelity.measure("kerb_test", model, h, repeats)
    row["seconds"] = kerb_test.DURATION / row["realtime_factor"]
    if model.rigid:
        return row
    reference = fidelity_runs.read_peaks("kerb_test")
    peaks = peak_changes(fidelity_runs.run("kerb_test", model, h), h)
    errors = {"peak": 0.0, "filtered": 0.0}
    for g in GAUGES:
        for kind, prefix in (("peak", ""), ("filtered", fidelity_runs.FILTERED)):
            size = reference[f"{prefix}bending_moment.{g}"]
            errors[kind] = max(errors[kind], abs(peaks[f"{kind}_{g}"] - size) / size)
    held, free = residual_moments(model, h)
    return row | peaks | {f"{k}_error": v for k, v in errors.items()} | {"left_held": held, "left_free": free}
