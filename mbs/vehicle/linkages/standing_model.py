"""Compiled model whose constraints, forces and points are evaluated at positions near its start."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import AffineVector
from mbs.compiler.model_to_system import compiled
from mbs.kernel.binding import LoadedSystem
from mbs.model.model import Model
from mbs.simulation.evaluator import Evaluator
from mbs.simulation.system_instance import SystemInstance
from mbs.simulation.unstepped_system import start

Array = NDArray[np.float64]
Linear: TypeAlias = "tuple[Array, Array]"
"""Matrix (n, nq) and constant (n,) of a point or vector as a function of the coordinates."""


class StandingModel:
    """Base class of compiled models that are evaluated at other positions than their start.

    Attributes
    ----------
    evaluator : Evaluator
        Constraints and forces at any coordinates.
    """

    def __init__(self, model: Model) -> None:
        system = compiled(model)
        assert system.frames is not None
        self._T, self._constant = system.frames.T.toarray(), system.frames.constant
        system_instance = SystemInstance(system, LoadedSystem(system.kernel_bytes(modes=False)), system.meta)
        start(system_instance.instance, system.meta)
        self.evaluator = Evaluator(system_instance)

    def linear(self, v: AffineVector) -> Linear:
        """A point or vector as a function of the coordinates."""
        full = np.zeros((len(v), len(self._constant)))
        for row, component in zip(full, v.components, strict=True):
            for k, c in component.terms.items():
                row[k] = c
        return full @ self._T, full @ self._constant + [component.constant for component in v.components]

    def full(self, k: int) -> tuple[Array, float]:
        """Row (nq,) and constant of the k-th full coordinate as a function of the coordinates."""
        return self._T[k], float(self._constant[k])

    def force(self, q: Array) -> Array:
        """Generalised forces Q (nq,) of all elements at rest. `q`: coordinates, shape (nq,)."""
        return self.evaluator.forces(q)


def rotation_rate(triad: Sequence[Linear], q: Array, rates: Array) -> Array:
    """Angular velocity of a body by its unit vectors, shape (3,), or (3, n) of the columns of `rates`.

    `triad`: unit vectors of the body; `q`: coordinates, shape (nq,); `rates`: of the coordinates, (nq,) or (nq, n).
    """
    return np.asarray(0.5 * np.sum([np.cross(A @ q + a, (A @ rates).T).T for A, a in triad], axis=0))
