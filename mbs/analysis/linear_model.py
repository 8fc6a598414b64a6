"""Linear model about an equilibrium or a steady motion: state-space matrix, natural frequencies, damping, mode shapes.

With the columns of ``V`` (nq, n) a basis of the null space of Phi_q with ``V' M V = 1``, every admissible motion near
the state (q0, qd0) is ``z = V' M (q - q0)``. Equation (15) of the paper times V' is free of constraint forces, and its
variation is

    zdd = V' [dQ/dq V z + dQ/dqd dqd + dQ/dy y] - V' H V z,     H = sum_k lam_k H_k
    dqd = V zd + N z,      N = -W (Phi_q W)^+ d(Phi_q qd0 + Phi_t)/dq V

with H_k the second derivative of row k, W the complement ``V' M W = 0`` and y the element states, ``yd = g(q, qd, y)``.
N is the velocity that keeps the constraints satisfied when a moving mechanism is shifted; it is zero at rest.

In a steady motion the coordinates turn with a frame, ``qd0 = G q0 + b`` (`mbs.analysis.steady_motion`). The variation
seen in the frame has constant coefficients: ``-V' M G`` times the displacement, and times dqd, is added to the
rates above.

With conditions on velocities A qd = 0 (rolling, skates) there are more displacements than velocities: z refers to a
basis P of the null space of the rows on positions, w to a basis V of the null space of all rows, and
``zd = P' M (V w + N z)``.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.analysis.kinks import state_beside_kinks, warn_of_one_sided_modes
from mbs.analysis.steady_motion import SteadyFrame, steady_frame
from mbs.common.checks import instance_of, is_number, shown
from mbs.simulation.evaluator import RANK_TOLERANCE, SHIFT, Evaluator
from mbs.simulation.large_bending import warn_of_state
from mbs.simulation.state import State
from mbs.simulation.stepping import Simulation
from mbs.system.system import System

Array = NDArray[np.float64]

STEADY = 1e-2  # largest unsteady acceleration, relative to the accelerations of the motion and of its forces
STILL = 1e-3  # m/s2; smaller accelerations count as zero
STATE_TOLERANCE = 1e-3  # 1/s; slots whose rates have smaller slopes (gears, clocks) have no dynamics
FREE = 1e-3  # 1/s; smaller eigenvalues belong to free motions: they are zero up to round-off
OSCILLATION_TOLERANCE = 1e-9  # ratio of imaginary part to modulus below which an eigenvalue counts as real


@dataclass(frozen=True)
class Mode:
    """One natural motion ``shape * exp(eigenvalue * t)``."""

    eigenvalue: complex
    """1/s; of a conjugate pair the one with positive imaginary part."""
    shape: NDArray[np.complex128]
    """Shape (nq,): displacement by coordinate, in the order of `LinearModel.coordinates`, scaled so that the largest is
    1."""

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
        """Whether it is a free motion: its eigenvalue is zero."""
        return abs(self.eigenvalue) < FREE


@dataclass(frozen=True)
class LinearModel:
    """Linear model ``xd = A x`` about a state, with x = (z, zd, y), or (z, w, y) with conditions on velocities."""

    A: Array
    """Shape (2 n + ny, 2 n + ny): state-space matrix, 1/s. Element slots without dynamics of their own have been
    dropped from y. Each independent condition on velocities takes one row and column."""
    basis: Array
    """Shape (nq, n): displacement of the coordinates per unit of z; ``basis' M basis`` is the unit matrix."""
    slots: tuple[int, ...]
    """Numbers of the element states that are part of x."""
    coordinates: tuple[str, ...]
    modes: tuple[Mode, ...]
    """By rising frequency."""
    frame_turning: tuple[float, ...] = ()
    """Angular velocity of the frame in which frequencies are seen, earth axes, rad/s: three numbers, planar one."""

    @property
    def degrees_of_freedom(self) -> int:
        """Number n of independent displacements."""
        return int(self.basis.shape[1])

    def oscillating_modes(self) -> tuple[Mode, ...]:
        """The modes with a complex eigenvalue."""
        bound_modes = (m for m in self.modes if not m.is_free)
        return tuple(m for m in bound_modes if abs(m.eigenvalue.imag) > OSCILLATION_TOLERANCE * abs(m.eigenvalue))

    def __str__(self) -> str:
        lines = [f"{self.degrees_of_freedom} degrees of freedom, {len(self.slots)} element states"]
        for mode in self.modes:
            main = np.argsort(-np.abs(mode.shape), kind="stable")[:3]
            components = ", ".join(
                f"{self.coordinates[i]} {mode.shape[i].real:+.2f}{mode.shape[i].imag:+.2f}j" for i in main
            )
            lines.append(f"{mode.frequency_hz:10.4f} Hz  damping {mode.damping_ratio:+.4f}  {components}")
        return "\n".join(lines)


def linearise(simulation: Simulation, *, side: int | None = None) -> LinearModel:
    """Linearise about the present state, which stays as it is.

    Parameters
    ----------
    simulation : Simulation
        At a static equilibrium or in a steady motion: rolling straight on, a steady turn, a rotor at constant speed, a
        top that precesses. Frequencies are those seen in the frame of the motion; where several frames fit, as for a
        symmetric rotor, in the one that turns least: `LinearModel.frame_turning`.
    side : {1, -1}, optional
        If a force has a kink at the state (an engine's drag at standstill): take its slope for rising (1) or falling
        (-1) velocities; by default rising, with a warning.

    Returns
    -------
    LinearModel
        State-space matrix, natural frequencies, damping and mode shapes.

    Raises
    ------
    ValueError
        If the state is neither an equilibrium nor part of a steady motion, or a coordinate moves no mass.

    Warns
    -----
    LinearisationWarning
        A force has a kink at the state, as where an end stop just touches, or bends within the smallest differences.
    BendingWarning
        A flexible body carries axial forces in this state, or bends, so far that its frequencies are off.
    """
    instance_of(Simulation, simulation, "What linearise takes", "a Simulation")
    if side is not None and (not is_number(side) or side not in (1, -1)):
        raise ValueError(f"side = {shown(side)}; it must be 1 (rising velocities), -1 (falling ones) or left out.")
    evaluator = Evaluator(simulation)
    state = evaluator.state
    warn_of_state(simulation.system.frames, simulation.time, state.q, stacklevel=3)
    M = evaluator.mass()
    jacobian = evaluator.jacobian(state.q)
    V, W, P = admissible_motions(M, jacobian, simulation.system)
    frame = steady_frame(evaluator, P)
    _check_steady(evaluator, frame, M)
    n, n_positions = V.shape[1], P.shape[1]
    N = np.zeros_like(P)
    HV = np.zeros_like(P)
    for j in range(n_positions):
        _, ahead, drift_ahead = evaluator.constraints(state.q + SHIFT * P[:, j], state.qd)
        _, behind, drift_behind = evaluator.constraints(state.q - SHIFT * P[:, j], state.qd)
        drift = (drift_ahead - drift_behind) / (2 * SHIFT)
        N[:, j] = -W @ np.linalg.lstsq(jacobian @ W, drift, rcond=RANK_TOLERANCE)[0]
        HV[:, j] = (ahead - behind).T @ state.lam / (2 * SHIFT)
    slots = evaluator.slots
    base = state_beside_kinks(evaluator, side)
    unit = np.eye(len(state.y))
    columns = (
        [_difference(evaluator.rates, base, dq=P[:, j], dqd=N[:, j]) for j in range(n_positions)]
        + [_difference(evaluator.rates, base, dqd=V[:, j]) for j in range(n)]
        + [_difference(evaluator.rates, base, dy=unit[k]) for k in slots]
    )
    slope = np.array(columns).T  # of forces and slot rates, shape (nq + len(slots), n_motion + len(slots))
    n_motion = n_positions + n
    velocities = np.hstack([N, V])
    A: Array = np.zeros((n_motion + len(slots), n_motion + len(slots)))
    A[:n_positions, :n_motion] = P.T @ M @ velocities
    A[:n_positions, :n_positions] -= P.T @ M @ frame.G @ P
    A[n_positions:n_motion] = V.T @ slope[: len(state.q)]
    A[n_positions:n_motion, :n_positions] -= V.T @ HV
    A[n_positions:n_motion, :n_motion] -= V.T @ M @ frame.G @ velocities
    A[n_motion:] = slope[len(state.q) :]
    dynamic_slots = [i for i in range(len(slots)) if np.abs(A[n_motion + i]).max() > STATE_TOLERANCE]
    indices = [*range(n_motion), *(n_motion + i for i in dynamic_slots)]
    A = A[np.ix_(indices, indices)]
    names = tuple(simulation.system.meta["coordinates"])
    modes = _modes(A, P)
    warn_of_one_sided_modes(evaluator, ((abs(m.eigenvalue), m.shape.real) for m in modes if m.shape.any()))
    return LinearModel(A, P, tuple(slots[i] for i in dynamic_slots), names, modes, tuple(frame.turning.tolist()))


def _check_steady(evaluator: Evaluator, frame: SteadyFrame, M: Array) -> None:
    """Refuse a state whose motion is not steady."""
    state = evaluator.state
    force = np.array(evaluator.instance.evaluate(state.q.tolist(), state.qd.tolist(), state.y.tolist())["force"])
    scale = np.where(M.diagonal() > 0.0, M.diagonal(), np.inf)
    moving = max(float(state.qdd @ M @ state.qdd), float(np.sum(force**2 / scale)))
    size = max(moving**0.5, STILL * float(M.diagonal().max()) ** 0.5)
    unsteady = abs(float(frame.unsteady @ M @ frame.unsteady)) ** 0.5
    if unsteady <= STEADY * size:
        return
    worst, names = int(np.argmax(np.abs(frame.unsteady))), evaluator.system.meta["coordinates"]
    raise ValueError(
        f"At t = {evaluator.time:g} s the System is neither in equilibrium nor in a steady motion: "
        f"{names[worst]!r} changes its rate by {frame.unsteady[worst]:.3g} per second, and {unsteady / size:.2g} of "
        f"the accelerations are left unexplained ({STEADY:g} at most). Call static_equilibrium() or step to a steady "
        "motion first; a periodic motion has Floquet multipliers, see mbs.floquet."
    )


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
    slope: Array = (ahead - behind) / (2.0 * SHIFT)
    return slope


def admissible_motions(M: Array, jacobian: Array, system: System) -> tuple[Array, Array, Array]:
    """V and W of `_null_space`, and a basis P of the displacements: V without the conditions on velocities."""
    V, W = _null_space(M, jacobian, system)
    velocity_rows = system.arrays["velocity_row"]
    return V, W, _null_space(M, np.delete(jacobian, velocity_rows, axis=0), system)[0] if len(velocity_rows) else V


def _null_space(M: Array, jacobian: Array, system: System) -> tuple[Array, Array]:
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
