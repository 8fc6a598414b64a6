"""Error over computing time of every method for a range of steps and tolerances, beside other engines."""

import statistics
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks import peers
from benchmarks.baselines.run import METHODS as CLASSICAL
from benchmarks.baselines.run import run
from benchmarks.methods.kernel_methods import TITLES, all_settings, controlled, suits
from benchmarks.references.cases import CASES, SAMPLES, SHARED, exact_of, system_of
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table
from mbs.kernel.binding import KernelError
from mbs.settings.input_signals import InputSignals
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.controlled_run import ControlledRun, StalledError, Task

REPEATS = 7
FEW_REPEATS = 2
LONG = 0.5  # wall time in s beyond which a run is repeated less often
VERY_LONG = 5.0  # wall time in s beyond which it is not repeated
SCIPY = {"method": "index-1 minimum norm, Baumgarte", "solver": "DOP853"}
SCIPY_TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9)
CLASSICAL_STEPS = 4000  # a slow method in Python is not run longer
LEVELS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # of position error, m
QUICK_DIVISIONS = 2
CONTROLLED = ("ali3p", "energy_momentum", "runge_kutta_8", "semi_recursive", "semi_recursive_4", "radau_5")
CONTROLLED_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8)
ORDER_TWO_LIMIT = 1e-5  # smallest tolerance of methods of order two
Action = Callable[[], tuple[float, dict[str, Any]]]
"""Makes a run; returns its wall time, s, and fields of its row."""


def kernel_action(scene: str, settings: mbs.Settings, h: float) -> Action:
    """A run of the kernel with steps of `h`, s; only the steps count in the wall time."""
    case, system = CASES[scene], system_of(scene)
    every = round(case.end / SAMPLES / h)

    def act() -> tuple[float, dict[str, Any]]:
        try:
            t = mbs.simulate(system, case.end, h, settings=settings, every=every, progress=False, estimate_error=False)
        except mbs.SimulationError as error:
            return 0.0, {"ended": f"refused at {error.time:.4g} s"}
        report = t.report
        assert report is not None
        return t.wall_s, {
            "ended": "finished",
            "position_error_m": _error(np.column_stack([t[s] for s in case.sensors]), scene),
            "factorizations": report.factorizations,
        }

    return act


def controlled_action(scene: str, method: str, tolerance: float) -> Action:
    """A run with error control, without the runs by which `simulate` estimates the error."""
    case, system = CASES[scene], system_of(scene)
    task = Task(0.0, case.end, np.linspace(0.0, case.end, SAMPLES + 1)[1:], InputSignals({}, []))
    columns = [[s["name"] for s in system.meta["sensors"]].index(name) for name in case.sensors]

    def act() -> tuple[float, dict[str, Any]]:
        settings = mbs.Settings(method=method)
        run = ControlledRun(mbs.Simulation(system, settings=settings), task, settings, tolerance)
        try:
            run.finish(lambda share: None)
        except (KernelError, StalledError):
            return 0.0, {"ended": f"refused at {run.simulation.time:.4g} s"}
        report = run.simulation.report
        error = float(np.linalg.norm(run.values[:, columns] - exact_of(scene)[1:], axis=1).max())
        return run.wall, {"ended": "finished", "position_error_m": error, "factorizations": report.factorizations}

    return act


def classical_action(scene: str, method: str, h: float, solver: str = "RK4", rtol: float = 1e-8) -> Action:
    """A run of a method in Python, by the Runge-Kutta method with a fixed step, s, or by a solver of SciPy."""
    case, system = CASES[scene], system_of(scene)

    def act() -> tuple[float, dict[str, Any]]:
        every = round(case.end / SAMPLES / h)
        r = run(system, case.end, h, method, case.sensors, every=every, solver=solver, rtol=rtol)
        if r.status != "finished":
            return 0.0, {"ended": f"{r.status} at {r.stopped_at:.4g} s: {r.reason}"}
        return r.wall_s, {
            "ended": "finished",
            "position_error_m": _error(r.positions, scene),
            "factorizations": r.factorizations,
        }

    return act


def peer_action(scene: str, engine: Any, integrator: str, h: float) -> Action:
    """A run of another engine with steps of `h`, s."""

    def act() -> tuple[float, dict[str, Any]]:
        r = engine.run(scene, h, CASES[scene].end, SAMPLES, integrator)
        if not r.finished:
            return 0.0, {"ended": f"gave up at {r.t[-1]:.4g} s"}
        return r.wall_s, {"ended": "finished", "position_error_m": _error(r.positions, scene)}

    return act


def _error(positions: np.ndarray, scene: str) -> float:
    return float(np.linalg.norm(positions - exact_of(scene), axis=1).max())


def plan(scene: str, quick: bool, engines: dict[str, Any]) -> list[tuple[dict[str, Any], Action]]:
    """Rows without results, each with the action that measures it."""
    case = CASES[scene]
    divisions = case.divisions[3 : 3 + QUICK_DIVISIONS] if quick else case.divisions
    system = system_of(scene)
    actions: list[tuple[dict[str, Any], Action]] = []

    def add(family: str, method: str, h: float | None, action: Action, rtol: float | None = None) -> None:
        row = {"scene": scene, "family": family, "method": method, "h_s": h, "rtol": rtol, "position_error_m": None}
        empty = dict.fromkeys(("wall_s", "factorizations"))
        actions.append((row | empty | {"ended": ""}, action))

    for d in divisions:
        h = case.end / (SAMPLES * d)
        for title, settings in all_settings(case.conservative, system).items():
            add("kernel", title, h, kernel_action(scene, settings, h))
        if case.classical and SAMPLES * d <= CLASSICAL_STEPS:
            for method in CLASSICAL:
                add("classical", method, h, classical_action(scene, method, h))
        if scene in SHARED:
            for name, engine in engines.items():
                for integrator in engine.integrators(scene):
                    add(name, f"{name}, {integrator}", h, peer_action(scene, engine, integrator, h))
    for method in (m for m in CONTROLLED if suits(m, case.conservative, system)):
        for tolerance in CONTROLLED_TOLERANCES[1 : 1 + QUICK_DIVISIONS] if quick else CONTROLLED_TOLERANCES:
            if METHOD_TABLE[method].order_of_changing_steps > 2 or tolerance >= ORDER_TWO_LIMIT:
                add("kernel", controlled(TITLES[method]), None, controlled_action(scene, method, tolerance), tolerance)
    for rtol in SCIPY_TOLERANCES[: 1 if quick else None] if case.classical else ():
        action = classical_action(scene, SCIPY["method"], case.end / SAMPLES, SCIPY["solver"], rtol)
        add("classical", f"index-1 minimum norm, scipy {SCIPY['solver']}", None, action, rtol)
    return actions


def measure(scene: str, quick: bool, engines: dict[str, Any], repeats: int) -> list[dict[str, Any]]:
    """Rows of a scene; times are medians over repeats through all rows, so that disturbances affect all of them."""
    actions = plan(scene, quick, engines)
    for row, action in watched(actions):
        wall, result = action()
        row |= result
        row["wall_s"] = wall if result["ended"] == "finished" else None
    walls: list[list[float]] = [[] for _ in actions]
    for turn in watched(range(repeats)):
        for k, (row, action) in enumerate(actions):
            wall = row["wall_s"]
            if wall is not None and (wall < LONG or (turn < FEW_REPEATS and wall < VERY_LONG)):
                walls[k].append(action()[0])
    for (row, _), times in zip(actions, walls, strict=True):
        if times:
            row["wall_s"] = statistics.median(times)
    return [row for row, _ in actions]


def time_at_error(rows: Sequence[Row], method: str, level: float) -> float | None:
    """Least wall time of a method, s, for an error `level`, by interpolation along its curve (log-log); None: not
    reached.

    All finished runs with smaller steps must reach the level too. A run below the level counts with its own time: the
    curve is not extrapolated.
    """
    results = [r for r in rows if r["method"] == method and None not in (r["wall_s"], r["position_error_m"])]
    results.sort(key=lambda r: r["h_s"] if r["h_s"] is not None else r["rtol"], reverse=True)
    points = [(r["wall_s"], r["position_error_m"]) for r in results]
    first = next((k + 1 for k in reversed(range(len(points))) if points[k][1] > level), 0)
    if first == len(points):
        return None
    best = min(wall for wall, _ in points[first:])
    if first and points[first][1] > 0.0:
        (w0, e0), (w1, e1) = points[first - 1 : first + 1]
        share = np.log(e0 / level) / np.log(e0 / e1)
        best = min(best, float(np.exp(np.log(w0) + share * np.log(w1 / w0))))
    return float(best)


def compare(rows: Sequence[Row], scene: str) -> list[dict[str, Any]]:
    """Rows of the best time of the kernel relative to the best peer, by level of error."""
    part = [r for r in rows if r["scene"] == scene]
    lines = []
    for level in LEVELS:
        best: dict[bool, tuple[float, str] | None] = {True: None, False: None}
        for ours, families in ((True, ("kernel",)), (False, tuple(peers.NAMES))):
            for method in dict.fromkeys(r["method"] for r in part if r["family"] in families):
                wall = time_at_error(part, method, level)
                result = best[ours]
                if wall is not None and (result is None or wall < result[0]):
                    best[ours] = (wall, method)
        own, peer = best[True], best[False]
        ratio = own[0] / peer[0] if own and peer else None
        lines.append(
            {
                "scene": scene,
                "error_m": level,
                "ours": own[1] if own else "not reached",
                "ours_ms": 1e3 * own[0] if own else None,
                "peer": peer[1] if peer else "not reached",
                "peer_ms": 1e3 * peer[0] if peer else None,
                "ratio": ratio,
                "ahead": "-" if not (own or peer) else "yes" if own and (ratio is None or ratio < 1.0) else "NO",
            }
        )
    return lines


def work_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the comparison with peers, and of the time of each method by error."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    ratios = [line for s in scenes for line in compare(rows, s) if line["peer_ms"] is not None]
    columns = {
        "scene": "",
        "error_m": ".0e",
        "ours": "",
        "ours_ms": ".3g",
        "peer": "",
        "peer_ms": ".3g",
        "ratio": ".2g",
    }
    behind = [r for r in ratios if r["ahead"] == "NO"]
    half = [r for r in ratios if r["ratio"] is not None and 0.5 < r["ratio"] <= 1.0]
    verdict = f"Behind the best peer in {len(behind)} of {len(ratios)} lines"
    verdict += ": " + "; ".join(f"{r['scene']} at {r['error_m']:.0e} m" for r in behind) + "." if behind else "."
    verdict += f" Ahead, but by less than a factor of two, in {len(half)}."
    times = []
    for scene in scenes:
        part = [r for r in rows if r["scene"] == scene]
        for method in dict.fromkeys(r["method"] for r in part):
            line: dict[str, Any] = {"scene": scene, "method": method}
            line |= {f"{level:.0e} m": _ms(time_at_error(part, method, level)) for level in LEVELS}
            runs = [r for r in part if r["method"] == method]
            line["finished"] = f"{sum(r['ended'] == 'finished' for r in runs)} of {len(runs)}"
            times.append(line)
    columns_2 = {"scene": "", "method": ""} | {f"{level:.0e} m": ".3g" for level in LEVELS} | {"finished": ""}
    ratio_table = table(ratios, columns | {"ahead": ""}) + "\n\n" + verdict
    return {"ratios": ratio_table, "times": table(times, columns_2)}


def _ms(wall: float | None) -> float | None:
    return None if wall is None else 1e3 * wall
