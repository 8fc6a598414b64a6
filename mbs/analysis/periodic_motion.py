"""Floquet multipliers of a periodic motion: growth of small disturbances over one period.

The monodromy matrix maps admissible displacements and velocities (z, w) of `mbs.linearise` over one period; its
columns are central differences of whole runs. One more pair of runs with half the step, disturbed along the sum of all
columns, estimates the error. A motion is stable where no multiplier lies outside the unit circle
(A. H. Nayfeh, B. Balachandran, Applied Nonlinear Dynamics, 1995, section 3.2).
"""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.analysis.linear_model import admissible_motions
from mbs.common.checks import instance_of, is_finite, shown
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.accuracy import Accuracy, AccuracyWarning, needed_step
from mbs.results.comparison import instants
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.arguments import check_resolution
from mbs.simulation.evaluator import Evaluator
from mbs.simulation.large_bending import BendingWatch
from mbs.simulation.stepping import Simulation

Array = NDArray[np.float64]

MAX_STEPS = 1e8  # largest number of steps of a period
DISTURBANCE = 1e-4  # largest change of a point or unit axis, m; of a velocity the same divided by the period
CLOSED = 1e-4  # largest distance of the state after a period, relative to the size and the speed of the motion


@dataclass(frozen=True)
class FloquetModel:
    """Disturbances of a periodic motion after one period."""

    period: float
    """s."""
    monodromy: Array
    """Shape (n, n): map of the admissible displacements and velocities over one period."""
    multipliers: NDArray[np.complex128]
    """Shape (n,): its eigenvalues, by falling modulus."""

    @property
    def exponents(self) -> NDArray[np.complex128]:
        """``log(multiplier) / period``, 1/s; imaginary parts are known up to multiples of 2 pi / period."""
        return np.asarray(np.log(self.multipliers) / self.period, complex)


def floquet(simulation: Simulation, period: float, h: float) -> FloquetModel:
    """Floquet multipliers of the periodic motion through the present state, which stays as it is.

    Parameters
    ----------
    simulation : Simulation
        Its method and settings make the runs; one of high order, such as "radau_5", needs the fewest steps.
    period : float
        s; the motion must come back to the state after it.
    h : float
        Step, s; the runs make whole steps next to it.

    Returns
    -------
    FloquetModel
        Multipliers and the monodromy matrix.

    Raises
    ------
    ValueError
        If the motion does not come back after the period, or force elements have states of their own.
    SimulationError
        If a step fails.

    Warns
    -----
    AccuracyWarning
        Runs with half the step show that disturbances after a period are wrong by more than 5 %.
    BendingWarning
        A flexible body carries axial forces during the period, or bends, so far that its frequencies are off.
    """
    instance_of(Simulation, simulation, "What floquet takes", "a Simulation")
    is_valid = is_finite(period) and is_finite(h) and 0.0 < h <= period
    if not is_valid:
        raise ValueError(
            f"The period is {shown(period)} s and the step {shown(h)} s; both must be positive, h at most the period."
        )
    check_resolution(simulation.time + period, h)
    if period / h > MAX_STEPS:
        raise ValueError(f"The period of {period:g} s has {period / h:.3g} steps of {h:g} s; at most {MAX_STEPS:g}.")
    evaluator = Evaluator(simulation)
    state = evaluator.state
    if evaluator.slots:
        raise ValueError(
            "Floquet multipliers need force elements without states; tyres, brakes and contacts have some."
        )
    M = evaluator.mass()
    V, _, P = admissible_motions(M, evaluator.jacobian(state.q), simulation.system)
    steps = max(1, round(period / h))
    _check_closed(simulation, evaluator, _reference_period(simulation, evaluator, period, steps), period)

    def run_period(q: Array, qd: Array, n: int) -> tuple[Array, Array]:
        run = _copy_at(simulation, q, qd)
        run.step(period / n, n=n)
        return run.state.q, run.state.qd

    def disturbed(dq: Array, dqd: Array, n: int) -> tuple[Array, Array]:
        """Disturbance (z, w) at the start and after a period of `n` steps, for shifts of coordinates and velocities."""
        size = DISTURBANCE / max(np.abs(dq).max(), np.abs(dqd).max() * period)
        starts = [evaluator.admissible(state.q + s * size * dq, state.qd + s * size * dqd) for s in (1.0, -1.0)]
        columns = []
        for pair in (starts, [run_period(*start, n) for start in starts]):
            change, rate = ((a - b) / (2.0 * size) for a, b in zip(*pair, strict=True))
            columns.append(np.concatenate([P.T @ M @ change, period * (V.T @ M @ rate)]))
        return columns[0], columns[1]

    still = np.zeros(len(state.q))
    shifts = [(direction, still) for direction in P.T] + [(still, direction / period) for direction in V.T]
    if not shifts:
        return FloquetModel(period, np.zeros((0, 0)), np.zeros(0, complex))
    pairs = [disturbed(dq, dqd, steps) for dq, dqd in shifts]
    monodromy: Array = np.linalg.solve(np.array([a for a, _ in pairs]), np.array([b for _, b in pairs])).T
    start, finer = disturbed(P.sum(axis=1), V.sum(axis=1) / period, 2 * steps)
    _warn_of_steps(simulation.settings.method, period / steps, start, monodromy @ start, finer)
    multipliers = np.asarray(np.linalg.eigvals(monodromy), complex)
    return FloquetModel(period, monodromy, multipliers[np.argsort(-np.abs(multipliers), kind="stable")])


def _reference_period(simulation: Simulation, evaluator: Evaluator, period: float, steps: int) -> tuple[Array, Array]:
    """Coordinates and velocities (nq,) after a period without disturbance; warns of bending during it."""
    run, done = _copy_at(simulation, evaluator.state.q, evaluator.state.qd), 0
    watch = BendingWatch(simulation.system.frames)
    for k in instants(steps + 1):
        if k > done:
            run.step(period / steps, n=int(k) - done)
            done = int(k)
        watch.observe(run.time, run.state.q)
    watch.warn(stacklevel=4)
    return run.state.q, run.state.qd


def _warn_of_steps(method: str, h: float, start: Array, end: Array, finer: Array) -> None:
    """Warn if a disturbance (n,) from `start` to `end` differs too much from that with half the step `h`, s.

    What has died away to a part `CLOSED` of the start is round-off.
    """
    order = METHOD_TABLE[method].order
    size = max(np.linalg.norm(end), np.linalg.norm(finer), CLOSED * np.linalg.norm(start))
    error = float(np.linalg.norm(end - finer) / (1.0 - 0.5**order) / size)
    if error <= WRONG_ERROR:
        return
    needed = needed_step(h, Accuracy(None, None, 0.0, compared_step=h / 2.0, order=order, units={"1": error}))
    remedy = f"of {needed:.2g} s" if needed is not None else f"much shorter than {h / 2.0:.2g} s"
    warnings.warn(
        f"With steps of {h:.3g} s disturbances after a period are off by about {error:.1%}, by a run with half the "
        f"step; the multipliers may be off by as much. Take steps {remedy}, or a method of higher order.",
        AccuracyWarning,
        stacklevel=3,
    )


def _copy_at(simulation: Simulation, q: Array, qd: Array) -> Simulation:
    """Copy a simulation with its settings, inputs, parameters and switches, at coordinates and velocities (nq,)."""
    meta, source = simulation.system.meta, simulation.instance
    copy = Simulation(
        simulation.system,
        settings=simulation.settings,
        inputs={entry["name"]: source.get_input(i) for i, entry in enumerate(meta["inputs"])},
        parameters={entry["name"]: source.get_parameter(i) for i, entry in enumerate(meta["parameters"])},
        t0=simulation.time,
    )
    for i, entry in enumerate(meta["switches"]):
        copy.set_switch(entry["name"], source.get_switch(i))
    copy.instance.set_q(q.tolist(), qd.tolist())
    copy.instance.initialise(simulation.time)
    return copy


def _check_closed(simulation: Simulation, evaluator: Evaluator, end: tuple[Array, Array], period: float) -> None:
    """Refuse a motion that does not return to its start, up to spins and whole turns of angles."""
    state, frames = evaluator.state, simulation.system.frames
    T = np.eye(len(state.q)) if frames is None else frames.T.toarray()

    def full_coordinates(x: Array) -> Array:
        return np.asarray(T @ x)

    q, qd = full_coordinates(end[0] - state.q), full_coordinates(end[1] - state.qd)
    if frames is not None:
        angles = list(frames.scalars)
        q[angles] = (q[angles] + np.pi) % (2.0 * np.pi) - np.pi
    speed = max(np.abs(full_coordinates(state.qd)).max(), np.abs(full_coordinates(end[1])).max())
    size = max(np.abs(full_coordinates(state.q)).max(), speed * period)
    speed = max(speed, size / period)
    if np.abs(q).max() > CLOSED * size or np.abs(qd).max() > CLOSED * speed:
        raise ValueError(
            f"After {period:g} s the motion is {np.abs(q).max():.3g} m and {np.abs(qd).max():.3g} m/s from where it "
            f"began, of {size:.3g} m and {speed:.3g} m/s; Floquet multipliers need a motion that comes back. "
            "Give its true period, a smaller step or a method of higher order."
        )
