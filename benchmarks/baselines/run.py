"""Run a classical method on a System with a fixed step, or by one of SciPy's integrators."""

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

DIVERGED = 1e6  # m, m/s: above this the motion counts as diverged
Method = Callable[..., Any]
METHODS: dict[str, Method] = {
    "index-1 augmented Lagrangian, projected": lambda m, **k: Penalty(m, augmented=True, **k),
    "index-1 Lagrange, Baumgarte": lambda m, **k: Lagrange(m, **k),
    "index-1 minimum norm, Baumgarte": lambda m, **k: Lagrange(m, minimum_norm=True, **k),
    "velocity transformation": lambda m, **k: VelocityTransformation(m, **k),
    "penalty": lambda m, **k: Penalty(m, **k),
}
"""Methods by name; `penalty`: mass-normalised penalty, 1/s^2, or for the Lagrange forms Baumgarte's factor, 1/s."""


@dataclass(frozen=True)
class Run:
    """Result of a run: position sensors (n, k), m, and energies (n,), J, at times t (n,), s, and its end.

    `status`: "finished", "refused" or "diverged"; `reason`: one line; `stopped_at`: s.
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
    """Run a method.

    Parameters
    ----------
    t_end, h : float
        End and step, s; with a SciPy solver h is the interval between results.
    method : str
        One of `METHODS`.
    sensors : sequence of str
        Position sensors to record.
    penalty : float, optional
        By default the penalty of the method.
    every : int
        Number of steps from one recorded instant to the next.
    solver : str
        "RK4" with the fixed step, or a method of `scipy.integrate.solve_ivp`.
    rtol : float
        Relative tolerance of a SciPy solver; the absolute tolerance is a hundredth of it.
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
            _integrate(method_instance, mechanism.start, t_end, h, every, solver, rtol, times, states)
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


def _integrate(
    method: Any, start: Array, t_end: float, h: float, every: int, solver: Any, rtol: float,
    times: list[float], states: list[Array],
) -> None:  # fmt: skip
    """Append times, s, and states of each recorded instant. Raises `RefusedError` if the motion cannot go on."""
    if solver == "RK4":
        for k, x in _runge_kutta(method, start, h, round(t_end / h)):
            if k % every == 0:
                times.append(k * h)
                states.append(x)
    else:
        t_eval = h * every * np.arange(1, round(t_end / h) // every + 1)
        solution = solve_ivp(
            method.rates,
            (0.0, t_end),
            start,
            method=solver,
            t_eval=t_eval,
            rtol=rtol,
            atol=0.01 * rtol,
        )
        times += solution.t.tolist()
        states += list(solution.y.T)
        if not solution.success:
            raise RefusedError(f"scipy's {solver} gave up: {solution.message}", float(times[-1]))


def _runge_kutta(method: Any, x: Array, h: float, steps: int) -> Any:
    """Classical Runge-Kutta method of order four; yields the number of each step and its state."""
    project = getattr(method, "project", None)
    for k in range(steps):
        t = k * h
        k1 = method.rates(t, x)
        k2 = method.rates(t + 0.5 * h, x + 0.5 * h * k1)
        k3 = method.rates(t + 0.5 * h, x + 0.5 * h * k2)
        k4 = method.rates(t + h, x + h * k3)
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if not np.abs(x).max() < DIVERGED:
            raise RefusedError("the motion became infinite (or faster than 1e6 m/s)", t + h)
        if project is not None:
            x = project(t + h, x)
        yield k + 1, x
