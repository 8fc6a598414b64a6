"""Forces that are not smooth at a state: slopes that differ on both sides, or that change within a small velocity."""

import warnings
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.limits import WRONG_ERROR
from mbs.simulation.evaluator import SHIFT, Evaluator
from mbs.simulation.state import State

Array = NDArray[np.float64]

KINK = 1e-3  # least difference of the slopes on both sides, relative to the largest slope of the forces
WIDE = 100.0  # ratio of the widths of the wide and the narrow difference
BEND = 1e-2  # least difference of the slopes of narrow and wide differences, relative to the largest slope
KINK_DISTANCE = 10.0  # distance from a kink at which slopes are taken, in widths of the difference


class LinearisationWarning(UserWarning):
    """The forces have no single slope at the state that was linearised."""


def state_beside_kinks(evaluator: Evaluator, side: int | None) -> State:
    """Shift the state of the evaluator away from kinks of the forces in the velocities.

    `side`: 1 or -1 for rising or falling velocities; None takes rising ones and warns with `LinearisationWarning`.
    Raises `ValueError` if a coordinate has several kinks.
    """
    state = evaluator.state
    names = evaluator.system.meta["coordinates"]
    diagonal = evaluator.mass().diagonal()
    kinks: list[str] = []
    while (kink := _worst_kink(evaluator, state)) is not None and len(kinks) < len(names):
        i, ahead, behind = kink
        if names[i] in kinks:
            raise ValueError(
                f"The forces have several kinks by the velocity of {names[i]!r} at the state; it has no linear model. "
                "Linearise about a state beside it."
            )
        kinks.append(names[i])
        if side is None:
            mass = diagonal[i] or 1.0
            warnings.warn(
                f"A force has a kink at the state: its slope divided by the mass is {ahead / mass:.4g} 1/s if the "
                f"velocity of {names[i]!r} rises and {behind / mass:.4g} 1/s if it falls. The linear model takes "
                "the first; side=1 confirms this choice, side=-1 takes the other.",
                LinearisationWarning,
                stacklevel=3,
            )
        velocities = state.qd.copy()
        velocities[i] += KINK_DISTANCE * SHIFT * (side or 1)
        state = replace(state, qd=velocities)
    _warn_of_bends(evaluator, state)
    return state


def warn_of_one_sided_modes(evaluator: Evaluator, motions: Iterable[tuple[float, Array]]) -> None:
    """Warn of modes whose stiffness differs on both sides of the state, as where an end stop just touches.

    `motions`: angular frequency, rad/s, and real shape (nq,) of each mode.
    """
    state, M = evaluator.state, evaluator.mass()

    def forces(q: Array) -> Array:
        return evaluator.rates(q, state.qd, state.y)[: len(q)]

    middle, modes = forces(state.q), []
    for frequency, displacement in motions:
        shape = displacement / np.sqrt(displacement @ M @ displacement)
        distance = KINK_DISTANCE * SHIFT / np.abs(shape).max()
        ahead, behind = (shape @ (forces(state.q + s * distance * shape) - middle) / distance for s in (1.0, -1.0))
        half = 0.5 * float(ahead + behind)  # half the difference of the stiffness of both sides, 1/s2
        mean = max(frequency**2, 0.5 * abs(float(ahead - behind)))
        if abs(half) > 2.0 * WRONG_ERROR * mean + 1e-13 * float(np.abs(shape) @ np.abs(middle)) / distance:
            sides = sorted(np.sqrt(np.abs(mean + np.array([half, -half]))) / (2.0 * np.pi))
            modes.append(f"{frequency / (2.0 * np.pi):.4g} Hz between {sides[0]:.4g} and {sides[1]:.4g} Hz")
    if modes:
        warnings.warn(
            f"A force has a kink at the state, such as an end stop that just touches: within {KINK_DISTANCE * SHIFT:g} "
            f"m the stiffness of both sides differs. The linear model takes the mean, modes of {'; '.join(modes)}. "
            f"Linearise where the stop is apart, or pressed in, by more than {KINK_DISTANCE * SHIFT:g} m.",
            LinearisationWarning,
            stacklevel=3,
        )


def _worst_kink(evaluator: Evaluator, state: State) -> tuple[int, float, float] | None:
    """Coordinate whose slopes on both sides differ most, with both slopes, N s/m; None if all agree."""
    forces = evaluator.rates(state.q, state.qd, state.y)[: len(state.q)]
    noise = 1e-13 * np.abs(forces).max(initial=0.0) / SHIFT
    worst, worst_kink = 0.0, None
    for i in range(len(state.q)):
        ahead, behind = (_slope(evaluator, state, i, s * SHIFT, forces) for s in (1.0, -1.0))
        difference = np.abs(ahead - behind).max()
        if difference > max(worst, KINK * max(np.abs(ahead).max(), np.abs(behind).max()) + 10.0 * noise):
            worst, worst_kink = difference, (i, float(ahead[i]), float(behind[i]))
    return worst_kink


def _warn_of_bends(evaluator: Evaluator, state: State) -> None:
    """Warn of forces that are linear only within very small velocities, such as a small friction."""
    rates = evaluator.rates(state.q, state.qd, state.y)[: len(state.q)]
    noise = 1e-13 * np.abs(rates).max(initial=0.0) / SHIFT
    bends = []
    for i, name in enumerate(evaluator.system.meta["coordinates"]):
        narrow = _slope(evaluator, state, i, SHIFT, rates)
        wide_slopes = [_slope(evaluator, state, i, s * WIDE * SHIFT, rates) for s in (1.0, -1.0)]
        differences = [float(np.abs(slope - narrow).max()) for slope in wide_slopes]
        wide = wide_slopes[int(np.argmin(differences))]  # on the side without a kink near the state
        if np.abs(narrow - wide).max() > BEND * max(np.abs(narrow).max(), np.abs(wide).max()) + 10.0 * noise:
            bends.append(f"{name!r} {narrow[i]:.4g} and {wide[i]:.4g} N s/m")
    if bends:
        warnings.warn(
            f"A force bends within {WIDE * SHIFT:g} m/s of the state. Its slopes within {SHIFT:g} m/s and within "
            f"{WIDE * SHIFT:g} m/s: {', '.join(bends)}. The linear model holds for the smaller velocities only.",
            LinearisationWarning,
            stacklevel=4,
        )


def _slope(evaluator: Evaluator, state: State, i: int, shift: float, forces: Array) -> Array:
    """One-sided slope of the generalised forces (nq,) by the velocity of coordinate `i`."""
    velocities = state.qd.copy()
    velocities[i] += shift
    slope: Array = (evaluator.rates(state.q, velocities, state.y)[: len(forces)] - forces) / shift
    return slope
