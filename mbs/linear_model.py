"""Linear model about a state: state-space matrix, natural frequencies, damping ratios, mode shapes.

With the columns of ``V`` (nq, n) a basis of the null space of Phi_q with ``V' M V = 1``, every admissible motion near
the state (q0, qd0) is ``z = V' M (q - q0)``. Equation (15) of the paper times V' is free of constraint forces, and its
variation is

    zdd = V' [dQ/dq V z + dQ/dqd dqd + dQ/dy y] - V' G V z,     G = sum_k lam_k H_k
    dqd = V zd + N z,      N = -W (Phi_q W)^+ d(Phi_q qd0 + Phi_t)/dq V

with H_k the second derivative of row k, W the complement ``V' M W = 0`` and y the element states, ``yd = g(q, qd, y)``.
N is the velocity that keeps the constraints satisfied when a moving mechanism is shifted; it is zero at rest.

With conditions on velocities A qd = 0 (rolling, skates) there are more places than velocities: z counts a basis P of
the null space of the rows on positions alone, w one V of the null space of all, and ``zd = P' M (V w + N z)``.

Elements give steps of their slots, not rates: g is the limit of short steps. A slot that does not remember its value
over a short step (a rate kept for the next step) is no state; it is set to what such a step makes of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.simulation import Simulation, State
from mbs.system import System

Array = NDArray[np.float64]

SHIFT = 1e-6  # of coordinates (m), velocities (m/s) and element states in the central differences
STATE_STEP = 1e-5  # s, of the element steps that give the rates of element states
SHORT_STEP = 1e-9  # s, over which a state keeps its value
RANK_TOLERANCE = 1e-9  # singular values of Phi_q below this share of the largest count as zero
STATE_TOLERANCE = (
    1e-3  # 1/s; slots with smaller slopes of their rates (gears, clocks) have no dynamics; above round-off
)
FREE = 1e-3  # 1/s; smaller eigenvalues are those of free motions, which are zero up to round-off
OSCILLATION_TOLERANCE = 1e-9  # imaginary part over modulus of an eigenvalue below which it counts as real


@dataclass(frozen=True)
class Mode:
    """One natural motion ``shape * exp(eigenvalue * t)``.

    Parameters
    ----------
    eigenvalue : complex
        1/s; of a conjugate pair the one with positive imaginary part.
    shape : array of shape (nq,), complex
        Displacement by coordinate, in the order of `LinearModel.coordinates`, scaled so that the largest is 1.
    """

    eigenvalue: complex
    shape: NDArray[np.complex128]

    @property
    def frequency_hz(self) -> float:
        """Undamped natural frequency ``|s| / 2 pi``, Hz."""
        return float(abs(self.eigenvalue) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> float:
        """``-Re(s) / |s|``: 0 undamped, 1 without oscillation, negative unstable; 0 for a free motion."""
        return 0.0 if self.is_free else float(-self.eigenvalue.real / abs(self.eigenvalue))

    @property
    def is_free(self) -> bool:
        """A motion that nothing holds back: its eigenvalue is zero."""
        return abs(self.eigenvalue) < FREE


@dataclass(frozen=True)
class LinearModel:
    """Linear model ``xd = A x`` about a state, with x = (z, zd, y), or (z, w, y) with conditions on velocities.

    Parameters
    ----------
    A : array of shape (2 n + ny, 2 n + ny)
        State-space matrix, 1/s. Element slots without dynamics of their own have been dropped from y. Each independent
        condition on velocities takes one row and column.
    basis : array of shape (nq, n)
        Displacement of the coordinates per unit of z; ``basis' M basis`` is the unit matrix.
    slots : tuple of int
        Numbers of the element states that are part of x.
    coordinates : tuple of str
        Names of the nq coordinates.
    modes : tuple of Mode
        By rising frequency.
    """

    A: Array
    basis: Array
    slots: tuple[int, ...]
    coordinates: tuple[str, ...]
    modes: tuple[Mode, ...]

    @property
    def degrees_of_freedom(self) -> int:
        """Number n of independent displacements."""
        return int(self.basis.shape[1])

    def oscillating_modes(self) -> tuple[Mode, ...]:
        """The modes with a complex eigenvalue."""
        held = (m for m in self.modes if not m.is_free)
        return tuple(m for m in held if abs(m.eigenvalue.imag) > OSCILLATION_TOLERANCE * abs(m.eigenvalue))

    def __str__(self) -> str:
        lines = [f"{self.degrees_of_freedom} degrees of freedom, {len(self.slots)} element states"]
        for mode in self.modes:
            main = np.argsort(-np.abs(mode.shape), kind="stable")[:3]
            parts = ", ".join(
                f"{self.coordinates[i]} {mode.shape[i].real:+.2f}{mode.shape[i].imag:+.2f}j" for i in main
            )
            lines.append(f"{mode.frequency_hz:10.4f} Hz  damping {mode.damping_ratio:+.4f}  {parts}")
        return "\n".join(lines)


def linearise(simulation: Simulation) -> LinearModel:
    """Linearise about the present state, which stays as it is.

    Parameters
    ----------
    simulation : Simulation
        At a static equilibrium, a steady motion, or any state: the result is the variation about the motion through it.

    Returns
    -------
    LinearModel
        Its modes have a meaning where the state is an equilibrium or a steady motion.
    """
    evaluator = _Evaluator(simulation)
    state = evaluator.state
    M = evaluator.mass()
    jacobian = evaluator.constraints(state.q)[0]
    V, W = _admissible(M, jacobian, simulation.system)
    rolling = simulation.system.arrays["velocity_row"]
    P = _admissible(M, np.delete(jacobian, rolling, axis=0), simulation.system)[0] if len(rolling) else V
    n, places = V.shape[1], P.shape[1]
    N = np.zeros_like(P)
    GV = np.zeros_like(P)
    for j in range(places):
        ahead, drift_ahead = evaluator.constraints(state.q + SHIFT * P[:, j])
        behind, drift_behind = evaluator.constraints(state.q - SHIFT * P[:, j])
        drift = (drift_ahead - drift_behind) / (2 * SHIFT)
        N[:, j] = -W @ np.linalg.lstsq(jacobian @ W, drift, rcond=RANK_TOLERANCE)[0]
        GV[:, j] = (ahead - behind).T @ state.lam / (2 * SHIFT)
    slots = evaluator.slots
    unit = np.eye(len(state.y))
    columns = (
        [_difference(evaluator.rates, state, dq=P[:, j], dqd=N[:, j]) for j in range(places)]
        + [_difference(evaluator.rates, state, dqd=V[:, j]) for j in range(n)]
        + [_difference(evaluator.rates, state, dy=unit[k]) for k in slots]
    )
    slope = np.array(columns).T  # (nq + len(slots), both + len(slots)): of forces and of slot rates
    both = places + n
    A: Array = np.zeros((both + len(slots), both + len(slots)))
    if len(rolling):
        A[:places, :both] = P.T @ M @ np.hstack([N, V])
    else:
        A[:n, n:both] = np.eye(n)
    A[places:both] = V.T @ slope[: len(state.q)]
    A[places:both, :places] -= V.T @ GV
    A[both:] = slope[len(state.q) :]
    lively = [i for i in range(len(slots)) if np.abs(A[both + i]).max() > STATE_TOLERANCE]
    kept = [*range(both), *(both + i for i in lively)]
    A = A[np.ix_(kept, kept)]
    names = tuple(simulation.system.meta["coordinates"])
    return LinearModel(A, P, tuple(slots[i] for i in lively), names, _modes(A, P))


class _Evaluator:
    """Forces, slot rates and constraint derivatives of the kernel near a state, as dense arrays."""

    def __init__(self, simulation: Simulation) -> None:
        self.instance = simulation.instance
        self.arrays = simulation.system.arrays
        self.time = simulation.time
        self.state = simulation.state
        self.slots = [k for k in range(len(self.state.y)) if self._remembers(k)]

    def mass(self) -> Array:
        """Mass matrix (nq, nq) at the state."""
        return np.reshape(self.instance.mass_matrix(self.state.q.tolist()), (len(self.state.q),) * 2)

    def constraints(self, q: Array) -> tuple[Array, Array]:
        """Phi_q (nc, nq) of the stored rows at `q` (nq,), and their rate Phi_q qd + Phi_t (nc,)."""
        values = self._evaluate(q, self.state.qd, self.state.y)
        jacobian = _dense(self.arrays["row_ptr"], self.arrays["row_col"], np.array(values["jacobian"]), len(q))
        return jacobian, jacobian @ self.state.qd + np.array(values["phi_t"])

    def rates(self, q: Array, qd: Array, y: Array) -> Array:
        """Forces Q - M(q) qdd (nq,) and rates g of the states among the slots, in one vector."""
        settled = self._element_step(q, qd, y, SHORT_STEP)
        settled[self.slots] = y[self.slots]
        force = np.array(self._evaluate(q, qd, settled)["force"])
        if len(self.arrays["flex_mode"]):
            force -= np.reshape(self.instance.mass_matrix(q.tolist()), (len(q),) * 2) @ self.state.qdd
        whole = (self._element_step(q, qd, settled, STATE_STEP) - settled) / STATE_STEP
        half = (self._element_step(q, qd, settled, STATE_STEP / 2) - settled) / (STATE_STEP / 2)
        return np.concatenate([force, (2.0 * half - whole)[self.slots]])  # without the first-order error of the steps

    def _evaluate(self, q: Array, qd: Array, y: Array) -> dict[str, Any]:
        return self.instance.evaluate(q.tolist(), qd.tolist(), y.tolist(), self.time)

    def _remembers(self, k: int) -> bool:
        s = self.state
        shift = SHIFT * np.eye(len(s.y))[k]
        ahead = self._element_step(s.q, s.qd, s.y + shift, SHORT_STEP)
        behind = self._element_step(s.q, s.qd, s.y - shift, SHORT_STEP)
        return bool(ahead[k] - behind[k] > SHIFT)

    def _element_step(self, q: Array, qd: Array, y: Array, h: float) -> Array:
        return np.array(self.instance.element_step(q.tolist(), qd.tolist(), y.tolist(), h)[0])


def _difference(
    function: Callable[[Array, Array, Array], Array],
    state: State,
    dq: Array | float = 0.0,
    dqd: Array | float = 0.0,
    dy: Array | float = 0.0,
) -> Array:
    """Central difference of `function` (q, qd, y) along a direction."""
    ahead = function(state.q + SHIFT * dq, state.qd + SHIFT * dqd, state.y + SHIFT * dy)
    behind = function(state.q - SHIFT * dq, state.qd - SHIFT * dqd, state.y - SHIFT * dy)
    result: Array = (ahead - behind) / (2.0 * SHIFT)
    return result


def _admissible(M: Array, jacobian: Array, system: System) -> tuple[Array, Array]:
    """Null space V (nq, n) of Phi_q with ``V' M V = 1``, and its complement W (nq, nq - n) with ``V' M W = 0``."""
    null = scipy.linalg.null_space(jacobian, rcond=RANK_TOLERANCE) if len(jacobian) else np.eye(len(M))
    inertia = null.T @ M @ null
    values, vectors = np.linalg.eigh(inertia)
    if len(values) and values[0] <= RANK_TOLERANCE * values[-1]:
        motion = null @ vectors[:, 0]
        name = system.meta["coordinates"][int(np.argmax(np.abs(motion)))]
        raise ValueError(
            f"The System can move {name!r} without moving any mass; give it mass or inertia to linearise it."
        )
    V = null @ vectors / np.sqrt(values)
    return V, scipy.linalg.null_space(V.T @ M) if V.shape[1] else np.eye(len(M))


def _modes(A: Array, V: Array) -> tuple[Mode, ...]:
    values, vectors = np.linalg.eig(A)
    modes = []
    for s, x in zip(values, vectors.T, strict=True):
        if s.imag < 0.0:
            continue
        shape = V @ x[: V.shape[1]]
        largest = shape[np.argmax(np.abs(shape))] if len(shape) else 0.0
        modes.append(Mode(complex(s), np.asarray(shape / largest if largest else shape, complex)))
    return tuple(sorted(modes, key=lambda m: (m.frequency_hz, m.damping_ratio)))


def _dense(ptr: NDArray[np.int32], col: NDArray[np.int32], val: Array, columns: int) -> Array:
    matrix = np.zeros((len(ptr) - 1, columns))
    matrix[np.repeat(np.arange(len(ptr) - 1), np.diff(ptr)), col] = val
    return matrix
