"""The key figures of a run."""

from collections.abc import Sequence

import numpy as np

from hosts.common.wheels import WHEELS
from hosts.driving.result import Result

# N: a wheel with a smaller load is in the air.
_LIFT_FORCE = 1.0
# Outputs of stored energy, and of the work since the start with labels of the table.
_STORED = ("energy.kinetic", "energy.gravity", "energy.elastic")
_WORKS = {
    "energy.drive": "drive",
    "energy.brakes": "brakes",
    "energy.tyres": "tyres",
    "energy.dampers": "dampers and stops",
    "energy.drag": "air",
    "energy.ground": "ground on the chassis",
}
# Works that not every car has.
_OTHER_WORKS = {
    "energy.steering": "steering",
    "energy.ports": "ports",
    "energy.road": "roads at ports",
    "energy.added": "added elements",
}
# Outputs that take about as long to compute as a step.
_READ_AT_COST = ("stress.", "bending_moment.")
_ERROR = "solver.energy_error"
# The error of the steps is reported with such a work from this share of it and from this energy, kJ, on; inputs that
# are held over a step cause most of it.
_REPORTED_SHARE = 0.01
_LEAST_ERROR = 1e-4


def summary(result: Result, step: float, course: Sequence[tuple[str, str]] = ()) -> list[tuple[str, str]]:
    """Rows of the summary table, labels and values, which are the same for the same run.

    Rows whose variables the FMU lacks are left out. `step`: communication step, s; `course`: rows of `course_result`,
    where a driver followed a course.
    """
    rows: list[tuple[str, str]] = []
    interval = float(result.time[1]) if len(result.time) > 1 else step
    if interval > 1.5 * step:
        rows.append((f"rows every {interval:g} s", "largest values and means are of these rows"))
    rows += [*_motion_rows(result), *_load_rows(result)]
    rows += course
    changing = [name for name in result.late if np.ptp(result[name]) > 0.0]
    if changing:
        rows.append(("inputs held over a step", f"{', '.join(changing)}: {500.0 * step:.3g} ms late on average"))
    rows += [*result.notes, *result.missed]
    rows += _solver_rows(result)
    if any(name.startswith(_READ_AT_COST) and result[name].any() for name in result.names):
        fewer = "" if interval > 1.5 * step else "; --interval reads fewer"
        rows.append(("stresses and moments", f"read every {1e3 * interval:g} ms{fewer}"))
    rows.append(("failed steps", f"{result.failed_steps} of {round(result.simulated / step) + result.failed_steps}"))
    return rows


def _motion_rows(result: Result) -> list[tuple[str, str]]:
    """Rows on distance, speed, accelerations and angles of the car."""
    rows: list[tuple[str, str]] = []
    if "chassis.x" in result and "chassis.y" in result:
        x, y = result["chassis.x"], result["chassis.y"]
        rows.append(("distance driven", f"{np.hypot(np.diff(x), np.diff(y)).sum():.2f} m"))
    if "speed" in result:
        v = result["speed"]
        rows.append(
            (
                "speed at start, top, end",
                f"{v[0]:.2f}, {v.max():.2f}, {v[-1]:.2f} m/s ({3.6 * v.max():.1f} km/h at most)",
            )
        )
    for name, label in (("ax", "longitudinal"), ("ay", "lateral"), ("az", "vertical")):
        if f"chassis.{name}" in result:
            a = result[f"chassis.{name}"]
            rows.append((f"{label} acceleration", f"{_signed(a.min())} to {_signed(a.max())} m/s²"))
    for name in ("roll", "pitch"):
        if f"chassis.{name}" in result:
            angle = np.degrees(result[f"chassis.{name}"])
            rows.append((name, f"{_signed(angle.min())} to {_signed(angle.max())} deg"))
            if name == "roll" and np.abs(angle).max() > 90.0:
                rows.append(("rolled over", f"at {result.time[int(np.argmax(np.abs(angle) > 90.0))]:.2f} s"))
    return rows


def _load_rows(result: Result) -> list[tuple[str, str]]:
    """Rows on the loads of the wheels."""
    loads = {w: result[f"wheel_{w}.Fz"] for w in WHEELS if f"wheel_{w}.Fz" in result}
    if not loads:
        return []
    largest = max(loads, key=lambda w: float(loads[w].max()))
    at = result.time[int(loads[largest].argmax())]
    durations = 1e3 * np.diff(result.time)
    lift = "  ".join(f"{w} {durations[f[1:] < _LIFT_FORCE].sum():.0f}" for w, f in loads.items())
    return [
        ("largest wheel load", f"{loads[largest].max():.0f} N ({largest}, at {at:.2f} s)"),
        ("wheels in the air", f"{lift}  ms"),
    ]


def _solver_rows(result: Result) -> list[tuple[str, str]]:
    """Rows on iterations, halvings and steps at the limit of iterations."""
    rows: list[tuple[str, str]] = []
    if "solver.iterations" in result and len(result.time) > 1:
        n = result["solver.iterations"][1:]
        rows.append(("Newton iterations", f"{n.mean():.2f} a step, {n.max():.0f} at most"))
    if "solver.halvings" in result:
        rows.append(("steps repeated in halves", f"{result['solver.halvings'][-1]:.0f}"))
    if "solver.capped_steps" in result and result["solver.capped_steps"][-1] > 0:
        residual = 1e3 * result["solver.capped_residual"].max() if "solver.capped_residual" in result else float("nan")
        count = f"{result['solver.capped_steps'][-1]:.0f}"
        rows.append(("steps ended at the limit of iterations", f"{count}, off by at most {residual:.2g} mm"))
    return rows


def pace(result: Result, step: float) -> tuple[str, str]:
    """The speed of this machine as a row of the printed summary; the picture has none. `step`: as for `summary`."""
    factor = result.simulated / result.wall if result.wall > 0.0 else float("inf")
    took = f"{result.simulated:.2f} s simulated in {result.wall:.3f} s, step {1e3 * step:g} ms"
    return "real-time factor", f"{factor:.1f} ({took})"


def energy_balance(result: Result) -> list[tuple[str, str]]:
    """Rows of the energy balance of a drive, kJ: the change of the energy and the works that sum up to it.

    Empty if the FMU lacks one of the outputs. The rest has no output of its own: the damping of a flexible structure,
    in an FMU without `energy.steering` the work of the steering, and errors that `solver.energy_error` lacks.
    """
    if any(name not in result for name in (*_STORED, *_WORKS, _ERROR)):
        return []

    def change(name: str) -> float:
        return float(result[name][-1] - result[name][0])

    work_names = _WORKS | {name: what for name, what in _OTHER_WORKS.items() if name in result}
    rest_label = "- structure, rest" if "energy.steering" in result else "- steering, structure, rest"
    stored, works, error = sum(map(change, _STORED)), {n: change(n) for n in work_names}, change(_ERROR)
    terms = {"change of the energy": stored} | {f"- work of {work_names[n]}": w for n, w in works.items()}
    terms |= {rest_label: stored - sum(works.values()) - error, "- error of the steps": error}
    rows = {what: f"{round(1e-3 * energy, 4) + 0.0:+.4f} kJ" for what, energy in terms.items()}
    for name in [n for n in _OTHER_WORKS if n in result]:
        largest = float(np.abs(result[name] - result[name][0]).max())
        if (
            abs(error) > max(_REPORTED_SHARE * largest, 1e3 * _LEAST_ERROR)
            and largest > 1e3 * _LEAST_ERROR / _REPORTED_SHARE
        ):
            rows[f"- work of {work_names[name]}"] += (
                f"; the error of the steps is {abs(error) / largest:.1%} of its largest: shorter steps make it smaller"
            )
    return list(rows.items())


def _signed(value: float) -> str:
    return f"{round(float(value), 2) + 0.0:+.2f}"
