"""Scenes with dissipation or flexible bodies, which have no exact motion: each with an error and its limit."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.car import fidelity_runs
from benchmarks.methods.kernel_methods import CONSERVATIVE_ONLY, KERNEL, TITLES, TREE_ONLY
from benchmarks.paper.assembly_defect import STEP
from benchmarks.references.assembly_defect import COMPONENTS, reference
from benchmarks.shared.pages import Row, table
from mbs.scenes import assembly_defect_four_bar, prototype_car, spinning_beam
from mbs.vehicle.environment import GRAVITY

METHODS = [method for method in KERNEL if method not in (*CONSERVATIVE_ONLY, *TREE_ONLY)]
QUICK = ("spinning_beam", "car_at_rest_100s")
SPIN_UP = Path(__file__).parents[2] / "tests" / "data" / "reference" / "spin_up_beam.csv"
CaseRun = tuple[float, mbs.Trajectory]
"""Error of a run in the quantity of its scene, and the run."""


@dataclass(frozen=True)
class Scene:
    """A run, its error, and the error from which it counts as wrong."""

    quantity: str
    """Compared quantity, and its unit or scale."""
    run: Callable[[mbs.Settings, float], CaseRun]
    """Returns error and trajectory for settings and a step, s."""
    limit: float
    """Error from which a run is wrong: 5 % of what an engineer reads, or 1e-3 of what must not move."""
    steps: tuple[float, ...]
    """Steps, s."""


@cache
def _system(name: str) -> mbs.System:
    builders = {
        "car": prototype_car.build,
        "beam": spinning_beam.build,
        "four-bar": lambda: assembly_defect_four_bar.build(parts=4, elements=2, dynamic_modes=0),
    }
    return mbs.compile(builders[name]())


def _run(
    name: str, end: float, h: float, settings: mbs.Settings, interval: float, inputs: dict[str, Any] | None = None
) -> mbs.Trajectory:
    """Simulate one of the systems, recorded at an interval, s, or at each step if that is longer."""
    every = max(1, round(interval / h))
    return mbs.simulate(_system(name), end, h, inputs, settings, every=every, progress=False, estimate_error=False)


def run_beam(settings: mbs.Settings, h: float) -> CaseRun:
    """Error of the tip deflection against geometrically exact beams, of the largest deflection. `h`: step, s."""
    t = _run("beam", spinning_beam.DURATION, h, settings, 0.02)
    time_ref, _, expected = np.loadtxt(SPIN_UP, delimiter=",", skiprows=2).T
    _, result = spinning_beam.extension_and_deflection(t.t, t["tip.x"], t["tip.y"])
    return float(np.abs(np.interp(time_ref, t.t, result) - expected).max() / np.abs(expected).max()), t


def run_four_bar(settings: mbs.Settings, h: float) -> CaseRun:
    """Error of the moments in the coupler against geometrically exact beams, of the largest moment."""
    t = _run("four-bar", assembly_defect_four_bar.DURATION, h, settings, STEP)
    expected = reference()
    gap = max(np.abs(t[f"coupler.{c}"] - expected[c]).max() for c in COMPONENTS)
    return float(gap / max(np.abs(expected[c]).max() for c in COMPONENTS)), t


def stand_braked(settings: mbs.Settings, h: float) -> CaseRun:
    """Largest displacement of the braked car in 100 s, m."""
    t = _run("car", 100.0, h, settings, 0.1, {"brake": 1.0})
    position = np.array([t[f"chassis.{c}"] for c in "xyz"])
    return float(np.linalg.norm(position - position[:, :1], axis=0).max()), t


def run_kerb(settings: mbs.Settings, h: float) -> CaseRun:
    """Error of the filtered moments of the flexible frame against steps of 0.5 ms, of their largest change."""
    t = fidelity_runs.run("kerb_test", 3, h, settings)
    return fidelity_runs.errors(fidelity_runs.sampled(t, h), fidelity_runs.read_reference("kerb_test"))["moment"], t


def drive_bends(settings: mbs.Settings, h: float) -> CaseRun:
    """Error of the mean wheel loads over 1000 s of wide bends under power, of the weight."""
    times = np.arange(0.0, 1001.0, 1.0)
    inputs = {"throttle": 0.2, "steering": (times, 0.02 * np.sin(2.0 * np.pi * times / 40.0))}
    t = _run("car", 1000.0, h, settings, 0.1, inputs)
    loads = sum(np.asarray(t[f"wheel_{w}.Fz"]) for w in ("FL", "FR", "RL", "RR"))
    return float(abs(np.mean(loads) / (prototype_car.car().vehicle.mass * GRAVITY) - 1.0)), t


SCENES = {
    "spinning_beam": Scene("deflection, of the largest", run_beam, 0.05, (0.02, 0.01, 0.005)),
    "assembly_defect_four_bar": Scene("moment, of the largest", run_four_bar, 0.05, (0.01, 0.005, 0.002)),
    "car_at_rest_100s": Scene("way, m", stand_braked, 1e-3, (0.05, 0.02, 0.01, 0.005)),
    "flexible_car_over_the_kerb": Scene("moment, of the largest change", run_kerb, 0.05, (0.01, 0.005, 0.002)),
    "car_drives_1000s": Scene("mean load, of the weight", drive_bends, 1e-3, (0.02, 0.01)),
}


def measure(name: str, method: str, h: float) -> dict[str, Any]:
    """Row of a run: outcome, error and work. `h`: step, s."""
    scene = SCENES[name]
    row: dict[str, Any] = {"scene": name, "method": TITLES.get(method, method), "h_s": h, "quantity": scene.quantity}
    row |= {"outcome": "refused", "limit": scene.limit, "reason": ""}
    row |= dict.fromkeys(("error", "iterations", "halvings", "violation_m", "wall_s"))
    begin = time.perf_counter()
    try:
        error, t = scene.run(mbs.Settings(method=method), h)
    except mbs.SimulationError as stopped:
        return row | {"reason": str(stopped), "wall_s": time.perf_counter() - begin}
    assert t.report is not None
    return row | {
        "outcome": "fine" if error < scene.limit else "wrong",
        "error": error,
        "iterations": t.report.mean_iterations,
        "halvings": t.report.halvings,
        "violation_m": t.report.violation,
        "wall_s": t.wall_s,
    }


def dissipative_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table with a line for each scene and method."""
    lines = []
    for scene, method in dict.fromkeys((r["scene"], r["method"]) for r in rows):
        scene_rows = [r for r in rows if (r["scene"], r["method"]) == (scene, method)]
        line = {
            "scene": scene,
            "method": method,
            "error": scene_rows[0]["quantity"],
            "wrong from": f"{scene_rows[0]['limit']:g}",
        }
        for r in sorted(scene_rows, key=lambda r: -r["h_s"]):
            cell_text = r["outcome"] if r["error"] is None else f"{r['outcome']}, {r['error']:.1e}"
            line["by step, s"] = "; ".join(filter(None, (line.get("by step, s"), f"{r['h_s']:g}: {cell_text}")))
        line["first stop"] = next((r["reason"].partition(". Worst")[0] for r in scene_rows if r["reason"]), "-")
        lines.append(line)
    return {"dissipative": table(lines, dict.fromkeys(lines[0], ""))}
