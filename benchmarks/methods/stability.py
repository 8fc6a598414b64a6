"""Classifies a run with a step and a penalty (or Baumgarte's factor) as fine, wrong, refused or diverged."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np

import mbs
from benchmarks.baselines.mechanism import Mechanism
from benchmarks.baselines.run import METHODS as CLASSICAL
from benchmarks.baselines.run import run
from benchmarks.methods.kernel_methods import TITLES, TREE_ONLY, suits
from benchmarks.methods.stability_margins import STEP_FACTORS, margin_table, margins
from benchmarks.references.cases import CASES, SAMPLES, exact_of, size_of, system_of
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table
from mbs.settings.settings import METHODS as KERNEL

STEPS = tuple(float(f"{digit}e{power}") for power in range(-6, 0) for digit in (1, 2, 5))[:-1]
EPS = 10.0 ** -np.arange(3.0, 12.0, 2.0)  # the kernel's penalty is alpha = 1/(eps h^2)
PENALTIES = (1e3, 1e5, 1e7, 1e9)  # mass-normalised, 1/s2
BAUMGARTE = (0.0, 10.0, 100.0, 1000.0)  # 1/s
MAX_CLASSICAL = 1000  # largest number of steps of a method in Python
CLASSICAL_WORK = 1.3e4  # largest product of steps and coordinates of a method in Python
MAX_ERROR = 0.05  # of the extent of the motion
MAX_ENERGY_ERROR = 0.05  # of the largest energy exchanged, for conservative scenes
OUTCOMES = ("fine", "wrong", "refused", "diverged")
SCENES = tuple(name for name in CASES if name not in ("pendulum_1000s", "four_bar_200"))
PARAMETER = {
    "index-1 Lagrange, Baumgarte": "Baumgarte factor, 1/s",
    "index-1 minimum norm, Baumgarte": "Baumgarte factor, 1/s",
    "velocity transformation": "none",
}


def intervals(scene: str, h: float) -> int | None:
    """Largest number of equal intervals between stored instants that are multiples of the step; None: there is none."""
    for count in (n for n in range(SAMPLES, 0, -1) if SAMPLES % n == 0):
        steps = CASES[scene].end / count / h
        if round(steps) >= 1 and abs(steps - round(steps)) < 1e-6 * steps:
            return count
    return None


def judge(scene: str, positions: np.ndarray, energy: np.ndarray) -> tuple[str, dict[str, Any]]:
    """Outcome and errors of a run.

    `positions`: positions of the output point at the start and at equal intervals, (n, k); `energy`: (n,), J.
    """
    case = CASES[scene]
    exact = exact_of(scene)[:: SAMPLES // (len(positions) - 1)]
    error = float(np.linalg.norm(positions - exact, axis=1).max())
    figures = {"error_share": error / size_of(scene), "energy_deviation_J": float(np.abs(energy - energy[0]).max())}
    if not np.isfinite(error):
        return "diverged", figures
    good = figures["error_share"] < MAX_ERROR
    if case.energy_stays:
        good = good and figures["energy_deviation_J"] < MAX_ENERGY_ERROR * _energy_scale(scene)
    return ("fine" if good else "wrong"), figures


@cache
def _energy_scale(scene: str) -> float:
    """Largest kinetic energy in a run with small steps, J."""
    system = system_of(scene)
    settings = mbs.Settings(max_halvings=16)  # the light cart needs them
    simulation, mass = mbs.Simulation(system, settings=settings), Mechanism(system).M
    largest, h = 0.0, CASES[scene].end / 5000.0
    for _ in range(200):
        qd = simulation.state.qd
        largest = max(largest, 0.5 * float(qd @ mass @ qd))
        simulation.step(h, n=25)
    return largest


def kernel_point(scene: str, method: str, h: float, eps: float | None) -> dict[str, Any]:
    """Row of a run of the kernel with a step, s; `eps` None: default settings."""
    case = CASES[scene]
    settings = mbs.Settings(method=method) if eps is None else mbs.Settings(method=method, alpha=1.0 / (eps * h * h))
    row = _row(scene, TITLES.get(method, method), h, "eps = 1/(alpha h^2)", eps)
    every, system = _every(scene, h), system_of(scene)
    try:
        t = mbs.simulate(system, case.end, h, settings=settings, every=every, progress=False, estimate_error=False)
    except mbs.SimulationError as error:
        return row | {"outcome": "refused", "reason": str(error), "stopped_at_s": error.time}
    outcome, figures = judge(scene, np.column_stack([t[s] for s in case.sensors]), t["energy.total"])
    assert t.report is not None
    return row | figures | {"outcome": outcome, "halvings": t.report.halvings}


def classical_point(scene: str, method: str, h: float, penalty: float | None) -> dict[str, Any]:
    """Row of a run of a classical method with a step, s; `penalty` None: default of the method."""
    case = CASES[scene]
    row = _row(scene, method, h, PARAMETER.get(method, "penalty, 1/s2"), penalty)
    r = run(system_of(scene), case.end, h, method, case.sensors, penalty=penalty, every=_every(scene, h))
    if r.status != "finished":
        return row | {"outcome": r.status, "reason": r.reason, "stopped_at_s": r.stopped_at}
    outcome, figures = judge(scene, r.positions, r.energy)
    return row | figures | {"outcome": outcome}


def _every(scene: str, h: float) -> int:
    count = intervals(scene, h)
    assert count is not None
    return round(CASES[scene].end / count / h)


def _row(scene: str, method: str, h: float, name: str, value: float | None) -> dict[str, Any]:
    return {
        "scene": scene,
        "method": method,
        "h_s": h,
        "parameter": name,
        "value": value,
        "outcome": "",
        "error_share": None,
        "energy_deviation_J": None,
        "stopped_at_s": None,
        "halvings": 0,
        "reason": "",
    }


def steps_of(scene: str, most: float) -> list[float]:
    """Steps of a map, s, with at most `most` steps in the whole motion."""
    steps = [STEP_FACTORS.get(scene, 1.0) * h for h in STEPS]
    return [h for h in steps if CASES[scene].end / h <= most * (1.0 + 1e-9) and intervals(scene, h) is not None]


def measure(scene: str, quick: bool) -> list[dict[str, Any]]:
    """Rows of all points of a scene; if `quick` of few."""
    case, system = CASES[scene], system_of(scene)
    steps = steps_of(scene, case.map_work / system.nq)
    classical = steps_of(scene, min(MAX_CLASSICAL, CLASSICAL_WORK / system.nq))
    eps, penalties, factors = EPS, PENALTIES, BAUMGARTE
    if quick:
        steps, classical, eps = steps[-6:-1:2], classical[1:3], EPS[1::2]
        penalties, factors = PENALTIES[2:3], BAUMGARTE[1:2]
    points: list[tuple[Callable[..., dict[str, Any]], str, float, float | None]] = []
    values: list[float | None]
    for method in KERNEL:
        if not suits(method, case.conservative, system):
            continue
        penalty_values = () if method in TREE_ONLY else map(float, eps)  # relative coordinates have no penalty
        values = [None, *penalty_values]
        points += [(kernel_point, method, h, e) for h in steps for e in values]
    for method in CLASSICAL if case.classical else ():
        values = list(penalties)
        if method in PARAMETER:
            values = [None] if PARAMETER[method] == "none" else list(factors)
        points += [(classical_point, method, h, v) for h in classical for v in values]
    return [point(scene, method, h, value) for point, method, h, value in watched(points)]


def explain(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Counts of outcomes by classical method and scene, with the first reason of each outcome."""
    lines = []
    for scene, method in dict.fromkeys((r["scene"], r["method"]) for r in rows if r["method"] in CLASSICAL):
        method_rows = [r for r in rows if (r["scene"], r["method"]) == (scene, method)]
        counts = {o: sum(r["outcome"] == o for r in method_rows) for o in OUTCOMES}
        first = []
        for outcome in ("refused", "diverged"):
            stopped = [r for r in method_rows if r["outcome"] == outcome and r["reason"]]
            if stopped:
                r = min(stopped, key=lambda row: row["stopped_at_s"])
                value = "" if r["value"] is None else f", {r['value']:g}"
                first.append(f"{outcome} at {r['stopped_at_s']:.4g} s (h = {r['h_s']:g}{value}): {r['reason']}")
        reason = "; ".join(first) or "-"
        lines.append({"scene": scene, "method": method} | counts | {"first stop": reason})
    return lines


def stability_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the margins of the default settings, and of the outcomes of the classical methods."""
    counts = dict.fromkeys(OUTCOMES, "d")
    return {
        "margins": margin_table(margins(rows)),
        "classical": table(explain(rows), {"scene": "", "method": ""} | counts | {"first stop": ""}),
    }
