"""Reference trajectories of cars: their computation and files, and errors against them."""

import numpy as np

from benchmarks.car import manoeuvres
from benchmarks.car.manoeuvres import Column
from benchmarks.shared.tables import read_csv, write_csv
from hosts.common.wheels import WHEELS
from mbs import Settings
from mbs.vehicle.levels.errors import LOADS, POSITION, load_error, path_error

STEP = 1e-4  # s
CHECKS = (1e-3, 5e-4, 2.5e-4)  # s, steps that show the order
TIGHT_SETTINGS = Settings(tolerance_r=1e-12)
SENSORS = (
    *POSITION,
    *(f"chassis.{name}" for name in ("yaw", "pitch", "roll", "vx", "vy", "wz", "ay")),
    "speed",
    *LOADS,
    *(f"wheel_{w}.travel" for w in WHEELS),
)


def referenced(car: str) -> list[str]:
    """Names of the manoeuvres with a reference of the car."""
    return [name for name in manoeuvres.NAMES if manoeuvres.reference_file(name, car).is_file()]


def read(name: str, car: str = manoeuvres.PROTOTYPE) -> tuple[Column, dict[str, Column], float]:
    """A stored reference.

    Returns
    -------
    t : ndarray of shape (n,)
        Times, s.
    values : dict of str to ndarray of shape (n,)
        Values by sensor, and for the replay of the double lane change by input.
    length : float
        Length of the path of the reference point, m.
    """
    head, values = read_csv(manoeuvres.reference_file(name, car))
    length = float(next(line for line in head if line.startswith("# path_length_m:")).partition(":")[2])
    return values.pop("time"), values, length


def write(name: str, car: str = manoeuvres.PROTOTYPE) -> str:
    """Simulate a manoeuvre with the small step, write its file and return a line about it.

    The double lane change is driven by the host's driver first, and its inputs are written too.
    """
    system, replayed = manoeuvres.system_of(name, car), name == manoeuvres.REPLAY
    interval = manoeuvres.sampling(manoeuvres.CLOSED_LOOP if replayed else name, car)
    manoeuvre = manoeuvres.record_driver(car) if replayed else manoeuvres.load(name, car)
    fine = manoeuvres.run_on(system, manoeuvre, STEP, settings=TIGHT_SETTINGS)
    every = round(interval / STEP)
    length = float(np.linalg.norm(np.diff([fine[s] for s in POSITION], axis=1), axis=0).sum())
    values = {s: fine[s][::every] for s in SENSORS}
    errors, loads = [], []
    for h in CHECKS:
        coarse = manoeuvres.run_on(system, manoeuvre, h, every=round(interval / h), settings=TIGHT_SETTINGS)
        errors.append(path_error(coarse, values))
        loads.append(load_error(coarse, values))
    order = np.log2(errors[0] / errors[1])
    own_error = errors[-1] / ((CHECKS[-1] / STEP) ** 2 - 1.0)
    report = fine.report
    assert report is not None
    lines = [
        f"# {car.capitalize()} car, {name.replace('_', ' ')}: this engine with steps of {STEP:g} s, tolerance_r = "
        f"{TIGHT_SETTINGS.tolerance_r:g}; made by python -m benchmarks.car references",
        f"# path_length_m: {length:.9g}",
        "# path error and relative wheel load error of larger steps: "
        + "; ".join(f"{h:g} s {e:.2e} m, {w:.1e}" for h, e, w in zip(CHECKS, errors, loads, strict=True)),
        f"# order in the step {order:.2f}; error of this path if it is 2: {own_error:.1e} m",
    ]
    inputs = manoeuvre.inputs if replayed else {}
    write_csv(manoeuvres.reference_file(name, car), lines, {"time": fine.t[::every]} | values | inputs, 8)
    return (
        f"{name:<26} path {length:8.3f} m, order {order:5.2f}, own error {own_error:.1e} m, "
        f"iterations {report.mean_iterations:.2f} (at most {report.max_iterations}), {report.halvings} halvings"
    )
