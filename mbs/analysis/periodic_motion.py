"""Floquet multipliers of a periodic motion: growth of small disturbances over one period.

The monodromy matrix maps admissible displacements and velocities (z, w) of `mbs.linearise` over one period; its
columns are central differences of whole runs. A second matrix by half the step gives the error of the multipliers, by
Richardson's extrapolation. A motion is stable where no multiplier lies outside the unit circle (A. H. Nayfeh,
B. Balachandran, Applied Nonlinear Dynamics, 1995, section 3.2).
"""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from mbs.analysis.kinks import LinearisationWarning
from mbs.analysis.linear_model import admissible_motions
from mbs.common.checks import instance_of, is_finite, shown
from mbs.kernel.header.limits import RESOLVED, WRONG_ERROR
from mbs.results.accuracy import GOAL_ERROR, AccuracyWarning, mean_parts, step_divisor
from mbs.results.comparison import instants
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.arguments import check_resolution
from mbs.simulation.evaluator import SHIFT, Evaluator
from mbs.simulation.large_bending import BendingWatch
from mbs.simulation.stepping import Simulation

Array = NDArray[np.float64]

MAX_STEPS = 1e8  # largest number of steps of a period
CLOSED = 1e-4  # largest distance of the state after a period, relative to the size and the speed of the motion
DIED_AWAY = 1e-4  # part of a disturbance, or of the largest multiplier, below which the rest is round-off
HALVINGS = 20  # most halvings of the step that are advised


@dataclass(frozen=True)
class FloquetModel:
    """Disturbances of a periodic motion after one period."""

    period: float
    """s."""
    monodromy: Array
    """Shape (n, n): map of the admissible displacements and velocities over one period."""
    multipliers: NDArray[np.complex128]
    """Shape (n,): its eigenvalues, by falling modulus."""
    error: float = 0.0
    """Largest estimated error of a multiplier by the step, relative to its modulus."""

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
        Step, s; the runs make whole steps next to it, and once more with half of it for the error.

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
        Runs with half the step show that a multiplier is wrong by more than 5 %.
    LinearisationWarning
        A disturbance and the opposite one end differently: a force has a kink near the motion.
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
    reference = _reference_period(simulation, evaluator, period, steps)
    _check_closed(simulation, evaluator, reference, period)
    still = np.zeros(len(state.q))
    shifts = [(direction, still) for direction in P.T] + [(still, direction / period) for direction in V.T]
    if not shifts:
        return FloquetModel(period, np.zeros((0, 0)), np.zeros(0, complex))

    def column(change: Array, rate: Array) -> Array:
        return np.concatenate([P.T @ M @ change, period * (V.T @ M @ rate)])

    def monodromy_matrix(n: int) -> tuple[Array, float, int]:
        """Matrix by runs of `n` steps, how far the mean of opposite disturbances leaves the motion, and halvings."""
        starts, ends, means, halvings = [], [], [], 0
        for dq, dqd in shifts:
            size = SHIFT / max(np.abs(dq).max(), np.abs(dqd).max() * period)
            pair = [evaluator.admissible(state.q + s * size * dq, state.qd + s * size * dqd) for s in (1.0, -1.0)]
            runs = [_copy_at(simulation, *start) for start in pair]
            for run in runs:
                run.step(period / n, n=n)
                halvings += run.report.halvings
            (q, qd), (other_q, other_qd) = ((run.state.q, run.state.qd) for run in runs)
            starts.append(column(pair[0][0] - pair[1][0], pair[0][1] - pair[1][1]))
            ends.append(column(q - other_q, qd - other_qd))
            means.append(column(q + other_q - 2.0 * reference[0], qd + other_qd - 2.0 * reference[1]))
        left = [
            float(np.linalg.norm(mean) / max(np.linalg.norm(end), DIED_AWAY * np.linalg.norm(start)))
            for start, end, mean in zip(starts, ends, means, strict=True)
        ]
        return np.linalg.solve(np.array(starts), np.array(ends)).T, max(left), halvings

    monodromy, asymmetry, halvings = monodromy_matrix(steps)
    _warn_of_kinks(asymmetry)
    order, made = METHOD_TABLE[simulation.settings.method].order, 2 * len(shifts) * steps
    parts = step_divisor(made, halvings)
    finer = monodromy_matrix(parts * steps)[0]
    excess = (monodromy - finer) / (1.0 - (mean_parts(made, halvings) / parts) ** order)
    error = _warn_of_steps(period / steps, order, monodromy - excess, excess)
    return FloquetModel(period, monodromy, _multipliers(monodromy), error)


def _multipliers(monodromy: Array) -> NDArray[np.complex128]:
    values = np.asarray(np.linalg.eigvals(monodromy), complex)
    return values[np.argsort(-np.abs(values), kind="stable")]


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


def _warn_of_kinks(asymmetry: float) -> None:
    if asymmetry <= WRONG_ERROR:
        return
    warnings.warn(
        f"A disturbance of {SHIFT:g} m and the opposite one end with changes that differ by {asymmetry:.1%}: a "
        "force has a kink near the motion, such as an end stop that just touches, or the disturbances grow too large. "
        "The multipliers are a mean of both sides; move the stop or the motion apart by more than disturbances move.",
        LinearisationWarning,
        stacklevel=3,
    )


def _warn_of_steps(h: float, order: int, limit: Array, excess: Array) -> float:
    """Error of the multipliers of ``limit + excess``, both (n, n), by steps `h`, s; warns if it is too large.

    The excess of other steps is proportional to the power `order` of the step.
    """
    expected = _multipliers(limit)
    sizes = np.maximum(np.abs(expected), DIED_AWAY * max(1.0, np.abs(expected[0])))

    def error_of(part: float) -> tuple[float, complex]:
        differences = np.abs(_multipliers(limit + part * excess)[:, None] - expected) / sizes
        pairs = linear_sum_assignment(differences)
        worst = int(np.argmax(differences[pairs]))
        return float(differences[pairs][worst]), complex(expected[pairs[1][worst]])

    error, multiplier = error_of(1.0)
    if error <= WRONG_ERROR:
        return error
    halvings = (k for k in range(1, HALVINGS) if error_of(0.5 ** (k * order))[0] <= GOAL_ERROR)
    # of larger errors the angle of a multiplier may be wrong by whole turns
    sufficient = next(halvings, None) if error <= 0.5 * RESOLVED else None
    remedy = f"of {h * 0.5**sufficient:.2g} s" if sufficient else f"much shorter than {h / 2.0:.2g} s"
    warnings.warn(
        f"With steps of {h:.3g} s the multiplier near {multiplier:.3g} is off by about {error:.1%}, as runs with half "
        f"the step show. Take steps {remedy}, or a method of higher order.",
        AccuracyWarning,
        stacklevel=3,
    )
    return error


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
