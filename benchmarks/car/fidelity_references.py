"""Writes the references of the fidelities: runs of the finest model with a small step."""

import numpy as np

from ali3.files import write_text
from benchmarks.car import fidelity_runs
from benchmarks.car.fidelity_runs import FILTERED, FOLDER, INTERVAL, LOADS, MOMENTS, POSITION
from benchmarks.shared.tables import write_csv
from mbs.vehicle import Fidelity

STEP = 5e-4  # s


def write(name: str) -> str:
    """Run a manoeuvre, write its reference and return a line with its differences from coarser runs."""
    fine = fidelity_runs.run(name, Fidelity.MANY_MODES, STEP)
    values = fidelity_runs.sampled(fine, STEP)
    checks = {
        f"step {2 * STEP:g} s": fidelity_runs.sampled(fidelity_runs.run(name, Fidelity.MANY_MODES, 2 * STEP), 2 * STEP),
        "5 dynamic modes": fidelity_runs.sampled(fidelity_runs.run(name, Fidelity.DYNAMIC, STEP), STEP),
    }
    differences = []
    for label, values_of_check in checks.items():
        e = fidelity_runs.errors(values_of_check, values)
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
    _write_peaks(name, fidelity_runs.peaks(fine, STEP))
    return f"{name}: " + "; ".join(differences)


def _write_peaks(name: str, peaks: dict[str, float]) -> None:
    lines = [
        f"# Largest changes from the start over all steps of {STEP:g} s of {name}.csv, whose samples miss them, N m",
        "signal,largest change",
        *(f"{signal},{value:.7g}" for signal, value in peaks.items()),
    ]
    write_text(FOLDER / f"{name}_peaks.csv", "\n".join(lines) + "\n")
