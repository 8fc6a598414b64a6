"""Manoeuvres for the comparison of fidelities, their stored references and the errors against them."""

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.files import write_text
from ali3.low_pass import low_pass
from benchmarks.car import manoeuvres
from benchmarks.shared.tables import read_csv, write_csv
from hosts.driving.manoeuvre import Manoeuvre
from mbs import Settings, System, Trajectory, compile
from mbs.scenes import kerb_test, prototype_car
from mbs.vehicle import Fidelity
from mbs.vehicle.levels.errors import LOADS, POSITION, error_of_change, path_error

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "fidelity"
NAMES = ("kerb_test", "double_lane_change_replay", "drop")
INTERVAL = 0.01  # s, between the samples of a reference
FREQUENCY = 10.0  # Hz, of the low-pass
STEP = 5e-4  # s, of the references
MOMENTS = tuple(f"bending_moment.{g}" for g in prototype_car.car().frame_section.gauges)
FILTERED = "filtered."
OUTPUTS = ("moment", "moment_unfiltered", "motion", "wheel_load")
"""Compared outputs: moments after and before the filter and wheel loads, with errors over their largest change, and the
position of the reference point, with errors in m."""


@cache
def system_of(name: str, fidelity: Fidelity) -> System:
    """The car of a fidelity on the road of a manoeuvre."""
    model = kerb_test.build(fidelity) if name == "kerb_test" else prototype_car.build(fidelity=fidelity)
    return compile(model)


def manoeuvre_of(name: str) -> Manoeuvre:
    """A manoeuvre by name; the guided one has no inputs."""
    if name == "kerb_test":
        return Manoeuvre(name, np.zeros(0), {}, kerb_test.DURATION)
    return manoeuvres.load(name)


def run(name: str, fidelity: Fidelity, h: float, settings: Settings | None = None) -> Trajectory:
    """Simulate a manoeuvre; every step is recorded. `h`: step, s."""
    return manoeuvres.run_on(system_of(name, fidelity), manoeuvre_of(name), h, settings=settings)


def sampled(trajectory: Trajectory, h: float, *, stresses: bool = True) -> dict[str, NDArray[np.float64]]:
    """Signals at the times of a reference; if `stresses`, also moments, and moments filtered before sampling."""
    every, moments = round(INTERVAL / h), MOMENTS if stresses else ()
    values = {s: np.asarray(trajectory[s])[::every] for s in (*POSITION, *LOADS, *moments)}
    return values | {FILTERED + s: low_pass(trajectory[s], h, FREQUENCY)[::every] for s in moments}


def read_reference(name: str) -> dict[str, NDArray[np.float64]]:
    """Stored signals by name, with "time"."""
    return read_csv(FOLDER / f"{name}.csv")[1]


def peaks(trajectory: Trajectory, h: float) -> dict[str, float]:
    """Largest changes of the moments from the start over all steps, before and after the filter, N m."""
    changes = {}
    for s in MOMENTS:
        x = np.asarray(trajectory[s]) - trajectory[s][0]
        changes[s] = float(np.abs(x).max())
        changes[FILTERED + s] = float(np.abs(low_pass(x, h, FREQUENCY)).max())
    return changes


def read_peaks(name: str) -> dict[str, float]:
    """Stored peaks of a reference, N m, which its samples miss."""
    lines = (FOLDER / f"{name}_peaks.csv").read_text(encoding="utf-8").splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")][1:]
    return {signal: float(value) for signal, value in rows}


def errors(values: dict[str, NDArray[np.float64]], reference: dict[str, NDArray[np.float64]]) -> dict[str, float]:
    """Errors by `OUTPUTS`; errors of moments only if there are values."""

    results = {"motion": path_error(values, reference), "wheel_load": error_of_change(values, reference, LOADS)}
    if MOMENTS[0] not in values:
        return results
    return {
        "moment": error_of_change(values, reference, tuple(FILTERED + s for s in MOMENTS)),
        "moment_unfiltered": error_of_change(values, reference, MOMENTS),
        **results,
    }


def write_reference(name: str) -> str:
    """Run a manoeuvre, write its reference and return a line with its differences from coarser runs."""
    fine = run(name, Fidelity.MANY_MODES, STEP)
    values = sampled(fine, STEP)
    checks = {
        f"step {2 * STEP:g} s": sampled(run(name, Fidelity.MANY_MODES, 2 * STEP), 2 * STEP),
        "5 dynamic modes": sampled(run(name, Fidelity.DYNAMIC, STEP), STEP),
    }
    differences = []
    for label, values_of_check in checks.items():
        e = errors(values_of_check, values)
        differences.append(
            f"{label}: moments {e['moment']:.1e} after the low-pass and {e['moment_unfiltered']:.1e} before it, "
            f"place {e['motion']:.1e} m, wheel loads {e['wheel_load']:.1e}"
        )
    signals = (*POSITION, *LOADS, *MOMENTS, *(FILTERED + s for s in MOMENTS))
    lines = [
        f"# Prototype car, flexible chassis, {name.replace('_', ' ')}: this engine, 106 modes, steps of {STEP:g} s; "
        "made by python -m benchmarks.car fidelity-references",
        *(f"# differences with {text}" for text in differences),
    ]
    t = INTERVAL * np.arange(len(values[POSITION[0]]))
    write_csv(FOLDER / f"{name}.csv", lines, {"time": t} | {s: values[s] for s in signals}, 7)
    _write_peaks(name, peaks(fine, STEP))
    return f"{name}: " + "; ".join(differences)


def _write_peaks(name: str, peaks: dict[str, float]) -> None:
    lines = [
        f"# Largest changes from the start over all steps of {STEP:g} s of {name}.csv, whose samples miss them, N m",
        "signal,largest change",
        *(f"{signal},{value:.7g}" for signal, value in peaks.items()),
    ]
    write_text(FOLDER / f"{name}_peaks.csv", "\n".join(lines) + "\n")
