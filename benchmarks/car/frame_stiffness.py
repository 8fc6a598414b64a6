"""Torsional stiffness and natural frequencies of the frame of a car."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fixed_interface import FixedInterface
from mbs.flexible.frequencies import natural_modes
from mbs.vehicle import Car

COUPLE = 1e3  # N m; the frame is linear
RIGID = 6  # rigid-body modes
MODES = 4  # elastic modes


@dataclass(frozen=True)
class Stiffness:
    """Result of `stiffness`."""

    joints: tuple[str, str]
    """Left joints that take the couples, front and rear: the highest of each axle."""
    torsion: float
    """Couple divided by the twist angle between the axles, N m/deg."""
    frequencies: NDArray[np.float64]
    """Elastic natural frequencies of the free frame with all masses on it, Hz."""


def stiffness(car: Car) -> Stiffness:
    """Torsional stiffness of the free frame by opposite couples at the axles, and its lowest natural frequencies.

    `car`: car with a flexible frame.
    """
    flexible = car.flexible_frame
    model = flexible.model
    middle = 0.5 * (car.front.wheel.centre[0] + car.rear.wheel.centre[0])
    left_side = [name for name in flexible.interfaces if flexible.place(name)[1] > 0.0]
    front, rear = (
        max(
            (n for n in left_side if (flexible.place(n)[0] > middle) == ahead),
            key=lambda n: float(flexible.place(n)[2]),
        )
        for ahead in (True, False)
    )
    load = np.zeros((model.n_dof, 1))
    for name, sign in ((front, 1.0), (rear, -1.0)):
        load[_vertical_dofs(model, flexible.place(name)), 0] = (
            sign * COUPLE / _width(flexible.place(name)) * np.array([1.0, -1.0])
        )
    # the couples balance each other: the support has no reaction
    displacements = FixedInterface(model, flexible.reference, ()).solve(load)[:, 0]
    angles = [
        float(np.array([1.0, -1.0]) @ displacements[_vertical_dofs(model, flexible.place(n))])
        / _width(flexible.place(n))
        for n in (front, rear)
    ]
    hertz, _ = natural_modes(model, RIGID + MODES)
    return Stiffness((front, rear), COUPLE / float(np.degrees(angles[0] - angles[1])), hertz[RIGID:])


def _width(point: NDArray[np.float64]) -> float:
    return 2.0 * float(point[1])


def _vertical_dofs(model: FiniteElementModel, point: NDArray[np.float64]) -> NDArray[np.int64]:
    """Degrees of freedom along z of the node at a point and of its mirror image."""
    node_indices = [
        int(np.linalg.norm(model.positions - point * [1.0, side, 1.0], axis=1).argmin()) for side in (1.0, -1.0)
    ]
    return np.array(model.dof[node_indices, 2])
