"""Run a classical method over a System at a fixed step, or under one of scipy's integrators."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import mbs
from benchmarks.baselines.lagrange import Lagrange
from benchmarks.baselines.mechanism import Array, Mechanism, RefusedError
from benchmarks.baselines.penalty import Penalty
from benchmarks.baselines.velocity_transformation import VelocityTransformation

FAR = 1e6  # m, m/s: beyond it the motion counts as diverged
Method = Callable[..., Any]
METHODS: dict[str, Method] = {
    "index-1 augmented Lagrangian, projected": lambda m, **k: Penalty(m, augmented=True, **k),
    "index-1 Lagrange, Baumgarte": lambda m, **k: Lagrange(m, **k),
    "index-1 minimum norm, Baumgarte": lambda m, **k: Lagrange(m, minimum_norm=True, **k),
    "velocity transformation": lambda m, **k: VelocityTransformation(m, **k),
    "penalty": lambda m, **k: Penalty(m, **k),
}
"""By name; `penalty` is a mass-normalised penalty, 1/s, or for the Lagrange forms Baumgarte's factor, 1/s."""


@dataclass(frozen=True)
class Run:
    """Results of a run: position sensors (n, k) and energies (n,) at times t (n,), and how it ended.

    `status` is "finished", "refused" or "diverged"; `reason` one line; counts of evaluations and factorizations.
    """

    t: Array
    positions: Array
    energy: Array
    status: str
    reason: str
    stopped_at: float | None
    evaluations: int
    factorizations: int
    steps: int
    wall_s: float


def run(
    system: mbs.System,
    t_end: float,
    h: float,
    method: str,
    sensors: Sequence[str],
    *,
    penalty: float | None = None,
    every: int = 1,
    solver: str = "RK4",
    rtol: float = 1e-8,
) -> Run:
    """Run one method.

    Parameters
    ----------
    t_end, h : float
        End and step, s; under a scipy solver h is the distance of results.
    method : str
        One of `METHODS`.
    sensors : sequence of str
        Position sensors to report.
    penalty : float, optional
        By default the method's own.
    every : int
        Report each so many steps.
    solver : str
        "RK4" with the fixed step, or a name that `scipy.integrate.solve_ivp` knows.
    rtol : float
        Tolerance of a scipy solver, relative; absolute a hundredth of it.
    """
    mechanism = Mechanism(system)
    options = {} if penalty is None else {"penalty": penalty}
    times, states = [0.0], [mechanism.start]
    status, reason, stop_time = "finished", "", None
    steps = round(t_end / h)
    begin = time.perf_counter()
    try:
        with np.errstate(all="ignore"):
            method_instance = METHODS[method](mechanism, **options)
            mechanism.evaluations = mechanism.factorizations = 0
            if solver == "RK4":
                for k, x in _runge_kutta(method_instance, mechanism.start, h, steps):
                    if k % every == 0:
                        times.append(k * h)
                        states.append(x)
            else:
                t_eval = h * every * np.arange(1, steps // every + 1)
                solution = solve_ivp(
                    method_instance.rates,
                    (0.0, t_end),
                    mechanism.start,
                    method=solver,
                    t_eval=t_eval,
                    rtol=rtol,
                    atol=0.01 * rtol,
                )
                times += solution.t.tolist()
                states += list(solution.y.T)
                if not solution.success:
                    raise RefusedError(f"scipy's {solver} gave up: {solution.message}", float(times[-1]))
    except RefusedError as refusal:
        status = "diverged" if "infinite" in str(refusal) else "refused"
        reason, stop_time = str(refusal), refusal.time
    wall_time = time.perf_counter() - begin
    counts = mechanism.evaluations, mechanism.factorizations
    x = np.array(states)
    n = mechanism.nq
    energy = np.array([mechanism.energy(s[:n], s[n:]) for s in states])
    return Run(
        np.array(times),
        mechanism.positions(x[:, :n], sensors),
        energy,
        status,
        reason,
        stop_time,
        *counts,
        steps,
        wall_time,
    )


def _runge_kutta(method: Any, x: Array, h: float, steps: int) -> Any:
    """Classical order four; yields (step, state)."""
    settle = getattr(method, "settle", None)
    for k in range(steps):
        t = k * h
        k1 = method.rates(t, x)
        k2 = method.rates(t + 0.5 * h, x + 0.5 * h * k1)
        k3 = method.rates(t + 0.5 * h, x + 0.5 * h * k2)
        k4 = method.rates(t + h, x + h * k3)
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if not np.abs(x).max() < FAR:
            raise RefusedError("the motion became infinite (or faster than 1e6 m/s)", t + h)
        if settle is not None:
            x = settle(t + h, x)
        yield k + 1, x
