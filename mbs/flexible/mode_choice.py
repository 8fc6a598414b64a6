"""Number of dynamic modes that a named output needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbs.common.checks import flag, is_finite, not_negative, shown, whole
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel, Reference
from mbs.flexible.fixed_interface import FixedInterface, Interface
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.sparse_matrices import Sparse

RESONANT = 1.5  # modes below this multiple of the highest relevant frequency are always taken


@dataclass(frozen=True)
class ModeChoice:
    """Chosen fixed-interface modes and the error without the others."""

    modes: tuple[int, ...]
    """Numbers of the modes (0 is the lowest), ascending; for `craig_bampton`."""
    left_out: float
    """Largest error of the output for the accelerations considered, as a fraction of its largest value."""
    frequencies: np.ndarray
    """Of the chosen modes, Hz."""


def modes_for_output(
    model: FiniteElementModel,
    reference: Reference,
    interfaces: Sequence[Interface | str | int],
    rows: np.ndarray | Sparse,
    tolerance: float,
    candidates: int = 100,
    frequency: float = 0.0,
    inertia_modes: bool = False,
) -> ModeChoice:
    """Fewest modes with which the outputs under rigid accelerations are right to a tolerance.

    With the interfaces held the output under the inertia of each unit acceleration (three along the axes, three
    about them) is known exactly; a mode contributes ``row psi (psi' M R) / w2``, and at a frequency W of the
    accelerations w2 / (w2 - W2) times that. With the inertia modes the steady part is exact whatever is chosen, and a
    mode contributes the rest, W2 / (w2 - W2). Modes below 1.5 W are always taken, then the others in the order of
    their largest contribution until every output misses less than `tolerance` of its largest steady value.

    Parameters
    ----------
    reference : str, int or three of them
        Node of the floating frame.
    interfaces : sequence of Interface, str or int
        Nodes of joints and forces, held.
    rows : ndarray or sparse array, shape (n_outputs, n_dof) or (n_outputs, n_dof + 3 n)
        Outputs per unit nodal displacement.
    tolerance : float
        Fraction of each output's largest value for the six accelerations.
    candidates : int
        Lowest modes that are considered.
    frequency : float
        Highest frequency of the accelerations that matters, Hz; 0 for steady ones.
    inertia_modes : bool
        Whether the reduction will have the inertia modes.

    Raises
    ------
    ModelError
        The tolerance is not a fraction, or the candidates leave a larger error.
    """
    flag(inertia_modes, "inertia_modes")
    candidates = whole(candidates, "The number of candidates", 0, 10**6)
    not_negative(frequency, "The frequency of the accelerations")
    if not is_finite(tolerance) or not 0 < tolerance < 1:
        raise ModelError(f"The tolerance on an output is {shown(tolerance)}; a fraction between 0 and 1 is needed.")
    fixed = FixedInterface(model, reference, interfaces)
    hertz, modes = natural_modes(model, candidates, fixed.held_freedoms())
    load = np.asarray(model.mass_matrix() @ model.rigid_motions(model.origin(reference)))
    # angular accelerations are scaled by the size of the model, for comparison with linear ones
    load[:, 3:] /= float(np.ptp(model.positions, axis=0).max())
    # outputs of the deformation only: outputs of the inertia along the beams do not depend on the choice
    rows = rows[:, : model.n_dof]
    exact = np.asarray(rows @ fixed.solve(load))
    scale = np.abs(exact).max(axis=1, keepdims=True)
    if (scale == 0).any():
        raise ModelError(
            f"Output {int(np.flatnonzero(scale == 0)[0])} does not depend on any deformation of the model."
        )
    participation = (modes.T @ load) / ((2 * np.pi * hertz) ** 2)[:, None]
    contributions = np.asarray(rows @ modes)[:, :, None] * participation[None] / scale[:, :, None]
    resonant = hertz < RESONANT * frequency
    # at resonance only damping bounds the response, so these modes are taken without their contributions
    ratio = np.where(resonant, 0.0, frequency / np.where(resonant, 1.0, hertz)) ** 2
    amplified = contributions * (ratio / (1 - ratio))[None, :, None]
    residual = amplified.sum(axis=1) + (0.0 if inertia_modes else exact / scale)
    contributions = amplified if inertia_modes else contributions + amplified
    order = np.argsort(np.where(resonant, -np.inf, -np.abs(contributions).max(axis=(0, 2))), kind="stable")
    chosen: list[int] = []
    for mode in order:
        if np.abs(residual).max() <= tolerance and not resonant[mode]:
            break
        residual = residual - contributions[:, mode]
        chosen.append(int(mode))
    error = float(np.abs(residual).max())
    if error > tolerance:
        raise ModelError(
            f"The lowest {candidates} modes leave an error of {error:.2g} of the output; look at more candidates or "
            "take the inertia modes, which make steady accelerations exact."
        )
    chosen.sort()
    return ModeChoice(tuple(chosen), error, hertz[chosen])
